// The virtual lights of a frame: which pixels send most, as discs.
#ifndef SSDO_PASSES_VPL_H
#define SSDO_PASSES_VPL_H

#include "gbuffer/gbuffer.h"

typedef struct vpl {
    vec3 position, normal; // camera space
    double area;           // of the disc it stands for, scene units squared
    double radiance[3];    // that it sends
} vpl;

// Picks `count` pixels in proportion to (luminance of the sent radiance) x (area of surface in the pixel) / (1 + (depth /
// extent)^2). The divisor keeps a ground that reaches the horizon from taking all lights; with gb->extent 0 it is 1. The picks
// are evenly spaced along the running sum of these weights over the pixels in Morton order. So neighbours in the list are
// neighbours in the picture, and every run picks the same pixels. `light` holds 4 floats a pixel and is multiplied by `albedo` (4
// a pixel) unless that is NULL. `out` has room for `count`. Returns the number of lights: count, or 0 where nothing sends light.
int vpl_choose(const gbuffer *gb, const float *light, const float *albedo, int count, vpl *out);

#endif
