#version 450 core
// lint: RELIGHT BACKGROUND=1 DIFFUSE ALBEDO RADIANCE INDIRECT SPECULAR EMISSION BEAUTY COVERAGE MULTIPLY_ALL DEPTHMASK | RELIGHT BACKGROUND=2 VISIBILITY ALBEDO | RELIGHT BACKGROUND=0 RADIANCE ALBEDO
// The composite that is lit by us: drawn, which a software renderer stores faster.
#include "include/frame.glsl"
#include "include/environment.glsl"
#include "include/composite.glsl"

layout(location = 0) out vec4 composite_out;
#ifdef DIFFUSE
layout(location = 1) out vec4 diffuse_out;
#endif

void main() {
    composite_out = composite(this_pixel());
#ifdef DIFFUSE
    diffuse_out = vec4(diffuse_light, 0.0);
#endif
}
