#version 450 core
// A sample's first rays from every point: one in a cosine-weighted direction, and with LIGHT one chosen by the environment's brightness.
// Rays i and batch + i belong to pixel i. DISTANT: rays go beyond the radius, and the nearest hit is wanted.
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/environment.glsl"
#include "include/trace.glsl"

PICTURE(rgba32f, point_image); // trace_points.comp
PICTURE(rgba32f, face_image);
layout(std430) writeonly buffer Rays { Ray rays[]; };
#ifdef LIGHT
#include "include/alias_table.glsl"
layout(std430) writeonly buffer Gains { vec4 gains[]; };
#endif

void main() {
    uint i = this_item();
    if (i >= batch_size()) return;
    ivec2 p = pixel_of(i);
    vec4 at = FETCH(point_image, p);
    vec3 face = FETCH(face_image, p).xyz, N = normal_at(p);
    vec3 w = tangent_frame(N) * cosine_direction(sequence2() + shift_of(p, 0u).xy);
#ifdef DISTANT
    rays[i] = ray_from(at.xyz, face, at.w, to_mesh(w), RAY_FAR, false);
#else
    rays[i] = ray_from(at.xyz, face, at.w, to_mesh(w), params.radius, true);
#endif
#ifdef LIGHT
    gains[i] = vec4(light_from(to_map(w), dot(N, w)), 0.0);
    if (!has_alias_table()) return;
    vec3 bright = choose_direction(sequence3() + shift_of(p, 1u));
    w = from_map(bright);
    uint j = batch_size() + i;
    vec3 gain = light_from(bright, dot(N, w));
    rays[j] = ray_from(at.xyz, face, at.w, to_mesh(w), gain == vec3(0.0) ? -1.0 : RAY_FAR, true);
    gains[j] = vec4(gain, 0.0);
#endif
}
