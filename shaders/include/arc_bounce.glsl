// Light that the blocked sectors of a slice send to the receiver (README, Slices and sectors), for arc_bounce.comp and arc_light.comp.

PICTURE(rgba32f, sender_image); // at the receiver
layout(rgba32f) writeonly uniform image2D indirect_image;

#if defined(OUTSIDE) && !defined(SURROUND)
PICTURE(rgba32f, outside_image); // first texel: what surfaces outside the frame send
vec3 outside_light = vec3(0.0);

// The share of a slice's sectors that meet a surface outside the frame.
float closed_share(Centre o, Slice s) {
    uvec2 open = ~s.sectors.blocked;
    const float width = PI / float(CELLS);
    Exits exits = exits_of(o.P, o.V, s.lines);
    float from = s.n - 0.5 * PI, c = 0.0, closed = 0.0;
    for (int i = 0; i < CELLS; i++) {
        float next = i + 1 == CELLS ? 1.0 : share_at(s.side, from + float(i + 1) * width);
        uvec2 cell = sectors_between(c, next, s.noise.y) & open;
        vec2 look = look_in(s.side, from + float(i) * width, width, i, s.noise.y);
        closed += sector_share(cell) - open_share(cell, s.sectors.seen, openness(o.V, s.across, look, exits));
        c = next;
    }
    return closed;
}
#endif

// Before a receiver's slices: what is guessed of surfaces that the picture does not show.
void guess_light(Receiver here) {
    guess_of_receiver(FETCH(sender_image, here.pixel).rgb, here.N);
#if defined(OUTSIDE) && !defined(SURROUND)
    outside_light = FETCH(outside_image, ivec2(0)).rgb;
#endif
}

void add_bounce(inout vec3 bounced, Centre o, Slice s) {
    bounced += s.weight * s.sectors.light;
#if defined(OUTSIDE) && !defined(SURROUND)
    bounced += s.weight * closed_share(o, s) * outside_light;
#endif
}
