#version 450 core
// Sends rays on from what a sample's first rays hit:
//   indirect = mean of albedo(x) (1 / pi) integral L V cos at the point x that was hit, one ray of each strategy
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/environment.glsl"
#include "include/trace.glsl"
#include "include/triangles.glsl"
#include "include/alias_table.glsl"

layout(std430) readonly buffer Rays { Ray rays[]; };
layout(std430) readonly buffer Hits { Hit hits[]; };
layout(std430) writeonly buffer NextRays { Ray next_rays[]; };
layout(std430) writeonly buffer NextGains { vec4 next_gains[]; };

void send(uint k, vec3 at, vec3 face, float lift, vec3 normal, vec3 w, vec3 map_direction, vec3 albedo) {
    vec3 gain = albedo * light_from(map_direction, dot(normal, w));
    next_rays[k] = ray_from(at, face, lift, to_mesh(w), gain == vec3(0.0) ? -1.0 : RAY_FAR, true);
    next_gains[k] = vec4(gain, 0.0);
}

// Directions are in camera space here, the surface's normal too.
void bounce(ivec2 p, uint i, Ray r, Hit h) {
    bool found = h.triangle < HIT_NO_RAY;
    Triangle t = triangles[found ? h.triangle : 0u];
    vec3 at = r.origin.xyz + (found ? h.t : 0.0) * r.direction.xyz, face = face_of(t, r.direction.xyz);
    vec3 normal = to_camera(face), albedo = found ? albedo_of(t) : vec3(0.0);
    float lift = lift_of(t, at);
    vec3 w = tangent_frame(normal) * cosine_direction(numbers_of(p, 0u).xy);
    send(i, at, face, lift, normal, w, to_map(w), albedo);
    if (!has_alias_table()) return;
    vec3 bright = choose_direction(numbers_of(p, 1u));
    send(batch_size() + i, at, face, lift, normal, from_map(bright), bright, albedo);
}

void main() {
    uint i = this_item();
    if (i >= batch_size()) return;
    bounce(pixel_of(i), i, rays[i], hits[i]);
}
