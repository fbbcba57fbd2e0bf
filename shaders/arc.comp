#version 450 core
// lint: HORIZON | BITMASK | RUNS | RUNS PLANES
// Occlusion in slices around the view vector, each a set of 64 sectors of equal cosine weight (THEORY.md 2 and 3).
//   occlusion = sum over slices of |n_p| (cos n + n sin n) (open share) / sum of |n_p| (cos n + n sin n)
// so that an empty plane is exactly 1. HORIZON and BITMASK are the older methods in the same frame; RUNS is `arc`.
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/arc_params.glsl"
#include "include/arc_slice.glsl"
#include "include/arc_line.glsl"
#ifdef RUNS
#include "include/arc_march.glsl"
#else
#include "include/arc_taps.glsl"
#endif
#ifdef PLANES
#include "include/arc_planes.glsl"
#endif

layout(r32f, binding = 2) writeonly uniform image2D occlusion_image;

// One side of a slice; n is the angle of the projected normal towards this side.
Side side_of(vec3 V, vec3 outwards, vec3 N, float n, float inverse_length, float eye_distance) {
    Side s;
    s.cos_n = cos(n);
    s.sin_n = sin(n);
    s.tangent = s.cos_n * outwards - s.sin_n * V;
    s.normal = N * inverse_length;
    s.below = 0.5 * (s.cos_n + (n - 0.5 * PI) * s.sin_n);
    s.scale = 1.0 / (s.cos_n + n * s.sin_n);
    s.eye = vec2(-s.sin_n, s.cos_n) * (is_orthographic() ? 1.0 : eye_distance);
    return s;
}

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float depth = depth_at(p);
    if (depth == 0.0) {
        imageStore(occlusion_image, p, vec4(1.0));
        return;
    }
    vec3 P = position_of(p, depth), N = normal_at(p), V = view_of(P);
    mat3 around = tangent_frame(V);
    vec2 origin = vec2(p) + 0.5;
    float eye_distance = length(P);
    vec2 turn = pixel_hash(uvec2(p) + uint(params.seed) * 7919u);
    float open = 0.0, all = 0.0;
    for (int i = 0; i < params.slices; i++) {
        float phi = PI * (float(i) + turn.x) / float(params.slices);
        vec2 noise = pixel_hash(uvec2(p) + uvec2(uint(params.seed) * 7919u + 131u * uint(i + 1), 17u));
        vec3 across = cos(phi) * around[0] + sin(phi) * around[1];
        float up = dot(N, V), sideways = dot(N, across), squared = max(up * up + sideways * sideways, 1e-12);
        float inverse_length = inversesqrt(squared), n = atan(sideways, up);
        Side right = side_of(V, across, N, n, inverse_length, eye_distance), left = side_of(V, -across, N, -n, inverse_length, eye_distance);
        Line line = line_of(P, V, across, origin), back = line_of(P, V, -across, origin);
        uvec2 blocked = march(right, line, P, N, noise.x, noise.y) | mirrored(march(left, back, P, N, 1.0 - noise.x, 1.0 - noise.y));
#ifdef PLANES
        blocked |= behind_planes(right, V, across, n, line, back, P, noise.y);
#endif
        float weight = sqrt(squared) * (cos(n) + n * sin(n));
        open += weight * (1.0 - sector_share(blocked));
        all += weight;
    }
    imageStore(occlusion_image, p, vec4(open / all));
}
