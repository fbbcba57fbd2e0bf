#version 450 core
// Adds up what a sample's first rays found:
//   occlusion = mean of [nothing within the radius]
//   radiance  = mean of (gain if nothing was hit); its w: what it would be with nothing in the way, as luminance
#include "include/frame.glsl"
#include "include/trace.glsl"

layout(std430) readonly buffer Hits { Hit hits[]; };
layout(r32f) uniform image2D occlusion_image;
#ifdef LIGHT
layout(std430) readonly buffer Gains { vec4 gains[]; };
layout(rgba32f) uniform image2D radiance_image;
#endif

void main() {
    uint i = this_item();
    if (i >= batch_size()) return;
    ivec2 p = pixel_of(i);
    Hit h = hits[i];
    float open = h.triangle == HIT_NOTHING || h.t > params.radius ? 1.0 : 0.0;
    imageStore(occlusion_image, p, LOAD(occlusion_image, p) + vec4(open));
#ifdef LIGHT
    vec3 all = gains[i].rgb, light = h.triangle == HIT_NOTHING ? all : vec3(0.0);
    if (params.alias_table.x > 0) {
        uint j = batch_size() + i;
        all += gains[j].rgb;
        if (hits[j].triangle == HIT_NOTHING) light += gains[j].rgb;
    }
    imageStore(radiance_image, p, LOAD(radiance_image, p) + vec4(light, dot(all, LUMINANCE)));
#endif
}
