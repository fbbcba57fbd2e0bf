// Shared inside the gpu room only.
#ifndef SSDO_GPU_INTERNAL_H
#define SSDO_GPU_INTERNAL_H

#include "gpu/gpu.h"

void gpu_programs_free(gpu *g);

#endif
