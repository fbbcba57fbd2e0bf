// Whether larger values of a depth lie nearer or farther, where its kind leaves that open. Internal to the room.
#ifndef SSDO_GBUFFER_DEPTH_DIRECTION_H
#define SSDO_GBUFFER_DEPTH_DIRECTION_H

#include "gbuffer/build.h"

typedef enum depth_direction { LARGER_UNKNOWN, LARGER_IS_NEARER, LARGER_IS_FARTHER } depth_direction;

// Told by the outlines of round surfaces, from the values as they are stored. linear_inverse: they are known to be linear in 1 /
// z; else they are either distances or 1 / z. Values of 0 and, where linear_inverse, of 1 and more count as background.
depth_direction depth_find_direction(const build *b, bool linear_inverse);

#endif
