#version 450 core
// From the sums over all samples to the layers.
#include "include/frame.glsl"
#include "include/trace.glsl"

layout(r32f) uniform image2D occlusion_image;
#ifdef LIGHT
layout(rgba32f) uniform image2D radiance_image;
#endif
#ifdef BOUNCE
layout(rgba32f) uniform image2D indirect_image;
#endif
#ifdef VISIBILITY
layout(r32f) writeonly uniform image2D visibility_image;
#endif

void main() {
    uint i = this_item();
    if (i >= batch_size()) return;
    ivec2 p = pixel_of(i);
    float share = 1.0 / float(params.samples);
    imageStore(occlusion_image, p, LOAD(occlusion_image, p) * share);
#ifdef LIGHT
    vec4 light = LOAD(radiance_image, p);
#ifdef VISIBILITY
    float lit = dot(light.rgb, LUMINANCE);
    imageStore(visibility_image, p, vec4(light.w > 0.0 ? lit / light.w : 1.0));
#endif
    imageStore(radiance_image, p, vec4(light.rgb * share, 0.0));
#endif
#ifdef BOUNCE
    imageStore(indirect_image, p, LOAD(indirect_image, p) * share * params.strength);
#endif
}
