#version 450 core
// Pixels of a list get the mean of their own value and a neighbour's, by the shares of the pixel that the two surfaces cover
// (src/gbuffer/README.md, Mixed pixels):
//   v = own + s (neighbour - own)
// s is the neighbour's share of the pixel; of light, that share of what the pixel reflects, colour by colour (LIGHT). Without SCATTER the
// means go into a buffer, so that no pixel reads what another has written; with SCATTER they go from there to the picture.
// COLOUR: the picture holds four numbers a pixel, else one.
#include "include/frame.glsl"

#ifdef COLOUR
layout(rgba32f) uniform image2D value_image;
#else
layout(r32f) uniform image2D value_image;
#endif
layout(std430) readonly buffer Mixed { uvec4 mixed[]; }; // of a pixel: place, neighbour's place, shares; tile: x the first, y their end
layout(std430) buffer Means { vec4 means[]; };

ivec2 place(uint p) { return ivec2(p & 0xffffu, p >> 16u); }

void main() {
    uint item = uint(tile.x) + gl_WorkGroupID.x * (GROUP_SIDE * GROUP_SIDE) + gl_LocalInvocationIndex;
    if (item >= uint(tile.y)) return;
    uvec4 m = mixed[item];
#ifdef SCATTER
    imageStore(value_image, place(m.x), means[item]);
#else
    vec4 own = LOAD(value_image, place(m.x)), beside = LOAD(value_image, place(m.y));
    vec2 first = unpackUnorm2x16(m.z);
#ifdef LIGHT
    vec4 share = vec4(first.y, unpackUnorm2x16(m.w), 0.0);
#else
    vec4 share = vec4(first.x);
#endif
    means[item] = own + share * (beside - own);
#endif
}
