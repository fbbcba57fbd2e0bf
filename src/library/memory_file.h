// A G-buffer in memory as an uncompressed OpenEXR file in memory, so that it is read by the same code as every other file.
#ifndef SSDO_LIBRARY_MEMORY_FILE_H
#define SSDO_LIBRARY_MEMORY_FILE_H

#include "base/error.h"
#include "ssdo.h"

// The file's descriptor, which the caller closes, or -1 with ERR_USAGE or ERR_MEMORY.
int memory_file_make(const ssdo_input *input, int threads, error *e);

#endif
