// --skip-existing: is an output that exists the one this run would make? And --missing skip.
#ifndef SSDO_PIPELINE_RESUME_H
#define SSDO_PIPELINE_RESUME_H

#include "pipeline/frame.h"

// Why the frame is left out, in a few words, or NULL. "Already done" is a file that can be read to its last chunk, whose header
// says that this version made it with the same pixel-changing settings (and, for a sequence, the same automatic radius), and that
// is no older than the inputs, the environment, the mesh, the proxies and the camera file. A frame that counts as done but was
// made on another device is warned about, once; what a killed run left beside it is removed.
const char *resume_skips(const job *j, const char *const *inputs, int count, const char *output);

// Warns if an output that this run will not write again was made like this run's, but on another device: looks at the header
// only.
void resume_check_device(const job *j, const char *output);

#endif
