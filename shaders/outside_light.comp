#version 450 core
// What surfaces outside the frame are taken to send, in the first texel: the mean of light x albedo over the surfaces of the frame, on a
// fixed grid; in the second the mean albedo. One work group; each invocation sums some rows, and the first adds them up, so the order of the sum is fixed.
#include "include/frame.glsl"
#include "include/arc_params.glsl"

layout(rgba32f) writeonly uniform image2D outside_image;
PICTURE(rgba32f, sender_image);
PICTURE(rgba32f, albedo_image);

const int GRID = 64, ROWS = GROUP_SIDE * GROUP_SIDE;
shared vec4 sums[ROWS], albedos[ROWS];

void main() {
    int row = int(gl_LocalInvocationIndex);
    vec4 sum = vec4(0.0), albedo = vec4(0.0);
    for (int y = row; y < GRID; y += ROWS)
        for (int x = 0; x < GRID; x++) {
            ivec2 q = (ivec2(x, y) * 2 + 1) * frame_size / (2 * GRID);
            if (depth_at(q) == 0.0) continue;
            vec3 L = FETCH(sender_image, q).rgb, a = FETCH(albedo_image, q).rgb;
            sum += vec4(params.exitant == 1 ? L : L * a, 1.0);
            albedo += vec4(a, 1.0);
        }
    sums[row] = sum;
    albedos[row] = albedo;
    barrier();
    if (row > 0) return;
    for (int i = 1; i < ROWS; i++) {
        sum += sums[i];
        albedo += albedos[i];
    }
    imageStore(outside_image, ivec2(0), sum / max(sum.a, 1.0));
    imageStore(outside_image, ivec2(1, 0), albedo / max(albedo.a, 1.0));
}
