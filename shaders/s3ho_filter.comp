#version 450 core
// Joins the 16 sample sets of the 4 x 4 pattern: the result is the mean of the four 4 x 4 windows that hold the pixel. Away from edges
// every set has the same weight. Taps across an edge lose their weight (plane distance and normals, as in blur.comp). The
// coefficients are linear in visibility, so the filter acts on them and not on light.
#include "include/frame.glsl"

PICTURE(rgba32f, sh0_in);
PICTURE(rgba32f, sh1_in);
PICTURE(rgba32f, sh2_in);
layout(rgba32f) writeonly uniform image2D sh0_out;
layout(rgba32f) writeonly uniform image2D sh1_out;
layout(rgba32f) writeonly uniform image2D sh2_out;
#ifdef BANDS3
PICTURE(rgba32f, sh3_in);
PICTURE(rgba32f, sh4_in);
layout(rgba32f) writeonly uniform image2D sh3_out;
layout(rgba32f) writeonly uniform image2D sh4_out;
#endif

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    vec4 c0 = FETCH(sh0_in, p), c1 = FETCH(sh1_in, p), c2 = FETCH(sh2_in, p);
#ifdef BANDS3
    vec4 c3 = FETCH(sh3_in, p), c4 = FETCH(sh4_in, p), s3 = vec4(0.0), s4 = vec4(0.0);
#endif
    float depth = depth_at(p);
    vec3 P = position_of(p, depth), N = normal_at(p);
    float scale = depth == 0.0 ? 0.0 : 1.0 / footprint(depth);
    // Differences from the centre are summed, so that a constant passes unchanged to the bit.
    vec4 s0 = vec4(0.0), s1 = vec4(0.0), s2 = vec4(0.0);
    float total = 1.0;
    for (int y = -2; y <= 2; y++)
        for (int x = -2; x <= 2; x++) {
            ivec2 q = p + ivec2(x, y);
            float tap_depth = depth_at(q);
            if ((x == 0 && y == 0) || tap_depth == 0.0 || depth == 0.0) continue;
            float off_plane = dot(N, position_of(q, tap_depth) - P) * scale;
            float same_way = max(0.0, dot(N, normal_at(q)));
            float window = (abs(x) == 2 ? 0.5 : 1.0) * (abs(y) == 2 ? 0.5 : 1.0);
            float w = window * exp(-0.5 * off_plane * off_plane) * pow(same_way, 8.0);
            s0 += w * (FETCH(sh0_in, q) - c0);
            s1 += w * (FETCH(sh1_in, q) - c1);
            s2 += w * (FETCH(sh2_in, q) - c2);
#ifdef BANDS3
            s3 += w * (FETCH(sh3_in, q) - c3);
            s4 += w * (FETCH(sh4_in, q) - c4);
#endif
            total += w;
        }
    imageStore(sh0_out, p, c0 + s0 / total);
    imageStore(sh1_out, p, c1 + s1 / total);
    imageStore(sh2_out, p, c2 + s2 / total);
#ifdef BANDS3
    imageStore(sh3_out, p, c3 + s3 / total);
    imageStore(sh4_out, p, c4 + s4 / total);
#endif
}
