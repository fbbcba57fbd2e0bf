#version 450 core
// lint: SCALARS=2 COLOURS=1 OPEN_LIGHT | SCALARS=1 COLOURS=0 OPEN_LIGHT | SCALARS=0 COLOURS=1
// Layers of a frame of half the size (src/gbuffer/half.h) brought to the full one: a bilinear mean over the four nearest small pixels, each
// weighing less the further it lies off the pixel's tangent plane, in small footprints, and the more its normal differs (as in
// blur.frag). Where none of the four is on the pixel's surface, the best of sixteen is taken as it is; where no surface is near at all
// (a speck seen edge-on) the pixel is open, and with OPEN_LIGHT its light is the SH irradiance / pi.
// SCALARS and COLOURS say how many r32f and rgba32f images go through together.
#include "include/frame.glsl"
#ifdef OPEN_LIGHT
#include "include/environment.glsl"
#endif

layout(std140, binding = 1) uniform Params {
    ivec2 small_size;
    float sharpness; // plane distance, in footprints of a small pixel, at which the weight has fallen to exp(-1/2)
    int unused;
} params;

layout(r32f, binding = 2) readonly uniform image2D small_depth;
layout(rgba32f, binding = 3) readonly uniform image2D small_normal;
#if SCALARS > 0
layout(r32f, binding = 4) readonly uniform image2D scalar0_in;
layout(r32f, binding = 5) writeonly uniform image2D scalar0_out;
#endif
#if SCALARS > 1
layout(r32f, binding = 6) readonly uniform image2D scalar1_in;
layout(r32f, binding = 7) writeonly uniform image2D scalar1_out;
#endif
#if COLOURS > 0
layout(rgba32f, binding = 8) readonly uniform image2D colour0_in;
layout(rgba32f, binding = 9) writeonly uniform image2D colour0_out;
#endif

struct Values { float scalar0, scalar1; vec4 colour0; };

Values load(ivec2 q) {
    Values v = Values(0.0, 0.0, vec4(0.0));
#if SCALARS > 0
    v.scalar0 = imageLoad(scalar0_in, q).r;
#endif
#if SCALARS > 1
    v.scalar1 = imageLoad(scalar1_in, q).r;
#endif
#if COLOURS > 0
    v.colour0 = imageLoad(colour0_in, q);
#endif
    return v;
}

void store(ivec2 p, Values v) {
#if SCALARS > 0
    imageStore(scalar0_out, p, vec4(v.scalar0));
#endif
#if SCALARS > 1
    imageStore(scalar1_out, p, vec4(v.scalar1));
#endif
#if COLOURS > 0
    imageStore(colour0_out, p, v.colour0);
#endif
}

float small_depth_at(ivec2 q) {
    bool inside = all(greaterThanEqual(q, ivec2(0))) && all(lessThan(q, params.small_size));
    return inside ? imageLoad(small_depth, q).r : 0.0;
}

// How well a small pixel's surface agrees with the plane (P, N): 1 on it, 0 far from it.
float agreement(ivec2 q, float depth, vec3 P, vec3 N, float scale) {
    float off_plane = dot(N, position_at(2.0 * (vec2(q) + 0.5), depth) - P) * scale;
    return exp(-0.5 * off_plane * off_plane) * pow(max(0.0, dot(N, imageLoad(small_normal, q).xyz)), 8.0);
}

// The small pixel of 4 x 4 that agrees best, by a measure that still tells far ones apart; false if none holds a surface.
bool best_of(ivec2 base, vec3 P, vec3 N, float scale, out ivec2 best) {
    float least = 1e30;
    best = ivec2(-1);
    for (int y = -1; y <= 2; y++)
        for (int x = -1; x <= 2; x++) {
            ivec2 q = base + ivec2(x, y);
            float depth = small_depth_at(q);
            if (depth == 0.0) continue;
            float off_plane = abs(dot(N, position_at(2.0 * (vec2(q) + 0.5), depth) - P)) * scale;
            float cost = min(off_plane, 1e6) + 4.0 * (1.0 - dot(N, imageLoad(small_normal, q).xyz));
            if (cost < least) {
                least = cost;
                best = q;
            }
        }
    return best.x >= 0;
}

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float depth = depth_at(p);
    if (depth == 0.0) {
        store(p, Values(1.0, 1.0, vec4(0.0)));
        return;
    }
    vec3 P = position_of(p, depth), N = normal_at(p);
    float scale = 1.0 / (params.sharpness * 2.0 * footprint(depth));
    vec2 place = 0.5 * (vec2(p) + 0.5) - 0.5;
    ivec2 base = ivec2(floor(place)), first = ivec2(-1);
    vec2 part = place - vec2(base);
    // Differences from one tap are summed, so that a constant passes unchanged to the bit.
    Values start = Values(1.0, 1.0, vec4(0.0)), sum = Values(0.0, 0.0, vec4(0.0));
    float total = 0.0;
    for (int k = 0; k < 4; k++) {
        ivec2 offset = ivec2(k & 1, k >> 1), q = base + offset;
        float tap_depth = small_depth_at(q);
        if (tap_depth == 0.0) continue;
        vec2 near = mix(1.0 - part, part, vec2(offset));
        float w = near.x * near.y * agreement(q, tap_depth, P, N, scale);
        Values v = load(q);
        if (first.x < 0) {
            first = q;
            start = v;
        }
        sum.scalar0 += w * (v.scalar0 - start.scalar0);
        sum.scalar1 += w * (v.scalar1 - start.scalar1);
        sum.colour0 += w * (v.colour0 - start.colour0);
        total += w;
    }
    if (total > 1e-3) {
        store(p, Values(start.scalar0 + sum.scalar0 / total, start.scalar1 + sum.scalar1 / total, start.colour0 + sum.colour0 / total));
    } else {
        if (best_of(base, P, N, scale, first)) start = load(first);
#ifdef OPEN_LIGHT
        else start.colour0 = vec4(sh_irradiance_over_pi(to_map(N)), 0.0);
#endif
        store(p, start);
    }
}
