#version 450 core
// SSDO, one bounce: every blocked sample is a patch of A_s = pi R^2 / N that sends the light it received.
//   F_i = A_s cos_s cos_r / (pi d^2 + A_s)     bounded disc form factor (README, correction 5); the paper's A_s cos cos / (pi d^2) for large d
//   indirect = strength * min(1, B / sum F) * sum F_i fade(d_i) L_s rho_s,    B = (2 / N) sum blocked cos
// cos_s = dot(n_s, -dir), cos_r = dot(N, dir), dir from receiver to sender (README, correction 4). B bounds the sum: what arrives from
// senders cannot exceed the share of the hemisphere that they block.
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/ssdo.glsl"

PICTURE(rgba32f, sender_image); // blurred radiance before albedo, or a beauty
PICTURE(rgba32f, albedo_image);
layout(rgba32f) writeonly uniform image2D indirect_image;

vec3 exitant_radiance(ivec2 q) {
    vec3 L = FETCH(sender_image, q).rgb;
    return params.exitant == 1 ? L : L * FETCH(albedo_image, q).rgb;
}

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float depth = depth_at(p);
    if (depth == 0.0) {
        imageStore(indirect_image, p, vec4(0.0));
        return;
    }
    vec3 P = position_of(p, depth), N = normal_at(p);
    mat3 tangents = tangent_frame(N);
    vec2 noise = pixel_hash(uvec2(p) + uint(params.seed) * 7919u);
    float patch_area = PI * params.radius * params.radius / float(params.samples);
    float blocked = 0.0, factors = 0.0;
    vec3 light = vec3(0.0);
    for (int i = 0; i < params.samples; i++) {
        Sample s = ssdo_sample(i, P, tangents, noise);
        if (!s.blocked) continue;
        blocked += s.cosine;
        vec3 to_sender = s.surface - P;
        float dd = dot(to_sender, to_sender);
        if (dd <= 0.0) continue;
        float d = sqrt(dd);
        vec3 dir = to_sender / d;
        float F = patch_area * max(0.0, dot(normal_at(s.sender), -dir)) * max(0.0, dot(N, dir)) / (PI * dd + patch_area);
        factors += F;
        light += F * (1.0 - smoothstep(0.75, 1.0, d / params.radius)) * exitant_radiance(s.sender);
    }
    float bound = factors > 0.0 ? min(1.0, 2.0 * blocked / float(params.samples) / factors) : 0.0;
    imageStore(indirect_image, p, vec4(params.strength * bound * light, 0.0));
}
