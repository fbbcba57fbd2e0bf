#version 450 core
// Normal-oriented hemisphere (after Filion and McNaughton 2008; kernel and range check are those of Chapman's SSAO tutorial, 2013). N
// points lie inside the hemisphere over the normal. A point is occluded if the recorded surface is nearer to the camera than the point
// (README, correction 6). It counts only if that surface's depth is within R of the receiver's (range check).
//   point i = P + R u_i lerp(0.1, 1, t_i^2) d_i,   t_i = (i + 0.5) / N, u_i uniform in 0..1
//   d_i     = a point uniform in the half cube [-1, 1]^2 x [0, 1] of the tangent frame, normalised
//   occlusion = 1 - occluded / N
// Every point counts alike. So directions are not weighted by cosine, and because a cube has corners not quite by solid angle.
// The tutorial turns its whole kernel about the normal by one random vector. Here each point has an angle of its own.
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/recorded.glsl"

#include "params/points.glsl"

layout(r32f) writeonly uniform image2D occlusion_image;

// Sample i of the kernel, in units of R, in the tangent frame. The four numbers are an additive recurrence (the roots of
// x^5 = x + 1) shifted per pixel; the fifth is the index itself.
vec3 kernel(int i, vec4 shift) {
    vec4 u = fract(float(i) * vec4(0.85667488, 0.73389185, 0.62870672, 0.53859725) + shift);
    vec3 d = normalize(vec3(2.0 * u.xy - 1.0, max(u.z, 1e-6)));
    float t = (float(i) + 0.5) / float(params.samples);
    float theta = 2.0 * PI * fract(float(i) * 0.61803399 + shift.x + shift.w), c = cos(theta), s = sin(theta);
    return u.w * mix(0.1, 1.0, t * t) * vec3(c * d.x - s * d.y, s * d.x + c * d.y, d.z);
}

bool occluded(vec3 P, vec3 point) {
    Recorded r = recorded_at(point);
    return behind_recorded(r, point) > 0.0 && abs(P.z - r.depth) < params.radius;
}

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float depth = depth_at(p);
    if (depth == 0.0) {
        imageStore(occlusion_image, p, vec4(1.0));
        return;
    }
    vec3 P = position_of(p, depth);
    mat3 tangents = tangent_frame(normal_at(p));
    uvec2 key = uvec2(p) + uint(params.seed) * 7919u;
    vec4 shift = vec4(pixel_hash(key), pixel_hash(key + 0x9e3779b9u));
    int count = 0;
    for (int i = 0; i < params.samples; i++)
        if (occluded(P, P + params.radius * (tangents * kernel(i, shift)))) count++;
    imageStore(occlusion_image, p, vec4(1.0 - float(count) / float(params.samples)));
}
