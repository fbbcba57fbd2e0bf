// 64 sectors of equal weight of one slice, each tested at one direction: sector k at share (k + jitter) / 64. The jitter is drawn per
// slice, so that a mask's expected weight is exact; and any single direction can be tested exactly by choosing the jitter.
// With BOUNCE a sector also takes the light of what blocks it first.

#ifdef SUNS
// They may also divide a part of the slice.
vec2 window = vec2(0.0, 64.0); // its first share, and sectors per share
void divide_into_sectors(float low, float high) { window = vec2(low, 64.0 / max(high - low, 1e-6)); }
float place(float c) { return (c - window.x) * window.y; }
#else
float place(float c) { return c * 64.0; }
#endif

struct Sectors {
    uvec2 blocked;
#ifdef BOUNCE
    vec3 light;
#endif
#ifdef OUTSIDE
    uvec2 seen; // their directions pass through an opening behind which the picture shows nothing (outside.glsl)
#endif
#ifdef EVIDENCE
    uvec2 met, unseen; // their directions meet a recorded surface; pass, within the radius, where the picture does not show (evidence.glsl)
#endif
};

Sectors all_open() {
    Sectors s;
    s.blocked = uvec2(0u);
#ifdef BOUNCE
    s.light = vec3(0.0);
#endif
#ifdef OUTSIDE
    s.seen = uvec2(0u);
#endif
#ifdef EVIDENCE
    s.met = s.unseen = uvec2(0u);
#endif
    return s;
}

// The same sectors, counted from the other end of the slice.
Sectors counted_from_the_other_end(Sectors s) {
    s.blocked = bitfieldReverse(s.blocked.yx);
#ifdef OUTSIDE
    s.seen = bitfieldReverse(s.seen.yx);
#endif
#ifdef EVIDENCE
    s.met = bitfieldReverse(s.met.yx);
    s.unseen = bitfieldReverse(s.unseen.yx);
#endif
    return s;
}

uvec2 sectors_below(int k) {
    uint low = k >= 32 ? ~0u : ~(~0u << uint(max(k, 0)));
    uint high = k >= 64 ? ~0u : k <= 32 ? 0u : ~(~0u << uint(k - 32));
    return uvec2(low, high);
}
// Sectors whose direction lies in [from, to).
uvec2 sectors_between(float from, float to, float jitter) {
    int a = int(ceil(place(from) - jitter)), b = int(ceil(place(to) - jitter));
    return sectors_below(b) & ~sectors_below(a);
}
float sector_share(uvec2 mask) { return float(bitCount(mask.x) + bitCount(mask.y)) * (1.0 / 64.0); }

// Blocks sectors; those that were open take the light.
void block(inout Sectors s, uvec2 mask, vec3 light) {
#ifdef BOUNCE
    s.light += sector_share(mask & ~s.blocked) * light;
#endif
    s.blocked |= mask;
}
