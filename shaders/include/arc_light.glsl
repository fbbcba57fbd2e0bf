// Light through the open sectors of a slice.

// The slice in CELLS pieces of equal angle; each looks the environment up once and weighs it by its share of open sectors. `all` is
// what arrives with nothing in the way. The level is that of a FOOTPRINT of the piece's solid angle: what lies beside the slice comes
// in by the turn of the slices from pixel to pixel, and a level that covers the whole piece brings light from beyond what blocks it.
// (Error over five samples and their unseen variants at 64 samples: 24 pieces looked up whole .102 and .100, by this eighth .097 and
// .095; 24, 12 and 6 pieces at that footprint differ by .0005.)
const int CELLS = 8;
const float FOOTPRINT = 0.125;

struct Light {
    vec3 open;
    float open_luminance, all_luminance;
};

void add_sky(inout Light light, Side s, vec3 V, vec3 across, float n, float weight, uvec2 blocked, float jitter) {
    const float width = PI / float(CELLS);
    const vec2 half_turn = vec2(cos(0.5 * width), sin(0.5 * width));
    float from = n - 0.5 * PI, c = 0.0, wedge = PI / float(params.slices);
    vec2 edge = vec2(s.sin_n, -s.cos_n); // cosine and sine of `from`
    for (int i = 0; i < CELLS; i++) {
        vec2 middle = turned(edge, half_turn);
        edge = turned(middle, half_turn);
        float next = i + 1 == CELLS ? 1.0 : share_at(s, from + float(i + 1) * width, edge);
        uvec2 cell = sectors(c, next, jitter);
        float share = sector_share(cell), open = sector_share(cell & ~blocked);
        vec3 direction = to_map(middle.x * V + middle.y * across);
        float solid_angle = FOOTPRINT * wedge * max(abs(middle.y) * width, 0.25 * width * width);
        vec3 L = radiance_from(direction, params.level < 0.0 ? map_level(direction, solid_angle) : params.level);
        light.open += weight * open * L;
        light.open_luminance += weight * open * dot(L, LUMINANCE);
        light.all_luminance += weight * share * dot(L, LUMINANCE);
        c = next;
    }
}
