// Where the picture shows that there is nothing: the background pixels, and how far away the opening is that each is seen
// through. Used for what lies outside the frame (shaders/README.md, Outside).
#ifndef SSDO_PASSES_OPENINGS_H
#define SSDO_PASSES_OPENINGS_H

#include "gbuffer/gbuffer.h"

// Fills `rim`, width x height: 0 where the picture does not show an empty view ray. Elsewhere the planar depth of the opening,
// beyond which the view ray is taken to be outdoors: the depths of the nearest surfaces to the left and to the right,
// interpolated (1/z, with an orthographic camera z), or the same above and below, whichever is farther. The nearer of the two is
// often an object that stands before the opening. A pixel that a surface covers in part shows no empty ray, nor does one that is
// part of no empty 3 x 3 pixels: it may be a crack between two surfaces. False only for want of memory.
bool openings_find(const gbuffer *gb, float *rim, error *e);

// The share of the picture that shows a roof over the eye: surfaces that face down, lie above the eye, and are not seen to end
// under the sky (no background is seen on the way from them to the point straight above the eye). `up` in camera space, unit. 0
// with an orthographic camera, which has no eye. Measured on a regular grid of pixels.
double openings_roof(const gbuffer *gb, vec3 up);

#endif
