// Choosing directions of an environment in proportion to the light that comes from them (importance sampling): Walker's alias
// table in Vose's form, a texel an entry.
#ifndef SSDO_LIGHT_ALIAS_TABLE_H
#define SSDO_LIGHT_ALIAS_TABLE_H

#include <stdint.h>

#include "light/environment.h"

// Entry i: with probability `keep` it is texel i, else texel `other`. `density` is that of texel i's directions, per steradian:
// the chance that one call chooses texel i, over its solid angle. As shaders/include/alias_table.glsl reads them (std430).
typedef struct env_choice {
    float keep;
    uint32_t other;
    float density;
} env_choice;

enum { ENV_MAX_CHOICES = 1 << 22 };

typedef struct env_alias_table {
    int width, height; // of the environment's sharpest level that has at most ENV_MAX_CHOICES texels
    env_choice *table; // row-major, top row first; owned
} env_alias_table;

// Chances follow the luminance that a bilinear lookup finds in the texel; in a black map, its solid angle.
bool env_alias_table_make(const environment *env, env_alias_table *out, error *e);
void env_alias_table_free(env_alias_table *c);

#endif
