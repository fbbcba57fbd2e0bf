// What the passes of the `arc` family share: the parameter block of shaders/include/arc_params.glsl.
#ifndef SSDO_PASSES_ARC_H
#define SSDO_PASSES_ARC_H

#include "passes/pass.h"

typedef struct arc_params {
    float radius, thickness, kappa, thin;
    int slices, steps, seed, planes;
    float tolerance, level, strength;
    int suns, exitant;
    float inverse_steps;
    int unused[2];
    float sun_direction[4][4], sun_light[4][4];
} arc_params;

// Slices and steps a side for a number of samples = slices x 2 x steps.
void arc_grid(int samples, int *slices, int *steps);
arc_params arc_params_of(const pass_context *c);

#endif
