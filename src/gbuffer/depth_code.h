// How depth is stored. Internal to the room.
#ifndef SSDO_GBUFFER_DEPTH_CODE_H
#define SSDO_GBUFFER_DEPTH_CODE_H

#include <math.h>
#include <stdbool.h>

#include "gbuffer/resolve.h"

typedef struct depth_code {
    depth_kind kind;  // DEPTH_PLANAR and DEPTH_RADIAL are taken as they are
    double sign;      // -1: stored as negative camera z
    double near, far; // of the kinds that need them
} depth_code;

// Whether the kind's values mean something only between two distances.
static inline bool depth_needs_range(depth_kind k) { return k >= DEPTH_LINEAR; }

// What it means in a sentence.
const char *depth_text(depth_kind k);

// Distance; NaN for a value that stands for the background.
double depth_convert(const depth_code *c, double value);
static inline double depth_decode(const depth_code *c, double value)
{
    return c->kind <= DEPTH_RADIAL ? c->sign * value : depth_convert(c, value);
}

#endif
