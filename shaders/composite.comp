#version 450 core
// The lit picture (README, Composite). One of:
//   RELIGHT            kD albedo (radiance + indirect) + specular + emission          (radiance mode)
//   RELIGHT VISIBILITY kD albedo (E_SH / pi visibility + indirect) + specular + emission   (visibility mode)
//   SPLIT              beauty - (1 - a) albedo direct  (+ albedo indirect)             only direct diffuse light is occluded
//   (none)             beauty a (+ albedo indirect)                                    a = lerp(1, occlusion, amount)
// BACKGROUND: what is behind surfaces that are relit: 0 nothing, 1 the beauty, 2 the environment.
// MULTIPLY_ALL: the occlusion is multiplied onto the specular light too, as games do (README, correction 10).
// DEPTHMASK: the result is scaled by 1 + strength x depthmask. Luft adds the mask to display values; in linear light a sum could go
// negative and would depend on the exposure.
// A relit pixel whose coverage k is below 1: k surface + (1 - k) background.
// A beauty to which nothing is done must keep every bit. Drawing may flush denormals, so its composite is dispatched on every device
// (src/passes/composite.c).
#include "include/frame.glsl"
#include "include/environment.glsl"
#include "params/composite.glsl"

PICTURE(r32f, occlusion_image); // visibility in VISIBILITY mode
#ifdef ALBEDO
PICTURE(rgba32f, albedo_image);
#endif
#ifdef RADIANCE
PICTURE(rgba32f, radiance_image); // in SPLIT: the renderer's own direct diffuse light
#endif
#ifdef INDIRECT
PICTURE(rgba32f, indirect_image);
#endif
#if defined(SPECULAR)
PICTURE(rgba32f, specular_image);
PICTURE(rgba32f, diffuse_share_image);
#endif
#ifdef EMISSION
PICTURE(rgba32f, emission_image);
#endif
#ifdef BEAUTY
PICTURE(rgba32f, beauty_image);
#endif
#ifdef COVERAGE
PICTURE(r32f, coverage_image);
#endif

#ifdef DEPTHMASK
PICTURE(r32f, depthmask_image);
#endif

float coverage_at(ivec2 p) {
#ifdef COVERAGE
    return FETCH(coverage_image, p).r;
#else
    return depth_at(p) != 0.0 ? 1.0 : 0.0;
#endif
}

vec3 indirect_at(ivec2 p) {
#ifdef INDIRECT
    return FETCH(indirect_image, p).rgb;
#else
    return vec3(0.0);
#endif
}

vec3 diffuse_light = vec3(0.0); // of the pixel, once composite() has run: kD albedo (radiance + indirect), per unit coverage times k

#ifdef RELIGHT
// Light of the surface in pixel p, multiplied by its coverage k.
vec3 surface(ivec2 p, float k) {
    vec3 light = indirect_at(p);
#ifdef VISIBILITY
    light += sh_irradiance_over_pi(to_map(normal_at(p))) * FETCH(occlusion_image, p).r;
#else
    light += FETCH(radiance_image, p).rgb;
#endif
    float covered = params.averaged == 1 ? 1.0 : k;
    vec3 colour = covered * FETCH(albedo_image, p).rgb * light;
#ifdef SPECULAR
    colour *= FETCH(diffuse_share_image, p).rgb;
#endif
    diffuse_light = colour;
#ifdef SPECULAR
    vec3 specular = FETCH(specular_image, p).rgb;
#ifdef MULTIPLY_ALL
    specular *= mix(1.0, FETCH(occlusion_image, p).r, params.amount);
#endif
    colour += k * specular;
#endif
#ifdef EMISSION
    colour += covered * FETCH(emission_image, p).rgb;
#endif
    return colour;
}

// What is seen behind the surface of pixel p: the beauty of the nearest pixel that no surface touches, or the environment.
// `wanted`: the result is used. A software renderer runs a branch for all lanes if one lane takes it, but it leaves a loop when no lane
// is left in it. So the loop is what skips the work.
vec3 background(ivec2 p, bool wanted) {
#if BACKGROUND == 2
    vec3 ray = is_orthographic() ? vec3(0.0, 0.0, 1.0) : normalize(ray_at(vec2(p) + 0.5));
    vec3 direction = to_map(ray);
    float pixel = 1.0 / (frame_lens.x * frame_lens.y) * pow(ray.z, 3.0);
    return radiance_from(direction, is_orthographic() ? 0.0 : map_level(direction, pixel));
#elif BACKGROUND == 1
    int best = 1 << 20, reach = wanted ? 2 : -1;
    vec3 colour = vec3(0.0);
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            ivec2 q = p + ivec2(x, y);
            if (in_frame(q) && coverage_at(q) == 0.0 && x * x + y * y < best) {
                best = x * x + y * y;
                colour = FETCH(beauty_image, q).rgb;
            }
        }
    return colour;
#else
    return vec3(0.0);
#endif
}

vec3 lit(ivec2 p) {
    float k = coverage_at(p);
    vec3 colour = k > 0.0 ? surface(p, k) : vec3(0.0);
    return k < 1.0 ? colour + (1.0 - k) * background(p, k < 1.0) : colour;
}
#else
vec3 lit(ivec2 p) {
    vec3 colour = FETCH(beauty_image, p).rgb;
    float open = mix(1.0, FETCH(occlusion_image, p).r, params.amount);
#ifdef SPLIT
    colour -= (1.0 - open) * FETCH(albedo_image, p).rgb * FETCH(radiance_image, p).rgb;
#else
    colour *= open;
#endif
#ifdef INDIRECT
    colour += FETCH(albedo_image, p).rgb * indirect_at(p) * (params.averaged == 1 ? 1.0 : coverage_at(p));
#endif
    return colour;
}
#endif

TARGET(0, vec4, rgba32f, composite_out);
#ifdef DIFFUSE
TARGET(1, vec4, rgba32f, diffuse_out);
#endif

void composite(ivec2 p) {
    vec3 colour = lit(p);
#ifdef DEPTHMASK
    colour *= max(0.0, 1.0 + params.depthmask * FETCH(depthmask_image, p).r);
#endif
    PUT(composite_out, p, vec4(colour, 0.0));
#ifdef DIFFUSE
    PUT(diffuse_out, p, vec4(diffuse_light, 0.0));
#endif
}

DRAWN_OR_DISPATCHED(composite)
