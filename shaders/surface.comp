#version 450 core
// Depth and normal in one texel, for passes that read many of them: the bits of the depth, and pack_normal.
#include "include/frame.glsl"
#include "include/sampling.glsl"

layout(rg32ui, binding = 2) writeonly uniform uimage2D surface_image;

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    imageStore(surface_image, p, uvec4(floatBitsToUint(depth_at(p)), pack_normal(normal_at(p)), 0u, 0u));
}
