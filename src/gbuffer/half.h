// A frame at half its size in both directions, for --resolution half.
#ifndef SSDO_GBUFFER_HALF_H
#define SSDO_GBUFFER_HALF_H

#include "gbuffer/gbuffer.h"

// Pixel (x, y) of `out` stands for pixels (2x, 2y) to (2x + 1, 2y + 1) of `g` (odd sizes are rounded up) and has the surface of
// one of them: of those that hold one, that of median depth, the nearer of two; no depth or normal is a mean over an edge. Its
// depth is where the ray of the new pixel's centre meets that surface's tangent plane, so that a plane stays one; unless that
// leaves the range of the 3 x 3 depths around it by more than that range; then it is the
// chosen pixel's own, or, where that is seen nearly edge-on, the pixel holds none. Albedo and beauty are means over the pixels on
// the chosen surface. The rest of the arrays is NULL. The camera is the same, in pixels of the new size. Free with gbuffer_free.
bool gbuffer_halve(const gbuffer *g, int threads, gbuffer *out, error *e);

#endif
