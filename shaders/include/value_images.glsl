// The pictures that hold a filter's values (values.glsl), r32f and rgba32f.

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
#if COLOURS > 1
PICTURE(rgba32f, colour1_in);
TARGET(3, vec4, rgba32f, colour1_out);
#endif

Values load(ivec2 p) {
    Values v;
#if SCALARS > 0
    v.scalar0 = FETCH(scalar0_in, p).r;
#endif
#if SCALARS > 1
    v.scalar1 = FETCH(scalar1_in, p).r;
#endif
#if COLOURS > 0
    v.colour0 = COLOUR(FETCH(colour0_in, p));
#endif
#if COLOURS > 1
    v.colour1 = COLOUR(FETCH(colour1_in, p));
#endif
    return v;
}

vec4 texel_of(vec3 colour) { return vec4(colour, 0.0); }
vec4 texel_of(vec4 colour) { return colour; }

void store(ivec2 p, Values v) {
#if SCALARS > 0
    PUT(scalar0_out, p, v.scalar0);
#endif
#if SCALARS > 1
    PUT(scalar1_out, p, v.scalar1);
#endif
#if COLOURS > 0
    PUT(colour0_out, p, texel_of(v.colour0));
#endif
#if COLOURS > 1
    PUT(colour1_out, p, texel_of(v.colour1));
#endif
}
