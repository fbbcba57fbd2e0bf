#version 450 core
// Screen-space spherical harmonics occlusion (Herholz et al. 2011): per pixel the SH vector of the cosine-weighted visibility,
//   o_lm = (2 pi / N) sum V(w) max(0, n.w) Y_lm(w),   l <= 2 (BANDS3: 3), in the axes of the world
// divided by (2 / N) sum max(0, n.w), which makes an open surface's o_00 exact. V is SSDO's point test. The samples come from 16 sets,
// one for each pixel of a 4 x 4 pattern; together they are one stratified set (s3ho_filter.comp brings them together).
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/recorded.glsl"
#include "include/sh.glsl"

#include "params/s3ho.glsl"

// Coefficients 0 1 2 | 3 4 5 | 6 7 8 | 9 10 11 12 | 13 14 15; the first image's w is the cosine-weighted open share, o_00 / (pi Y_00).
layout(rgba32f) writeonly uniform image2D sh0_image;
layout(rgba32f) writeonly uniform image2D sh1_image;
layout(rgba32f) writeonly uniform image2D sh2_image;
#ifdef BANDS3
layout(rgba32f) writeonly uniform image2D sh3_image;
layout(rgba32f) writeonly uniform image2D sh4_image;
#endif

// Which of the 16 sets a pixel has: neighbours far apart (the 4 x 4 ordered dither matrix).
int set_of(ivec2 p) {
    const int order[16] = int[](0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5);
    return order[(p.y & 3) * 4 + (p.x & 3)];
}

vec3 to_world(vec3 d) {
    return vec3(dot(params.world_from_camera[0].xyz, d), dot(params.world_from_camera[1].xyz, d),
                dot(params.world_from_camera[2].xyz, d));
}

void store(ivec2 p, float o[SH_COUNT], float open) {
    imageStore(sh0_image, p, vec4(o[0], o[1], o[2], open));
    imageStore(sh1_image, p, vec4(o[3], o[4], o[5], 0.0));
    imageStore(sh2_image, p, vec4(o[6], o[7], o[8], 0.0));
#ifdef BANDS3
    imageStore(sh3_image, p, vec4(o[9], o[10], o[11], o[12]));
    imageStore(sh4_image, p, vec4(o[13], o[14], o[15], 0.0));
#endif
}

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float o[SH_COUNT], y[SH_COUNT];
    for (int c = 0; c < SH_COUNT; c++) o[c] = 0.0;
    float depth = depth_at(p);
    if (depth == 0.0) {
        store(p, o, 1.0);
        return;
    }
    vec3 P = position_of(p, depth);
    mat3 tangents = tangent_frame(normal_at(p));
    float k = (float(set_of(p)) + 0.5) / 16.0, shift = fract(float(params.seed) * 0.754877666);
    float open = 0.0, total = 0.0;
    for (int i = 0; i < params.samples; i++) {
        float cosine = 1.0 - (float(i) + k) / float(params.samples), sine = sqrt(1.0 - cosine * cosine);
        float theta = 2.0 * PI * fract(float(i) * 0.618033989 + 5.0 * k + shift); // 5 and 11: the sets' order in angle and distance
        float lambda = params.radius * (1.0 - fract(float(i) * 0.754877666 + 11.0 * k + shift));
        vec3 w = tangents * vec3(sine * cos(theta), sine * sin(theta), cosine), point = P + lambda * w;
        total += cosine;
        float behind = behind_recorded(recorded_at(point), point);
        if (behind > 0.0 && behind <= params.thickness) continue;
        open += cosine;
        sh_basis(to_world(w), y);
        for (int c = 0; c < SH_COUNT; c++) o[c] += cosine * y[c];
    }
    for (int c = 0; c < SH_COUNT; c++) o[c] *= PI / total * band_of(c, params.bands);
    store(p, o, ratio(open, total));
}
