#version 450 core
// SSDO, direct light: one loop, several outputs (Ritschel, Grosch, Seidel 2009).
//   occlusion  = (2 / N) sum V cos                  the cosine-weighted open share of (1 / pi) sum V cos (2 pi / N)
//   radiance   = sum (1 / pi) L_in V cos (2 pi / N)
//   visibility = sum V lum(L_in) cos / sum lum(L_in) cos
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/environment.glsl"
#include "include/ssdo.glsl"

layout(r32f) writeonly uniform image2D occlusion_image;
#ifdef LIGHT
layout(rgba32f) writeonly uniform image2D radiance_image;
#endif
#ifdef VISIBILITY
layout(r32f) writeonly uniform image2D visibility_image;
#endif

void store(ivec2 p, float occlusion, vec3 radiance, float visibility) {
    imageStore(occlusion_image, p, vec4(occlusion));
#ifdef LIGHT
    imageStore(radiance_image, p, vec4(radiance, 0.0));
#endif
#ifdef VISIBILITY
    imageStore(visibility_image, p, vec4(visibility));
#endif
}

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float depth = depth_at(p);
    if (depth == 0.0) {
        store(p, 1.0, vec3(0.0), 1.0);
        return;
    }
    vec3 P = position_of(p, depth);
    mat3 tangents = tangent_frame(normal_at(p));
    vec2 noise = pixel_hash(uvec2(p) + uint(params.seed) * 7919u);
    float open = 0.0, all_light = 0.0, open_light = 0.0;
    bool nothing = true; // blocks
    vec3 light = vec3(0.0);
    float solid_angle = 2.0 * PI / float(params.samples);
    for (int i = 0; i < params.samples; i++) {
        Sample s = ssdo_sample(i, P, tangents, noise);
        float visible = s.blocked ? 0.0 : 1.0;
        open += visible * s.cosine;
        nothing = nothing && !s.blocked;
#if defined(LIGHT) || defined(VISIBILITY)
        vec3 direction = to_map(s.direction);
        vec3 L = radiance_from(direction, params.level < 0.0 ? map_level(direction, solid_angle) : params.level);
        light += visible * s.cosine * L;
        float weight = dot(L, LUMINANCE) * s.cosine;
        all_light += weight;
        open_light += visible * weight;
#endif
    }
    float norm = 2.0 / float(params.samples);
    store(p, nothing ? 1.0 : min(1.0, open * norm), light * norm, all_light > 0.0 ? ratio(open_light, all_light) : 1.0);
}
