// Light through the open sectors of a slice, and from the suns.

// The slice in CELLS pieces of equal angle; each looks the environment up once, at a level of its own solid angle, and weighs it by
// its share of open sectors. `all` is what arrives with nothing in the way.
const int CELLS = 24;
const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);

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
        float solid_angle = wedge * max(abs(middle.y) * width, 0.25 * width * width);
        vec3 L = radiance_from(direction, params.level < 0.0 ? map_level(direction, solid_angle) : params.level);
        light.open += weight * open * L;
        light.open_luminance += weight * open * dot(L, LUMINANCE);
        light.all_luminance += weight * share * dot(L, LUMINANCE);
        c = next;
    }
}

// Every sun gets a slice side of its own, whose sector 0 .. 63 that holds the sun's direction is tested exactly there.
void add_suns(inout Light light, vec3 P, vec3 N, vec3 V, float eye_distance, vec2 origin, float step_jitter) {
    for (int i = 0; i < params.suns; i++) {
        vec3 S = stored.sun_direction[i].xyz;
        float cosine = dot(N, S), along = dot(S, V);
        vec3 aside = S - along * V;
        float sine = length(aside);
        vec3 across = sine > 1e-4 ? aside / sine : tangent_frame(V)[0];
        float n, weight;
        Side s = side_of(V, across, N, eye_distance, n, weight);
        float place = min(share_at(s, atan(sine, along)), 0.9999) * 64.0, jitter = fract(place);
        Lines lines = lines_of(V, across, origin, -1.0);
        Sectors slots = all_open();
        march(slots, s, lines.right, P, N, step_jitter, jitter);
#ifdef PLANES
        block_by_planes(slots, s, V, across, n, lines, P, step_jitter, jitter);
#endif
        int k = int(place);
        uint word = k < 32 ? slots.blocked.x : slots.blocked.y;
        float visible = ((word >> uint(k & 31)) & 1u) == 0u ? 1.0 : 0.0;
        vec3 L = max(cosine, 0.0) * stored.sun_light[i].rgb;
        light.open += visible * L;
        light.open_luminance += visible * dot(L, LUMINANCE);
        light.all_luminance += dot(L, LUMINANCE);
    }
}
