// --skip-existing: is an output that exists the one this run would make? And --missing skip.
#ifndef SSDO_PIPELINE_RESUME_H
#define SSDO_PIPELINE_RESUME_H

#include "pipeline/result.h"

// Why the frame is left out, in a few words, or NULL. "Already done" is a file that can be read to its last chunk, whose record
// is the frame's (pipeline/record.h), with the preview and the report that this run would write beside it. A frame that counts as
// done but was made on another device is warned about, once; what a killed run left beside it is removed.
const char *resume_skips(const job *j, int frame, const char *const *inputs, int count, const char *output,
                         const frame_record *record);

// Warns if an output that this run will not write again was made with this run's settings, but on another device: looks at the
// header only.
void resume_check_device(const job *j, const char *output);

#endif
