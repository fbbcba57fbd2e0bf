// The light of surfaces that the camera does not see.
#ifndef SSDO_PASSES_HIDDEN_H
#define SSDO_PASSES_HIDDEN_H

#include "light/env_map.h"
#include "passes/openness.h"
#include "passes/planes.h"

enum { HIDDEN_SH = 9 };

// A frame, what blocks the environment there, and how its directions turn into others' (passes/openness.h: upright).
typedef struct hidden_place {
    const gbuffer *gb;
    const plane_set *planes;
    const openness *outside;
    mat3 map_from_camera, upright_from_camera;
    vec3 upright_eye;
} hidden_place;

// Radiance coefficients (l <= 2, light/sh.h, in the map's axes) of the environment as it is seen from the middle of the frame's
// surfaces, where the planes that face that place are black: ground and walls block the environment for hidden faces, too. A
// plane blocks the share of it that is its belief. Beyond its support it is taken to go on as far as the shaders take it
// (BELIEVED_PLANE). What passes the planes is as open as the outside is there.
bool hidden_light(const environment *env, const hidden_place *at, int threads, double sh[HIDDEN_SH][3], error *e);

#endif
