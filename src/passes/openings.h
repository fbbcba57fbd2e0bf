// Where the picture shows that there is nothing: the background pixels, and how far away the opening is that each is seen
// through. Used for what lies outside the frame (shaders/README.md, Outside).
#ifndef SSDO_PASSES_OPENINGS_H
#define SSDO_PASSES_OPENINGS_H

#include "gbuffer/gbuffer.h"

// Where a grid of depths shows the outdoors: empty cells, and surfaces that are seen through the same opening as they.
//
// depth: width x height; 0 nothing is known, INFINITY empty, else the depth of a surface. wraps: the left border meets the right
// one. rim: filled with 0 where the outdoors are not seen, elsewhere with the depth of the opening, beyond which the ray is
// outdoors. Of an empty cell it is interpolated (1/depth) between the nearest surfaces to the left and to the right, or above and
// below, whichever is farther: the nearer one is often something that stands before the opening. Of two sides that differ by more
// than a factor of 2 the farther one is ground seen through the opening, and does not count. A surface beside an empty cell and
// more than half as far again as its rim is outdoors too, and so on along that surface.
bool outdoors_find(const float *depth, int width, int height, bool wraps, float *rim, error *e);

// The same of a frame. A pixel that a surface covers in part is not empty, nor is one that is part of no empty 3 x 3 pixels: it
// may be a crack between two surfaces. False only for want of memory.
bool openings_find(const gbuffer *gb, float *rim, error *e);

// The share of the picture that shows a roof over the eye: surfaces that face down, lie above the eye, and are not seen to end
// under the sky (no background is seen on the way from them to the point straight above the eye). `up` in camera space, unit. 0
// with an orthographic camera, which has no eye. Measured on a regular grid of pixels.
double openings_roof(const gbuffer *gb, vec3 up);

#endif
