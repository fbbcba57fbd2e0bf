// What the tests of src/light share.
#ifndef SSDO_TESTS_TEST_LIGHT_H
#define SSDO_TESTS_TEST_LIGHT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <math.h>
#include <stdint.h>

#include "../lib/near.h"
#include "light/environment.h"

// 0 <= x < 1, the same sequence everywhere.
static inline double noise(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 40) / 16777216.0;
}

static inline vec3 random_direction(uint64_t *seed)
{
    double z = 2 * noise(seed) - 1, phi = 2 * M_PI * noise(seed), r = sqrt(1 - z * z);
    return v3(r * cos(phi), r * sin(phi), z);
}

static inline environment prepare(const float *rgb, int width, int height, bool up_z, double rotate)
{
    environment env;
    error e = {0};
    env_options options = {.up_z = up_z, .rotate_degrees = rotate, .scale = 1, .threads = 2};
    if (!environment_prepare(rgb, width, height, &options, &env, NULL, &e)) fail_msg("%s", e.message);
    return env;
}

#endif
