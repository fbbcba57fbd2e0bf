// Where a slice's open directions lead once they have left the frame, by what further G-buffers show (include/surround.glsl): one ray for
// each cell that has any, for light and bounce alike.
#if defined(BOUNCE) && defined(EXITANT)
PICTURE(rgba32f, outside_image); // first texel: what the frame's surfaces send, in the mean
#endif

struct Outlook {
    float open[CELLS]; // how open the cell's directions outside are
    vec3 sent;         // by what closes them, weighed by its share of the slice
};

Outlook look_outside(Centre o, Slice s) {
    const float width = PI / float(CELLS);
    Exits exits = exits_of(o.P, o.V, s.lines);
    Outlook l;
    l.sent = vec3(0.0);
    float from = s.n - 0.5 * PI, c = 0.0;
    uint cells = 0u;
    for (int i = 0; i < CELLS; i++) {
        float next = cell_end(s.side, s.n, i);
        uvec2 open = sectors_between(c, next, s.noise.y) & ~s.sectors.blocked & ~s.sectors.seen;
        cells |= (open.x | open.y) != 0u ? 1u << uint(i) : 0u;
        l.open[i] = 1.0;
        c = next;
    }
    for (; cells != 0u; cells &= cells - 1u) { // a rasteriser on the CPU saves turns of a loop, not branches
        int i = findLSB(cells);
        uvec2 cell = sectors_between(cell_end(s.side, s.n, i - 1), cell_end(s.side, s.n, i), s.noise.y) & ~s.sectors.blocked;
        vec2 look = look_in(s.side, from + float(i) * width, width, i, s.noise.y);
        ivec2 met;
        float open = openness(o.V, s.across, look, exits, met);
        l.open[i] = open;
#ifdef BOUNCE
        vec3 mean = FETCH(outside_image, ivec2(0)).rgb;
#ifndef EXITANT
        mean = met.x >= 0 ? sent_from(met, mean) : mean;
#endif
        l.sent += (sector_share(cell) - open_share(cell, s.sectors.seen, open)) * mean;
#endif
    }
    return l;
}
