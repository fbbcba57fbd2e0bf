#version 450 core
// Adds what the bounce's rays bring (trace_bounce.comp) to the sum of the pixel.
#include "include/frame.glsl"
#include "include/trace.glsl"

layout(std430) readonly buffer Hits { Hit hits[]; };
layout(std430) readonly buffer Gains { vec4 gains[]; };
layout(rgba32f) uniform image2D indirect_image;

void main() {
    uint i = this_item();
    if (i >= batch_size()) return;
    ivec2 p = pixel_of(i);
    vec3 light = hits[i].triangle == HIT_NOTHING ? gains[i].rgb : vec3(0.0);
    uint j = batch_size() + i;
    if (params.alias_table.x > 0 && hits[j].triangle == HIT_NOTHING) light += gains[j].rgb;
    imageStore(indirect_image, p, LOAD(indirect_image, p) + vec4(light, 0.0));
}
