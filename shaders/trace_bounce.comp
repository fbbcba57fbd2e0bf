#version 450 core
// lint: LIGHT BOUNCE | LIGHT | BOUNCE | NOTHING
// Adds up what a sample's first rays found, and with BOUNCE sends rays on from what they hit:
//   occlusion = mean of [nothing within the radius]
//   radiance  = mean of (gain if nothing was hit); its w: what it would be with nothing in the way, as luminance
//   indirect  = mean of albedo(x) (1 / pi) integral L V cos at the point x that was hit, one ray of each strategy
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/environment.glsl"
#include "include/trace.glsl"

layout(std430, binding = 0) readonly buffer Rays { Ray rays[]; };
layout(std430, binding = 1) readonly buffer Hits { Hit hits[]; };
layout(r32f, binding = 4) uniform image2D occlusion_image;
#ifdef LIGHT
layout(std430, binding = 2) readonly buffer Gains { vec4 gains[]; };
layout(rgba32f, binding = 5) uniform image2D radiance_image;
#endif
#if defined(LIGHT) || defined(BOUNCE)
#include "include/choices.glsl"
#endif
#ifdef BOUNCE
layout(std430, binding = 4) writeonly buffer NextRays { Ray next_rays[]; };
layout(std430, binding = 5) writeonly buffer NextGains { vec4 next_gains[]; };

void send(uint k, vec3 at, vec3 face, float lift, vec3 normal, vec3 w, vec3 map_direction, vec3 albedo) {
    vec3 gain = albedo * light_from(map_direction, dot(normal, w));
    next_rays[k] = ray_from(at, face, lift, to_mesh(w), gain == vec3(0.0) ? -1.0 : FAR, true);
    next_gains[k] = vec4(gain, 0.0);
}

// Directions are in camera space here, the surface's normal too.
void bounce(ivec2 p, uint i, Ray r, Hit h) {
    bool found = h.triangle < NO_RAY;
    Triangle t = triangles[found ? h.triangle : 0u];
    vec3 at = r.origin.xyz + (found ? h.t : 0.0) * r.direction.xyz, face = face_of(t, r.direction.xyz);
    vec3 normal = to_camera(face), albedo = found ? albedo_of(t) : vec3(0.0);
    float lift = lift_of(t, at);
    vec3 w = tangent_frame(normal) * cosine_direction(numbers_of(p, 0u).xy);
    send(i, at, face, lift, normal, w, to_map(w), albedo);
    if (!has_choices()) return;
    vec3 bright = choose_direction(numbers_of(p, 1u));
    send(batch_size() + i, at, face, lift, normal, from_map(bright), bright, albedo);
}
#endif

void main() {
    uint i = this_item();
    if (i >= batch_size()) return;
    ivec2 p = pixel_of(i);
    Hit h = hits[i];
    float open = h.triangle == MISS || h.t > params.radius ? 1.0 : 0.0;
    imageStore(occlusion_image, p, imageLoad(occlusion_image, p) + vec4(open));
#ifdef LIGHT
    vec3 all = gains[i].rgb, light = h.triangle == MISS ? all : vec3(0.0);
    if (has_choices()) {
        uint j = batch_size() + i;
        all += gains[j].rgb;
        if (hits[j].triangle == MISS) light += gains[j].rgb;
    }
    imageStore(radiance_image, p, imageLoad(radiance_image, p) + vec4(light, dot(all, vec3(0.2126, 0.7152, 0.0722))));
#endif
#ifdef BOUNCE
    bounce(p, i, rays[i], h);
#endif
}
