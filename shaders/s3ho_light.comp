#version 450 core
// From the SH vector o of cosine-weighted visibility to the layers:
//   radiance   = (1 / pi) sum o_lm L_lm           L_lm: the environment's plain radiance coefficients in the axes of o
//   visibility = luminance of that over its value with nothing in the way (o_lm = A_l Y_lm(n), A = pi, 2 pi / 3, pi / 4, 0)
#include "include/frame.glsl"
#include "include/sh.glsl"

#include "params/s3ho_light.glsl"

PICTURE(rgba32f, sh0_image);
PICTURE(rgba32f, sh1_image);
PICTURE(rgba32f, sh2_image);
layout(r32f) writeonly uniform image2D occlusion_image;
#ifdef BANDS3
PICTURE(rgba32f, sh3_image);
PICTURE(rgba32f, sh4_image);
#endif
#ifdef LIGHT
layout(rgba32f) writeonly uniform image2D radiance_image;
#endif
#ifdef VISIBILITY
layout(r32f) writeonly uniform image2D visibility_image;
#endif

vec3 lit(float o[SH_COUNT]) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < SH_COUNT; i++) sum += o[i] * params.light[i].rgb;
    return max(sum / PI, vec3(0.0)); // few bands ring below zero
}

vec3 open_light(vec3 n) {
    vec3 d = vec3(dot(params.world_from_camera[0].xyz, n), dot(params.world_from_camera[1].xyz, n), dot(params.world_from_camera[2].xyz, n));
    float y[SH_COUNT];
    sh_basis(d, y);
    for (int i = 0; i < SH_COUNT; i++) y[i] *= band_of(i, params.bands);
    return lit(y);
}

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    vec4 a = FETCH(sh0_image, p), b = FETCH(sh1_image, p), c = FETCH(sh2_image, p);
    bool surface = depth_at(p) != 0.0;
    imageStore(occlusion_image, p, vec4(surface ? a.w : 1.0));
#if defined(LIGHT) || defined(VISIBILITY)
#ifdef BANDS3
    vec4 d = FETCH(sh3_image, p), e = FETCH(sh4_image, p);
    float o[SH_COUNT] = float[](a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, d.x, d.y, d.z, d.w, e.x, e.y, e.z);
#else
    float o[SH_COUNT] = float[](a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z);
#endif
    vec3 radiance = surface ? lit(o) : vec3(0.0);
#endif
#ifdef LIGHT
    imageStore(radiance_image, p, vec4(radiance, 0.0));
#endif
#ifdef VISIBILITY
    float all = surface ? dot(LUMINANCE, open_light(normal_at(p))) : 0.0;
    imageStore(visibility_image, p, vec4(all > 0.0 ? min(1.0, dot(LUMINANCE, radiance) / all) : 1.0));
#endif
}
