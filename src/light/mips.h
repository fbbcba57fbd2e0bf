// The mip pyramid of a lat-long map, weighted by solid angle.
//
// Level k + 1 has half the size of level k, rounded down (the sizes OpenGL expects), at least 1. Each of its texels is the mean
// over the sphere of what it covers; where sizes are odd, texels are shared in proportion to the solid angle covered. So the
// integral over the sphere is the same on every level, to float rounding of single texels.
#ifndef SSDO_LIGHT_MIPS_H
#define SSDO_LIGHT_MIPS_H

#include "base/error.h"
#include "light/env_map.h"

// Levels 1 and up of env, down to 1x1, from level 0. On failure the levels made so far belong to env all the same.
bool mips_build(environment *env, int threads, error *e);

#endif
