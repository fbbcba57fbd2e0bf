#version 450 core
// Scale and contrast (McGuire et al. 2011) on a filtered scalar: A = max(0, 1 - scale S)^contrast, S the blocked share or the obscurance. They come
// after the filter, which acts on linear quantities (README, correction 9). Scale and contrast 1 only bound the value.
#include "include/frame.glsl"

#include "params/tone.glsl"
layout(r32f) uniform image2D scalar_image;

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float S = 1.0 - LOAD(scalar_image, p).r;
    float a = clamp(1.0 - params.scale * S, 0.0, 1.0);
    imageStore(scalar_image, p, vec4(params.contrast == 1.0 || a == 0.0 ? a : pow(a, params.contrast)));
}
