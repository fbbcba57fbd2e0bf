#version 450 core
// Depth and normal in one texel, for passes that read many of them: the bits of the depth, then pack_normal. With PLANES the highest bit
// of the second word is set where the surface lies on one of the frame's planes.
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/arc_params.glsl"

layout(rg32ui) writeonly uniform uimage2D surface_image;
PICTURE(rgba32f, planes_image);

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float depth = depth_at(p);
    vec3 N = normal_at(p);
    uint normal = pack_normal(N);
#ifdef PLANES
    vec3 P = position_of(p, depth);
    float noise = pixel_hash(uvec2(p)).x; // a plane that is believed by half takes half of its pixels
    for (int i = 0; i < params.planes; i++) {
        vec4 equation = FETCH(planes_image, ivec2(PLANE_EQUATION, i));
        float margin = FETCH(planes_image, ivec2(PLANE_LIGHT, i)).w * (is_orthographic() ? 1.0 : depth);
        float belief = FETCH(planes_image, ivec2(PLANE_BELIEF, i)).x;
        if (noise < belief && abs(dot(equation.xyz, P) - equation.w) <= margin && dot(equation.xyz, N) >= 0.99) normal |= 1u << 31u;
    }
#endif
    imageStore(surface_image, p, uvec4(floatBitsToUint(depth), normal, 0u, 0u));
}
