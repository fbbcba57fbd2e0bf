#version 450 core
// The square root of a picture.
#include "include/frame.glsl"
PICTURE(r32f, square_image);
TARGET(0, float, r32f, root_out);

void root(ivec2 p) { PUT(root_out, p, sqrt(max(0.0, FETCH(square_image, p).r))); }

DRAWN_OR_DISPATCHED(root)
