#version 450 core
// lint: SPLIT BEAUTY ALBEDO RADIANCE | BEAUTY ALBEDO INDIRECT COVERAGE
// The composite of a beauty, which must come through to the bit where nothing is done to it: dispatched, for drawing may flush
// denormals.
#include "include/frame.glsl"
#include "include/environment.glsl"
#include "include/composite.glsl"

layout(rgba32f, binding = 3) writeonly uniform image2D composite_image;

void main() {
    ivec2 p = this_pixel();
    if (in_tile(p)) imageStore(composite_image, p, composite(p));
}
