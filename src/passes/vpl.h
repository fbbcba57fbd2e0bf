// The virtual lights of a frame: which pixels send most, as discs.
#ifndef SSDO_PASSES_VPL_H
#define SSDO_PASSES_VPL_H

#include "gbuffer/gbuffer.h"

typedef struct vpl {
    vec3 position, normal; // camera space
    double area;           // of the disc it stands for, scene units squared
    double radiance[3];    // that it sends
} vpl;

// Picks `count` pixels in proportion to luminance of the sent radiance x area of surface in the pixel / (1 + (depth / extent)^2),
// the last so that a ground that reaches the horizon does not take all lights (gb->extent 0: without it): evenly spaced along the
// running sum of that over the pixels in Morton order, so that neighbours in the list are neighbours in the picture and the
// choice is the same on every run. `light` holds 4 floats a pixel; it is multiplied by `albedo` (4 a pixel) unless that is NULL.
// out has room for `count`; returns how many there are: count, or 0 where nothing sends light.
int vpl_choose(const gbuffer *gb, const float *light, const float *albedo, int count, vpl *out);

#endif
