// The environment as a map and its mips, and looking it up. environment.h makes it.
#ifndef SSDO_LIGHT_ENV_MAP_H
#define SSDO_LIGHT_ENV_MAP_H

#include <stdbool.h>
#include <stddef.h>

#include "base/vec.h"

enum { ENV_MAX_LEVELS = 16, ENV_MAX_SIZE = 32768 };

typedef struct env_level {
    int width, height;
    float *rgba; // 4 a texel, a = 0
} env_level;

typedef struct environment {
    bool white; // no map was given
    mat3 map_from_world;
    env_level levels[ENV_MAX_LEVELS]; // level 0 is the map itself; each next one halves both sizes (down to 1x1), its texels the
    int level_count;  // solid-angle weighted means of what they cover, so that every level integrates to the same light
    double sh[16][3]; // plain radiance coefficients L_lm, l <= 3, index l*l + l + m, in map space
    double mean[3];   // mean radiance over the sphere
    size_t repaired;  // texels that were NaN, infinite or negative
} environment;

void environment_free(environment *env);

// Radiance of level `level` by bilinear lookup (wrapping in u, clamped in v), map-space direction: what the shaders see.
vec3 environment_lookup(const environment *env, vec3 map_direction, double level);

// Exact solid angle of texel row j of a width x height lat-long map: (2 pi / width) (cos(pi j / height) - cos(pi (j + 1) /
// height)).
double env_texel_solid_angle(int width, int height, int j);

#endif
