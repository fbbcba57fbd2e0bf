#version 450 core
// One bounce from K virtual lights (instant radiosity, Keller 1997), chosen on the picture by passes/vpl.c. Light k is a disc of area
// A_k that sends radiance L_k:
//   F_k = A_k cos_s cos_r / (pi d^2 + A_k)                        bounded disc form factor (README, correction 5)
//   indirect = strength * min(1, 1 / sum F) * sum F_k L_k
// There is no radius: light crosses the whole scene. There is no visibility either: it crosses what stands between.
#include "include/frame.glsl"

#include "params/vpl.glsl"

// A column a light: position and area; normal; radiance.
PICTURE(rgba32f, lights_image);
layout(rgba32f) writeonly uniform image2D indirect_image;

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float depth = depth_at(p);
    vec3 light = vec3(0.0);
    if (depth != 0.0) {
        vec3 P = position_of(p, depth), N = normal_at(p);
        float factors = 0.0;
        for (int k = 0; k < params.count; k++) {
            vec4 disc = FETCH(lights_image, ivec2(k, 0));
            vec3 w = disc.xyz - P; // unnormalised: both cosines carry a length
            float dd = dot(w, w);
            float received = dot(N, w), sent = -dot(FETCH(lights_image, ivec2(k, 1)).xyz, w);
            if (received <= 0.0 || sent <= 0.0) continue;
            float F = disc.w * received * sent / (dd * (PI * dd + disc.w));
            factors += F;
            light += F * FETCH(lights_image, ivec2(k, 2)).rgb;
        }
        light *= params.strength * min(1.0, 1.0 / max(factors, 1e-20));
    }
    imageStore(indirect_image, p, vec4(light, 0.0));
}
