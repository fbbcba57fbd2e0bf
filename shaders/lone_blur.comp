#version 450 core
// The filter of blur.comp at the pixels of a list alone, over a square window. Without SCATTER it leaves its results in a buffer, so that
// no pixel reads what another has filtered; with SCATTER it brings them from there to the pictures.
// VISIBILITY: a scalar goes along with the colour.
#include "include/frame.glsl"
#include "include/bilateral.glsl"

#define SCALARS 0
#define COLOURS 1
#define COLOUR vec4 // the scalar is the fourth number
#include "include/values.glsl"
#include "params/blur.glsl"

#ifdef VISIBILITY
layout(r32f) uniform image2D scalar_image;
#endif
layout(rgba32f) uniform image2D colour_image;
layout(std430) readonly buffer Lone { uint lone[]; }; // tile: x the first of the list's pixels, y their end
layout(std430) buffer Filtered { vec4 filtered[]; };

Values load(ivec2 p) {
    vec4 v = LOAD(colour_image, p);
#ifdef VISIBILITY
    v.a = LOAD(scalar_image, p).r;
#endif
    return Values(v);
}

Values mean_around(ivec2 p) {
    Values centre = load(p), sum = values_of(0.0, vec4(0.0));
    Centre c = centre_at(p, depth_at(p), params.sharpness, params.radius);
    float total = 1.0;
    for (int y = -params.radius; y <= params.radius; y++)
        for (int x = -params.radius; x <= params.radius; x++) {
            ivec2 q = p + ivec2(x, y);
            if (x == 0 && y == 0) continue;
            float w = tap_weight(c, q, length(vec2(x, y)));
            if (w == 0.0) continue;
            sum = add(sum, w, load(q), centre);
            total += w;
        }
    return mean_of(centre, sum, total);
}

void main() {
    uint item = uint(tile.x) + gl_WorkGroupID.x * (GROUP_SIDE * GROUP_SIDE) + gl_LocalInvocationIndex;
    if (item >= uint(tile.y)) return;
    ivec2 p = ivec2(lone[item] & 0xffffu, lone[item] >> 16u);
#ifdef SCATTER
    imageStore(colour_image, p, vec4(filtered[item].rgb, 0.0));
#ifdef VISIBILITY
    imageStore(scalar_image, p, vec4(filtered[item].a));
#endif
#else
    filtered[item] = mean_around(p).colour0;
#endif
}
