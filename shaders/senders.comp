#version 450 core
// What a bounce reads of each sample in one texel, a quarter of a cache line: the surface (surface.comp), the light that it sends and
// its albedo (include/senders.glsl). With ALBEDO the sender image is light before albedo.
#include "include/frame.glsl"
#include "include/senders.glsl"

UPICTURE(rg32ui, surface_image);
PICTURE(rgba32f, sender_image);
#ifdef ALBEDO
PICTURE(rgba32f, albedo_image);
#endif
layout(rgba32ui) writeonly uniform uimage2D senders_image;

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    vec3 L = FETCH(sender_image, p).rgb, albedo = vec3(1.0);
#ifdef ALBEDO
    albedo = FETCH(albedo_image, p).rgb;
    L *= albedo;
#endif
    imageStore(senders_image, p, uvec4(FETCH(surface_image, p).xy, pack_sender(L, albedo)));
}
