#version 450 core
// What each plane sends to the surfaces it faces: the mean of light x albedo over its own pixels, on a fixed grid over the frame. One
// work group; each invocation sums one plane, so the order of the sum is fixed.
#include "include/frame.glsl"
#include "include/arc_params.glsl"

layout(rgba32f) uniform image2D planes_image;
PICTURE(rgba32f, sender_image);
PICTURE(rgba32f, albedo_image);

const int GRID = 48;

vec3 sent_by(ivec2 q) {
    vec3 L = FETCH(sender_image, q).rgb;
    return params.exitant == 1 ? L : L * FETCH(albedo_image, q).rgb;
}

void main() {
    int i = int(gl_LocalInvocationIndex);
    if (i >= params.planes) return;
    vec4 equation = LOAD(planes_image, ivec2(PLANE_EQUATION, i));
    float margin = LOAD(planes_image, ivec2(PLANE_LIGHT, i)).w;
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (int k = 0; k < GRID * GRID; k++) {
        ivec2 q = (ivec2(k % GRID, k / GRID) * 2 + 1) * frame_size / (2 * GRID);
        float depth = depth_at(q);
        if (depth == 0.0) continue;
        float off = abs(dot(equation.xyz, position_of(q, depth)) - equation.w);
        float least = margin < 0.0 ? 0.8 : 0.99;
        if (off > abs(margin) * (is_orthographic() ? 1.0 : depth) || dot(equation.xyz, normal_at(q)) < least) continue;
        sum += sent_by(q);
        count += 1.0;
    }
    imageStore(planes_image, ivec2(PLANE_LIGHT, i), vec4(count > 0.0 ? sum / count : vec3(0.0), margin));
}
