// A frame at half its size in both directions, for --resolution half.
#ifndef SSDO_GBUFFER_HALF_SIZE_H
#define SSDO_GBUFFER_HALF_SIZE_H

#include "gbuffer/gbuffer.h"

// Pixel (x, y) of `out` stands for pixels (2x, 2y) to (2x + 1, 2y + 1) of `g`; odd sizes are rounded up. It has the surface of
// one of them, so that no depth or normal is a mean over an edge. The pixel of median depth is tried first (the nearer of two),
// then the others. Depth is where the ray of the new pixel's centre meets that surface's tangent plane, so that a plane stays a
// plane. A pixel serves only if this depth leaves the range of the 3 x 3 depths around it by no more than the length of that
// range. If none serves, the depth is the median pixel's own; if that pixel is seen nearly edge-on, the new pixel holds no
// surface. The fourth number of the normal is the chosen pixel's place in the block, x + 2 y, and 4 more where the depth is
// that pixel's own. Albedo and beauty are means over the pixels on the chosen surface. The other arrays are NULL. The camera is
// the same, in pixels of the new size. Free with gbuffer_free.
bool gbuffer_halve(const gbuffer *g, int threads, gbuffer *out, error *e);

// After g was halved to `half`, and half to `quarter`: the fourth numbers of the quarter's normals tell places among the 4 x 4
// pixels of g, x + 4 y, and 16 more where the depth is one pixel's own.
void gbuffer_quarter_places(const gbuffer *half, gbuffer *quarter);

// The pixels of the whole frame, x | y << 16, row by row.
typedef struct pixel_list {
    uint32_t *pixels;
    size_t count;
} pixel_list;

// Pixels whose surface the frame of half the size does not show: of the four small pixels around one, weighed bilinearly, less
// than 0.3 have its surface. Free with pixel_list_free.
bool gbuffer_lone(const gbuffer *whole, const gbuffer *small, int threads, pixel_list *out, error *e);
void pixel_list_free(pixel_list *l);

#endif
