#version 450 core
// A filter that knows the noise it removes. m is the estimate, c its `half_difference`: how much the second half of the slices moved it.
// From edge-aware means (include/bilateral.glsl) of m, c and their squares over a window it computes
//   S = mean(m^2) - mean(m)^2   the variance in the window, of noise and of the picture
//   v = mean(c^2)              the variance of the noise: exactly that if the halves are independent, less if they are stratified
//   g = max(0, S - v) / S       the share of the picture in it
//   result = mean(m) + g (m - mean(m))
// Of all mixtures of m and mean(m) this one has the least expected error (a Wiener filter; Lee 1980). Where sampling has converged v is
// 0 and m stays as it is.
// ACROSS: the first direction; it stores the means along rows. ERRORS: also stores the squared error of the result, estimated from the
// noise that is left and the detail that is lost.
#include "include/frame.glsl"
#define MIXED_APART
#include "include/bilateral.glsl"

#define SCALARS 0
#define COLOURS 1
#define COLOUR vec4 // m, c, m^2, c^2
#include "include/values.glsl"

#include "params/denoise.glsl"

PICTURE(r32f, estimate_image);
PICTURE(r32f, half_difference_image);
#ifdef ACROSS
TARGET(0, vec4, rgba32f, moments_out); // means of m, c, m^2, c^2
const ivec2 STEP = ivec2(1, 0);
#else
PICTURE(rgba32f, moments_image);
TARGET(0, float, r32f, result_out);
const ivec2 STEP = ivec2(0, 1);
#ifdef ERRORS
TARGET(1, float, r32f, error_out);
#endif
#endif

Values load(ivec2 q) {
#ifdef ACROSS
    float m = FETCH(estimate_image, q).r, c = FETCH(half_difference_image, q).r;
    return Values(vec4(m, c, m * m, c * c));
#else
    return Values(FETCH(moments_image, q));
#endif
}
#include "include/bilateral_line.glsl"

void denoise(ivec2 p) {
    float depth = depth_at(p);
    vec4 mean = mean_along(p, depth, STEP, params.sharpness, params.radius).colour0;
#ifdef ACROSS
    PUT(moments_out, p, mean);
#else
    float m = FETCH(estimate_image, p).r;
    float S = max(0.0, mean.z - mean.x * mean.x), v = mean.w, seen = max(0.0, S - v);
    float g = S > 0.0 ? seen / S : 0.0;
    PUT(result_out, p, depth == 0.0 ? m : mix(mean.x, m, g));
#ifdef ERRORS
    float change = mix(mean.y, FETCH(half_difference_image, p).r, g);
    PUT(error_out, p, depth == 0.0 ? 0.0 : change * change + (1.0 - g) * (1.0 - g) * seen);
#endif
#endif
}

DRAWN_OR_DISPATCHED(denoise)
