// The parameter block that ssdo.comp and ssdo_bounce.comp share (shaders/include/ssdo.glsl).
#ifndef SSDO_PASSES_SSDO_H
#define SSDO_PASSES_SSDO_H

#include "passes/pass.h"

typedef struct ssdo_params {
    float radius, thickness;
    int samples, seed;
    float level, strength;
    int exitant, unused;
} ssdo_params;

ssdo_params ssdo_params_of(const pass_context *c);

#endif
