// What a filter carries of a pixel: SCALARS numbers (up to 2) and COLOURS colours (up to 2) of the type COLOUR, vec3 or vec4.
//
// A filter sums differences from one of its pixels, not the values, so that a constant passes unchanged to the bit:
//   result = from + sum w (value - from) / sum w
// value_images.glsl reads and writes them.

struct Values {
#if SCALARS > 0
    float scalar0;
#endif
#if SCALARS > 1
    float scalar1;
#endif
#if COLOURS > 0
    COLOUR colour0;
#endif
#if COLOURS > 1
    COLOUR colour1;
#endif
};

// Every scalar, every colour the same.
Values values_of(float scalar, COLOUR colour) {
    Values v;
#if SCALARS > 0
    v.scalar0 = scalar;
#endif
#if SCALARS > 1
    v.scalar1 = scalar;
#endif
#if COLOURS > 0
    v.colour0 = colour;
#endif
#if COLOURS > 1
    v.colour1 = colour;
#endif
    return v;
}

// sum + w (v - from)
Values add(Values sum, float w, Values v, Values from) {
#if SCALARS > 0
    sum.scalar0 += w * (v.scalar0 - from.scalar0);
#endif
#if SCALARS > 1
    sum.scalar1 += w * (v.scalar1 - from.scalar1);
#endif
#if COLOURS > 0
    sum.colour0 += w * (v.colour0 - from.colour0);
#endif
#if COLOURS > 1
    sum.colour1 += w * (v.colour1 - from.colour1);
#endif
    return sum;
}

// from + sum / total
Values mean_of(Values from, Values sum, float total) {
#if SCALARS > 0
    from.scalar0 += sum.scalar0 / total;
#endif
#if SCALARS > 1
    from.scalar1 += sum.scalar1 / total;
#endif
#if COLOURS > 0
    from.colour0 += sum.colour0 / total;
#endif
#if COLOURS > 1
    from.colour1 += sum.colour1 / total;
#endif
    return from;
}

#ifdef FITTED
// What values lie between.
struct Range { Values least, most; };

Range reach(Range r, Values v) {
#if SCALARS > 0
    r.least.scalar0 = min(r.least.scalar0, v.scalar0), r.most.scalar0 = max(r.most.scalar0, v.scalar0);
#endif
#if COLOURS > 0
    r.least.colour0 = min(r.least.colour0, v.colour0), r.most.colour0 = max(r.most.colour0, v.colour0);
#endif
#if COLOURS > 1
    r.least.colour1 = min(r.least.colour1, v.colour1), r.most.colour1 = max(r.most.colour1, v.colour1);
#endif
    return r;
}

Values within(Range r, Values v) {
#if SCALARS > 0
    v.scalar0 = clamp(v.scalar0, r.least.scalar0, r.most.scalar0);
#endif
#if COLOURS > 0
    v.colour0 = clamp(v.colour0, r.least.colour0, r.most.colour0);
#endif
#if COLOURS > 1
    v.colour1 = clamp(v.colour1, r.least.colour1, r.most.colour1);
#endif
    return v;
}
#endif
