// --skip-existing: is an output that exists the one this run would make?
#ifndef SSDO_PIPELINE_RESUME_H
#define SSDO_PIPELINE_RESUME_H

#include "pipeline/frame.h"

// True if the file can be read to its last chunk and its header says that this version made it with the same pixel-changing
// settings (and, for a sequence, the same automatic radius). The input is not looked at. A frame that counts as done but was made
// on another device is warned about, once.
bool resume_is_done(const job *j, const char *output);

// Warns if an output that this run will not write again was made like this run's, but on another device: looks at the header
// only.
void resume_check_device(const job *j, const char *output);

#endif
