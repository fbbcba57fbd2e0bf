// Choosing directions of an environment in proportion to the light that comes from them (importance sampling): Walker's alias
// table in Vose's form, a texel an entry.
#ifndef SSDO_LIGHT_CHOICES_H
#define SSDO_LIGHT_CHOICES_H

#include <stdint.h>

#include "light/environment.h"

// Entry i: with probability `keep` it is texel i, else texel `other`. `density` is that of texel i's directions, per steradian:
// the chance that one call chooses texel i, over its solid angle. As shaders/include/choices.glsl reads them (std430).
typedef struct env_choice {
    float keep;
    uint32_t other;
    float density;
} env_choice;

enum { ENV_MAX_CHOICES = 1 << 22 };

typedef struct env_choices {
    int width, height; // of the environment's sharpest level that has at most ENV_MAX_CHOICES texels
    env_choice *table; // row-major, top row first; owned
} env_choices;

// Chances follow the luminance that a bilinear lookup finds in the texel; in a black map, its solid angle.
bool env_choices_make(const environment *env, env_choices *out, error *e);
void env_choices_free(env_choices *c);

#endif
