#version 450 core
// The square root of a picture.
#include "include/frame.glsl"
layout(r32f, binding = 2) readonly uniform image2D square_image;
layout(location = 0) out float root_out;

void main() { root_out = sqrt(max(0.0, imageLoad(square_image, this_pixel()).r)); }
