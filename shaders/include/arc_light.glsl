// Light through the open sectors of a slice.

// The slice is divided into CELLS pieces. Each piece looks the environment up once and weighs it by its share of open
// sectors. `all` is the light that arrives with nothing in the way. The mip level covers the share FOOTPRINT of the piece's solid angle.
// A level for the whole piece would bring in light from beyond what blocks it. What the smaller one leaves out beside the slice, the
// slices of neighbouring pixels see. Measured: tests/bench/RESULTS.md, Sampling.
const float FOOTPRINT = 0.125;

struct Light {
    vec3 open;
    float open_luminance, all_luminance;
};

void add_sky(inout Light light, Side s, vec3 V, vec3 across, float n, float weight, Sectors slots, float jitter, Exits exits) {
    const float width = PI / float(CELLS);
    const vec2 half_turn = vec2(cos(0.5 * width), sin(0.5 * width));
    float from = n - 0.5 * PI, c = 0.0, wedge = PI / float(params.slices);
    vec2 edge = vec2(s.sin_n, -s.cos_n); // cosine and sine of `from`
    for (int i = 0; i < CELLS; i++) {
        vec2 middle = turned(edge, half_turn);
        edge = turned(middle, half_turn);
        float next = i + 1 == CELLS ? 1.0 : share_at(s, from + float(i + 1) * width, edge);
        uvec2 cell = sectors(c, next, jitter);
        float share = sector_share(cell), open = sector_share(cell & ~slots.blocked);
#ifdef OUTSIDE
        open = open_share(cell & ~slots.blocked, slots.seen, openness(V, across, look_in(s, from + float(i) * width, width, i, jitter), exits));
#endif
        vec3 direction = to_map(middle.x * V + middle.y * across);
        float solid_angle = FOOTPRINT * wedge * max(abs(middle.y) * width, 0.25 * width * width);
        vec3 L = radiance_from(direction, params.level < 0.0 ? map_level(direction, solid_angle) : params.level);
        light.open += weight * open * L;
        light.open_luminance += weight * open * dot(L, LUMINANCE);
        light.all_luminance += weight * share * dot(L, LUMINANCE);
        c = next;
    }
}
