// How open the unseen directions outside the frame are to the environment.
#ifndef SSDO_PASSES_OPENNESS_H
#define SSDO_PASSES_OPENNESS_H

#include <stdbool.h>

#include "base/vec.h"

#include "../../shaders/include/constants.glsl"

// What leaves the frame is looked up where it leaves a box about what the frame shows, as seen from the middle of the box:
// openings lie in the walls of a room, not at infinity (parallax-corrected maps; Lagarde and Zanuttini 2012, "Local Image-based
// Lighting").
//
// Its axes are upright: the world's with z up, so (x, -z, y) of a world with y up; without a known world those that the
// environment has without its turn.
//
// share: 0 none to 1 all, at the points of a lat-long grid: up, down, then rows at equal angles between them, from the top, each
// with columns at equal steps of u from 0 as in light/environment.h. Between points it is linear. suns: the same for suns; below
// 0: as for all other light. low, high: the box, from the world's origin where the camera is known in the world, else from the
// eye.
typedef struct openness {
    double share[OPENNESS_COUNT], suns;
    vec3 low, high;
} openness;

static inline openness openness_even(double share)
{
    openness o = {.suns = -1.0, .low = v3(-1, -1, -1), .high = v3(1, 1, 1)};
    for (int i = 0; i < OPENNESS_COUNT; i++) o.share[i] = share;
    return o;
}

static inline double openness_mean(const openness *o)
{
    double sum = 0.0;
    for (int i = 0; i < OPENNESS_COUNT; i++) sum += o->share[i];
    return sum / OPENNESS_COUNT;
}

// How open it is from a place in the unit direction d; both in the axes of the openness. As outside.glsl has it, but for suns.
double openness_towards(const openness *o, vec3 place, vec3 d);

// Whether nothing is closed.
static inline bool openness_is_whole(const openness *o)
{
    for (int i = 0; i < OPENNESS_COUNT; i++)
        if (o->share[i] < 1.0) return false;
    return o->suns < 0.0 || o->suns >= 1.0;
}

#endif
