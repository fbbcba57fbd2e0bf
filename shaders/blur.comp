#version 450 core
// One direction of a separable bilateral filter (include/bilateral.glsl) on linear quantities; weights are always divided out.
// FITTED: a line is fitted instead of a mean (include/bilateral_line.glsl).
// SCALARS and COLOURS say how many pictures go through together (include/values.glsl).
#define COLOUR vec3 // the fourth number is unused
#include "include/frame.glsl"
#include "include/bilateral.glsl"
#include "include/values.glsl"
#include "include/value_images.glsl"
#include "include/bilateral_line.glsl"

#include "params/blur.glsl"

void blur(ivec2 p) { store(p, mean_along(p, depth_at(p), params.step, params.sharpness, params.radius)); }

DRAWN_OR_DISPATCHED(blur)
