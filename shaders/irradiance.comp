#version 450 core
// Radiance of a method that knows only how much is open: SH irradiance / pi times occlusion.
#include "include/frame.glsl"
#include "include/environment.glsl"

PICTURE(r32f, occlusion_image);
layout(rgba32f) writeonly uniform image2D radiance_image;

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    vec3 radiance = vec3(0.0);
    if (depth_at(p) != 0.0) radiance = sh_irradiance_over_pi(to_map(normal_at(p))) * FETCH(occlusion_image, p).r;
    imageStore(radiance_image, p, vec4(radiance, 0.0));
}
