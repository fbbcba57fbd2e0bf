// The surround: what is known of the world around the eye, in all directions (shaders/README.md, Outside).
#ifndef SSDO_PASSES_SURROUND_H
#define SSDO_PASSES_SURROUND_H

#include "gbuffer/gbuffer.h"
#include "gbuffer/world_view.h"

#include "../../shaders/include/constants.glsl"

// One map for each view, SURROUND_WIDTH x SURROUND_HEIGHT, one below the other: lat-long about the view's own eye, in the axes of
// the environment's map (light/environment.h). A texel holds two distances. The first is of a shell about the eye: of the nearest
// surface in its direction; negative, of the rim of an opening through which the outdoors are seen (openings.h); 0 where nothing
// is known. The second is of what is seen through an opening, 0 for the sky. Points are splatted as large as their pixels appear
// from the eye; gaps of a few texels between them are filled. A view from the frame's own eye takes the frame in as well. One
// more row holds the eyes in camera space, in two texels each: x y, z 0. `out` comes zeroed. Deterministic, whatever the threads.
bool surround_make(const world_view *views, int count, const gbuffer *gb, mat3 map_from_camera, int threads, float (*out)[2],
                   error *e);

#endif
