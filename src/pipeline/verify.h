// --verify: what was written, read again and compared with the input, read again too.
#ifndef SSDO_PIPELINE_VERIFY_H
#define SSDO_PIPELINE_VERIFY_H

#include "pipeline/result.h"

// True if every channel of the input that passes through is in the file `written` with the same type, window and bits, and every
// attribute with the same type and value; ERR_OUTPUT names `output` and the first that is not. Both files are opened afresh. At
// most a few channels of each are in memory at a time.
bool verify_written(const job *j, const frame_result *r, const char *written, const char *output, error *e);

#endif
