#version 450 core
// Brings the layers of a frame of half the size (src/gbuffer/half_size.h) to full size. A pixel is the bilinear mean of the four nearest small
// pixels. A small pixel weighs less the further it lies off the pixel's tangent plane (in small footprints) and the more its normal
// differs (as in blur.comp). If none of the four is on the pixel's surface, the pixel copies the best of sixteen. If no surface is near
// (a speck seen edge-on), the pixel is open; with OPEN_LIGHT its colour 0 is the SH irradiance / pi.
// SCALARS and COLOURS say how many pictures go through together (include/values.glsl).
#define COLOUR vec4
#include "include/frame.glsl"
#ifdef OPEN_LIGHT
#include "include/environment.glsl"
#endif
#include "include/values.glsl"
#include "include/value_images.glsl"

#include "params/upsample.glsl"
// Copies made before main: llvmpipe reads a uniform inside any control flow once for every lane.
ivec2 small_size = ivec2(params.small_size.x, params.small_size.y);
float sharpness = params.sharpness;

PICTURE(r32f, small_depth);
PICTURE(rgba32f, small_normal);

float small_depth_at(ivec2 q) {
    bool inside = all(greaterThanEqual(q, ivec2(0))) && all(lessThan(q, small_size));
    return inside ? FETCH(small_depth, q).r : 0.0;
}

// How well a small pixel's surface agrees with the plane (P, N): 1 on it, 0 far from it.
float agreement(ivec2 q, float depth, vec3 P, vec3 N, float scale) {
    float off_plane = dot(N, position_at(2.0 * (vec2(q) + 0.5), depth) - P) * scale;
    return exp(-0.5 * off_plane * off_plane) * pow(max(0.0, dot(N, FETCH(small_normal, q).xyz)), 8.0);
}

// The small pixel of 4 x 4 that agrees best, by a measure that still ranks those far from the plane. Negative if none holds a surface, or
// if it is not `wanted`. A software renderer runs a branch for all lanes if one lane takes it, but it leaves a loop when no lane is left.
ivec2 best_of(ivec2 base, vec3 P, vec3 N, float scale, bool wanted) {
    float least = 1e30;
    ivec2 best = ivec2(-1);
    int last = wanted ? 2 : -2;
    for (int y = -1; y <= last; y++)
        for (int x = -1; x <= last; x++) {
            ivec2 q = base + ivec2(x, y);
            float depth = small_depth_at(q);
            if (depth == 0.0) continue;
            float off_plane = abs(dot(N, position_at(2.0 * (vec2(q) + 0.5), depth) - P)) * scale;
            float cost = min(off_plane, 1e6) + 4.0 * (1.0 - dot(N, FETCH(small_normal, q).xyz));
            if (cost < least) {
                least = cost;
                best = q;
            }
        }
    return best;
}

// For a pixel that none of the four is near.
Values lost(ivec2 base, vec3 P, vec3 N, float scale, bool wanted) {
    Values v = values_of(1.0, vec4(0.0)); // open
    ivec2 best = best_of(base, P, N, scale, wanted);
    for (int n = best.x >= 0 ? 0 : 1; n < 1; n++) v = load(best);
#ifdef OPEN_LIGHT
    for (int n = wanted && best.x < 0 ? 0 : 1; n < 1; n++) v.colour0 = vec4(sh_irradiance_over_pi(params.light, to_map(N)), 0.0);
#endif
    return v;
}

void upsample(ivec2 p) {
    float depth = depth_at(p);
    vec3 P = position_of(p, depth), N = normal_at(p);
    float scale = 1.0 / (sharpness * 2.0 * footprint(depth));
    vec2 place = 0.5 * (vec2(p) + 0.5) - 0.5;
    ivec2 base = ivec2(floor(place));
    vec2 part = place - vec2(base);
    Values start = values_of(1.0, vec4(0.0)), sum = values_of(0.0, vec4(0.0)); // start: of the first tap that holds a surface
    float total = 0.0;
    bool none = true;
    for (int k = 0; k < (depth != 0.0 ? 4 : 0); k++) {
        ivec2 offset = ivec2(k & 1, k >> 1), q = base + offset;
        float tap_depth = small_depth_at(q);
        if (tap_depth == 0.0) continue;
        vec2 near = mix(1.0 - part, part, vec2(offset));
        float w = near.x * near.y * agreement(q, tap_depth, P, N, scale);
        Values v = load(q);
        if (none) start = v;
        none = false;
        sum = add(sum, w, v, start);
        total += w;
    }
    if (total > 1e-3) start = mean_of(start, sum, total);
    bool wanted = depth != 0.0 && total <= 1e-3;
    Values other = lost(base, P, N, scale, wanted);
    if (wanted) start = other;
    store(p, start);
}

DRAWN_OR_DISPATCHED(upsample)
