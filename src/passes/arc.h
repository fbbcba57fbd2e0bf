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
    float sun_direction[SUNS_MAX][4], sun_light[SUNS_MAX][4];
    float box[2][4], rest[9][4];
} arc_params;

// Slices and steps a side for a number of samples = slices x 2 x steps.
void arc_grid(int samples, int *slices, int *steps);
arc_params arc_params_of(const pass_context *c);
// For marches without a radius: light comes from any distance.
arc_params arc_unlimited_params_of(const pass_context *c);

// What all marches read, once a frame: the planes and their image, the packed surfaces.
bool arc_make_inputs(pass_context *c, error *e);

void arc_put(float to[4], vec3 a, double w);

#endif
