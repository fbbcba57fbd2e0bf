#version 450 core
// Brings a colour to the frame of half the size (src/gbuffer/half_size.h): the mean over the pixels of a block that are on the small pixel's
// surface. If none is, the one whose surface is nearest to it.
#include "include/frame.glsl"

#include "params/downsample.glsl"
// Copies made before main: llvmpipe reads a uniform inside any control flow once for every lane.
ivec2 whole_size = ivec2(params.whole_size.x, params.whole_size.y);
float near = params.near, like = params.like;

PICTURE(r32f, whole_depth);
PICTURE(rgba32f, whole_normal);
PICTURE(rgba32f, colour_in);
TARGET(0, vec4, rgba32f, colour_out);

void downsample(ivec2 p) {
    float depth = depth_at(p), count = 0.0, least = 1e30, margin = near * 0.5 * footprint(depth);
    vec3 P = position_of(p, depth), N = normal_at(p);
    vec4 sum = vec4(0.0), nearest = vec4(0.0);
    for (int k = 0; k < (depth != 0.0 ? 4 : 0); k++) {
        ivec2 q = 2 * p + ivec2(k & 1, k >> 1);
        float there = all(lessThan(q, whole_size)) ? FETCH(whole_depth, q).r : 0.0;
        if (there == 0.0) continue;
        float off = abs(dot(N, position_at(0.5 * (vec2(q) + 0.5), there) - P));
        bool on = off <= margin && dot(N, FETCH(whole_normal, q).xyz) >= like;
        vec4 colour = FETCH(colour_in, q);
        sum += on ? colour : vec4(0.0);
        count += on ? 1.0 : 0.0;
        nearest = off < least ? colour : nearest;
        least = min(off, least);
    }
    PUT(colour_out, p, count > 0.0 ? sum / count : nearest);
}

DRAWN_OR_DISPATCHED(downsample)
