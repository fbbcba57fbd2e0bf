#version 450 core
// Sum of the squared errors of a tile's surfaces, and their number. One work group a tile. The order of the sum is fixed, so that
// sampling stops after the same number of samples on every run.
#include "include/frame.glsl"

#include "params/tile_error.glsl"

PICTURE(r32f, error_image); // squares
layout(std430) writeonly buffer Tiles { vec2 tiles[]; };

shared vec2 parts[64];

void main() {
    ivec2 corner = ivec2(gl_WorkGroupID.xy) * params.size, here = ivec2(gl_LocalInvocationID.xy);
    vec2 sum = vec2(0.0);
    for (int y = here.y; y < params.size; y += 8)
        for (int x = here.x; x < params.size; x += 8) {
            ivec2 p = corner + ivec2(x, y);
            if (depth_at(p) != 0.0) sum += vec2(FETCH(error_image, p).r, 1.0);
        }
    parts[gl_LocalInvocationIndex] = sum;
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;
    for (int i = 1; i < 64; i++) sum += parts[i];
    tiles[int(gl_WorkGroupID.y) * params.columns + int(gl_WorkGroupID.x)] = sum;
}
