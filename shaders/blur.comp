#version 450 core
// One direction of a separable bilateral filter (include/bilateral.glsl) on linear quantities; weights are always divided out.
// SCALARS and COLOURS say how many r32f and rgba32f images go through together.
#include "include/frame.glsl"
#include "include/bilateral.glsl"

#include "params/blur.glsl"

#if SCALARS > 0
PICTURE(r32f, scalar0_in);
TARGET(0, float, r32f, scalar0_out);
#endif
#if SCALARS > 1
PICTURE(r32f, scalar1_in);
TARGET(1, float, r32f, scalar1_out);
#endif
#if COLOURS > 0
PICTURE(rgba32f, colour0_in);
TARGET(2, vec4, rgba32f, colour0_out);
#endif

struct Values { float scalar0, scalar1; vec3 colour0; };

Values load(ivec2 p) {
    Values v = Values(0.0, 0.0, vec3(0.0));
#if SCALARS > 0
    v.scalar0 = FETCH(scalar0_in, p).r;
#endif
#if SCALARS > 1
    v.scalar1 = FETCH(scalar1_in, p).r;
#endif
#if COLOURS > 0
    v.colour0 = FETCH(colour0_in, p).rgb;
#endif
    return v;
}

void store(ivec2 p, Values v) {
#if SCALARS > 0
    PUT(scalar0_out, p, v.scalar0);
#endif
#if SCALARS > 1
    PUT(scalar1_out, p, v.scalar1);
#endif
#if COLOURS > 0
    PUT(colour0_out, p, vec4(v.colour0, 0.0));
#endif
}

void blur(ivec2 p) {
    Values centre = load(p);
    float depth = depth_at(p);
    if (depth == 0.0) {
        store(p, centre);
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
    store(p, Values(centre.scalar0 + sum.scalar0 / total, centre.scalar1 + sum.scalar1 / total, centre.colour0 + sum.colour0 / total));
}

DRAWN_OR_DISPATCHED(blur)
