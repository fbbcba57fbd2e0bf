// Whether what was copied from one file into another is the same there: for --verify.
#ifndef SSDO_EXR_COMPARE_H
#define SSDO_EXR_COMPARE_H

#include "exr/write.h"

// The name of the first attribute whose type or value in `part` of `out` is not that of the first of the sources that has it, or
// that is not there; NULL if there is none. Attributes that say how pixels are stored are the writer's and do not count, but for
// the screen window, which is the camera's.
const char *exrio_attributes_differ(const exrio_source *sources, int count, const exrio_file *out, int part);

// Whether two deep scanline parts hold the same chunks, byte for byte.
bool exrio_deep_same(const exrio_file *a, int part_a, const exrio_file *b, int part_b);

#endif
