#version 450 core
// Alchemy obscurance (McGuire et al. 2011): S = (2 pi c / n) sum max(0, N.w - bias) H(R - |w|) / max(c^2, w.w), c = 0.1 R,
// A = max(0, 1 - scale S)^contrast. Taps lie on a spiral over the projected disc, uniform in radius. Neighbours on the spiral are a
// golden section of a turn apart; 7 / 9 of a turn would put all taps on nine spokes. This pass stores 1 - S. tone.comp makes A of it
// after the blur, because filters act on linear quantities (README, correction 9).
#include "include/frame.glsl"
#include "include/sampling.glsl"

#include "params/points.glsl"

layout(r32f) writeonly uniform image2D occlusion_image;

// Obscurance that the surface at pixel q adds at point P with normal N; 0 outside the sphere or below the tangent plane.
float obscurance(vec3 P, vec3 N, float bias, ivec2 q) {
    float depth = depth_at(q);
    if (depth == 0.0) return 0.0;
    float c = 0.1 * params.radius;
    vec3 w = position_of(q, depth) - P;
    float ww = dot(w, w);
    if (ww > params.radius * params.radius) return 0.0;
    return max(0.0, dot(N, w) - bias) / max(c * c, ww);
}

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float depth = depth_at(p);
    if (depth == 0.0) {
        imageStore(occlusion_image, p, vec4(1.0));
        return;
    }
    vec3 P = position_of(p, depth), N = normal_at(p);
    // A length, so relative to the radius and to what rounding and the pixel grid can fake (README, correction 17).
    float bias = 1e-3 * min(params.radius, footprint(depth)) + 4.0 * rounding(P);
    vec2 disc = params.radius * frame_lens.xy / (is_orthographic() ? 1.0 : depth); // R in pixels
    vec2 noise = pixel_hash(uvec2(p) + uint(params.seed) * 7919u);
    float turn = 2.0 * PI * noise.x; // a whole turn, not half of one
    float sum = 0.0;
    for (int i = 0; i < params.samples; i++) {
        float alpha = (float(i) + noise.y) / float(params.samples);
        float theta = 2.0 * PI * 0.61803399 * float(i) + turn;
        vec2 tap = vec2(p) + 0.5 + alpha * disc * vec2(cos(theta), sin(theta));
        sum += obscurance(P, N, bias, ivec2(floor(tap)));
    }
    float S = 2.0 * PI * 0.1 * params.radius / float(params.samples) * sum;
    imageStore(occlusion_image, p, vec4(1.0 - S));
}
