// The size of what the camera sees, and the occlusion radius derived from it.
#ifndef SSDO_GBUFFER_RADIUS_H
#define SSDO_GBUFFER_RADIUS_H

#include "gbuffer/gbuffer.h"

// Median distance of the visible surface points from their component-wise median, scene units. In a perspective frame points
// beyond 4 times the median depth count as if they lay there on their ray, so that a ground that reaches the horizon does not
// set the scale. Half of the picture may be anything without moving it far. 0 without surfaces. False only for want of memory.
bool gbuffer_extent(const gbuffer *g, double *extent, error *e);

#endif
