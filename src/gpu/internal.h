// Shared inside the gpu room only.
#ifndef SSDO_GPU_INTERNAL_H
#define SSDO_GPU_INTERNAL_H

#include "gpu/gpu.h"

void gpu_programs_free(gpu *g);
void gpu_debug_begin(gpu *g); // in a context that is current
void gpu_transfers_free(gpu *g);

// Rows of level 0; with a buffer bound to GL_PIXEL_UNPACK_BUFFER, `pixels` is NULL.
void gpu_image_upload_rows(gpu *g, gpu_image *image, int y, int rows, const float *pixels);

// Gives units to all that a linked program uses and lists them in its slots. False: more than GPU_MAX_SLOTS.
bool gpu_find_slots(gpu_program *p);

#endif
