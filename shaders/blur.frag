#version 450 core
// lint: SCALARS=2 COLOURS=1 | SCALARS=1 COLOURS=0 | SCALARS=0 COLOURS=1
// One direction of a separable bilateral filter (include/bilateral.glsl) on linear quantities; weights are always divided out.
// SCALARS and COLOURS say how many r32f and rgba32f images go through together.
#include "include/frame.glsl"
#include "include/bilateral.glsl"

layout(std140, binding = 1) uniform Params {
    ivec2 step; // (1,0) or (0,1)
    int radius; // pixels
    float sharpness; // plane distance, in footprints, at which the weight has fallen to exp(-1/2)
} params;

#if SCALARS > 0
layout(r32f, binding = 2) readonly uniform image2D scalar0_in;
layout(location = 0) out float scalar0_out;
#endif
#if SCALARS > 1
layout(r32f, binding = 4) readonly uniform image2D scalar1_in;
layout(location = 1) out float scalar1_out;
#endif
#if COLOURS > 0
layout(rgba32f, binding = 6) readonly uniform image2D colour0_in;
layout(location = 2) out vec4 colour0_out;
#endif

struct Values { float scalar0, scalar1; vec3 colour0; };

Values load(ivec2 p) {
    Values v = Values(0.0, 0.0, vec3(0.0));
#if SCALARS > 0
    v.scalar0 = imageLoad(scalar0_in, p).r;
#endif
#if SCALARS > 1
    v.scalar1 = imageLoad(scalar1_in, p).r;
#endif
#if COLOURS > 0
    v.colour0 = imageLoad(colour0_in, p).rgb;
#endif
    return v;
}

void store(Values v) {
#if SCALARS > 0
    scalar0_out = v.scalar0;
#endif
#if SCALARS > 1
    scalar1_out = v.scalar1;
#endif
#if COLOURS > 0
    colour0_out = vec4(v.colour0, 0.0);
#endif
}

void main() {
    ivec2 p = this_pixel();
    Values centre = load(p);
    float depth = depth_at(p);
    if (depth == 0.0) {
        store(centre);
        return;
    }
    Centre c = centre_at(p, depth, params.sharpness, params.radius);
    // Differences from the centre are summed, so that a constant passes unchanged to the bit.
    Values sum = Values(0.0, 0.0, vec3(0.0));
    float total = 1.0;
    for (int i = -params.radius; i <= params.radius; i++) {
        ivec2 q = p + i * params.step;
        if (i == 0) continue;
        float w = tap_weight(c, q, float(i));
        if (w == 0.0) continue;
        Values v = load(q);
        sum.scalar0 += w * (v.scalar0 - centre.scalar0);
        sum.scalar1 += w * (v.scalar1 - centre.scalar1);
        sum.colour0 += w * (v.colour0 - centre.colour0);
        total += w;
    }
    store(Values(centre.scalar0 + sum.scalar0 / total, centre.scalar1 + sum.scalar1 / total, centre.colour0 + sum.colour0 / total));
}
