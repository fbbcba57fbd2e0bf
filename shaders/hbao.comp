#version 450 core
// Horizon-based ambient occlusion (Bavoil, Sainz, Dimitrov 2008). For each direction about the view vector V, walk outwards over the
// recorded surfaces; h is the elevation over the plane across V, t that of the tangent:
//   AO = mean over directions of sum W(S_i) (sin h_i - sin h_prev) over the samples that raise the horizon,
//   h_0 = t + bias, W = 1 - (d / R)^2, samples beyond R ignored;  occlusion = 1 - AO
// Everything beneath the horizon counts as blocked. All directions weigh alike: by solid angle, not by cosine. The paper measures
// elevations about the camera's axis and takes directions uniform on the screen. Here both are about V, so that an empty plane is open
// off the axis too (README, correction 12).
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/recorded.glsl"

#include "params/hbao.glsl"

layout(r32f) writeonly uniform image2D occlusion_image;

// How far the projection of P moves, in pixels, when P moves by R along a direction: the projected radius.
vec2 projected_radius(vec3 P, vec3 along) {
    vec2 d = is_orthographic() ? along.xy : (along.xy * P.z - P.xy * along.z) / (P.z * P.z);
    return params.radius * frame_lens.xy * d;
}

// Point of the recorded surface under a screen position; false if there is none.
bool surface_at(vec2 screen, out vec3 S) {
    ivec2 q = ivec2(floor(screen));
    float depth = depth_at(q);
    S = vec3(0.0);
    if (depth == 0.0) return false;
    float recorded = recorded_depth(q, depth, position_at(screen, depth), screen);
    S = position_at(screen, recorded);
    return recorded < 1e29;
}

float direction_occlusion(vec3 P, vec3 N, vec3 V, vec3 across, vec2 origin, float jitter) {
    vec2 reach = projected_radius(P, across);
    float facing = dot(N, V), leaning = dot(N, across);
    float tangent = atan(-leaning, facing); // elevation of the tangent in the slice
    float horizon = sin(clamp(tangent + params.bias, -0.5 * PI, 0.5 * PI)), sum = 0.0;
    for (int i = 0; i < params.steps; i++) {
        vec3 S;
        if (!surface_at(origin + reach * ((float(i) + jitter) / float(params.steps)), S)) continue;
        vec3 w = S - P;
        float ww = dot(w, w), rr = params.radius * params.radius;
        // A sample that is not above the receiver's own plane (to rounding) is no occluder, whatever the bias.
        if (ww > rr || dot(N, w) <= 2.0 * rounding(S)) continue;
        float elevation = dot(w, V) * inversesqrt(ww);
        if (elevation <= horizon) continue;
        sum += (1.0 - ww / rr) * (elevation - horizon);
        horizon = elevation;
    }
    return sum;
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
    vec2 noise = pixel_hash(uvec2(p) + uint(params.seed) * 7919u);
    float sum = 0.0;
    for (int k = 0; k < params.directions; k++) {
        float phi = 2.0 * PI * (float(k) + noise.x) / float(params.directions);
        vec3 across = cos(phi) * around[0] + sin(phi) * around[1];
        float jitter = 1.0 - fract(noise.y + float(k) * 0.61803399); // in (0, 1]
        sum += direction_occlusion(P, N, V, across, vec2(p) + 0.5, jitter);
    }
    imageStore(occlusion_image, p, vec4(1.0 - sum / float(params.directions)));
}
