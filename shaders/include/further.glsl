// What further G-buffers say of directions within the radius that the picture leaves undecided (README, Evidence). A ray is followed from the
// receiver through every further view. Where a view sees it pass a recorded surface, it is blocked; where the picture and the views
// together see all of it, it is open. It is followed from where the picture loses sight of it, so what stood before in another frame does not
// count.

// The views, one below the other: depth (0 nothing known, below 0 no surface) and normal, in the view's own camera space.
PICTURE(rgba32f, further_image);

const int PLACES = 8;      // of a ray, at which it is looked for
const int TRIES = 3;      // views that it is followed through
const int BISECTIONS = 4;  // where it passes a surface
const float OFF_RECEIVER = 3.0; // pixels' sizes
const int FULL = (1 << PLACES) - 1;

struct Look {
    bool known, free; // the view shows this place; nothing stands between it and the view's eye
    bool surface;
    vec3 recorded, normal; // of the surface there, in the view's camera space
    float pixel;           // its size there
    vec2 screen;
};

vec3 in_view(int view, vec3 X) {
    vec4 rows[3] = vec4[3](arc_block.further_rows[3 * view], arc_block.further_rows[3 * view + 1], arc_block.further_rows[3 * view + 2]);
    return vec3(dot(rows[0], vec4(X, 1.0)), dot(rows[1], vec4(X, 1.0)), dot(rows[2], vec4(X, 1.0)));
}

Look look_at(int view, vec3 X) {
    vec4 lens = arc_block.further_lens[view], size = arc_block.further_size[view];
    vec3 place = in_view(view, X);
    Look l;
    l.screen = place.xy / max(place.z, 1e-30) * lens.xy + lens.zw;
    bool inside = place.z > 0.0 && all(greaterThanEqual(l.screen, vec2(0.0))) && all(lessThan(l.screen, size.xy));
    ivec2 q = ivec2(inside ? l.screen : vec2(0.0));
    vec4 texel = FETCH(further_image, q + ivec2(size.zw));
    vec3 centre = vec3((vec2(q) + 0.5 - lens.zw) / lens.xy, 1.0);
    vec3 ray = place / max(place.z, 1e-30);
    float ratio = dot(texel.yzw, centre) / dot(texel.yzw, ray); // the surface goes on along its tangent plane
    ratio = ratio > 0.5 && ratio < 2.0 ? ratio : 1.0;
    l.known = inside && texel.x != 0.0;
    l.surface = l.known && texel.x > 0.0;
    l.pixel = texel.x / min(lens.x, lens.y);
    l.free = l.known && (texel.x < 0.0 || place.z <= texel.x * ratio + 0.5 * l.pixel);
    l.recorded = centre * texel.x;
    l.normal = texel.yzw;
    return l;
}

// Whether the picture itself shows a place, with nothing in front.
bool frame_sees(vec3 X) {
    vec2 screen = screen_of(X);
    bool inside = X.z > 0.0 && all(greaterThanEqual(screen, vec2(0.0))) && all(lessThan(screen, vec2(frame_size)));
    ivec2 q = ivec2(inside ? screen : vec2(0.0));
    uvec4 texel = FETCH(surface_image, q);
    float depth = uintBitsToFloat(texel.x);
    vec3 n = unpack_normal(texel.y);
    float ratio = dot(n, ray_at(vec2(q) + 0.5)) / dot(n, ray_at(screen));
    ratio = ratio > 0.5 && ratio < 2.0 ? ratio : 1.0;
    return inside && (depth == 0.0 || X.z <= depth * ratio + 0.5 * footprint(depth));
}

const float OPEN_THERE = 1.0, BLOCKED_THERE = 0.0, PERHAPS_BLOCKED = 0.5, UNKNOWN = -1.0;

// Between two places of the ray the view loses sight of it: whether it passes a surface there, or perhaps the unseen part of one, as deep as
// a run is taken to be, or goes on behind an edge.
float passes_surface(int view, vec3 P, vec3 direction, float from, float to) {
    for (int i = 0; i < BISECTIONS; i++) {
        float middle = 0.5 * (from + to);
        bool free = look_at(view, P + middle * direction).free;
        from = free ? middle : from;
        to = free ? to : middle;
    }
    vec3 X = P + to * direction;
    Look l = look_at(view, X);
    vec3 off = in_view(view, X) - l.recorded;
    float span = to - from + 0.5 * l.pixel, facing = max(abs(dot(l.normal, normalize(l.recorded))), 0.05);
    if (!l.surface) return UNKNOWN;
    if (abs(dot(l.normal, off)) <= span && length(off) * facing <= 2.0 * span) return BLOCKED_THERE;
    return length(off) <= params.thickness + span ? PERHAPS_BLOCKED : UNKNOWN;
}

// From a few pixels off the receiver's own surface to the radius.
float place_on_ray(int i, float start, float jitter) {
    float u = i + 1 < PLACES ? (float(i) + jitter) / float(PLACES - 1) : 1.0;
    return start + max(params.radius - start, 0.0) * u * u;
}

// Follows a ray from the last place before one that nobody has seen, through a view that sees either of the two; then from there through
// another, and so on.
float openness_within(vec3 P, vec3 direction, uint views, float jitter) {
    int seen = 0;
    float start = OFF_RECEIVER * footprint(P.z), result = UNKNOWN, perhaps = UNKNOWN;
    for (int i = 0; i < PLACES; i++) seen |= frame_sees(P + place_on_ray(i, start, jitter) * direction) ? 1 << i : 0;
    uint left = seen == FULL ? 0u : views;
    for (int tries = 0; left != 0u && tries < TRIES; tries++) {
        int unseen = findLSB(~seen), first = max(unseen - 1, 0), view = -1;
        vec3 X = P + place_on_ray(first, start, jitter) * direction, Y = P + place_on_ray(unseen, start, jitter) * direction;
        for (uint rest = left; rest != 0u && view < 0; rest &= rest - 1u) {
            int i = findLSB(rest);
            view = look_at(i, X).free || look_at(i, Y).free ? i : -1;
        }
        float before = 0.0, at = 0.0;
        bool free = false, passes = false;
        for (int i = first; view >= 0 && !passes && i < PLACES; i++) {
            before = at;
            at = place_on_ray(i, start, jitter);
            Look l = look_at(view, P + at * direction);
            seen |= l.free ? 1 << i : 0;
            passes = free && !l.free && l.known;
            free = l.free;
        }
        if (passes) {
            result = passes_surface(view, P, direction, before, at);
            perhaps = max(perhaps, result);
            result = result == PERHAPS_BLOCKED ? UNKNOWN : result;
        }
        result = seen == FULL ? OPEN_THERE : result;
        left = view >= 0 && result == UNKNOWN ? left & ~(1u << uint(view)) : 0u;
    }
    return seen == FULL ? OPEN_THERE : result == UNKNOWN ? perhaps : result;
}

// The views, as bits, that may show something within the radius.
uint views_around(vec3 P) {
    uint set = 0u;
    for (int i = 0; i < params.further; i++) {
        vec4 lens = arc_block.further_lens[i], size = arc_block.further_size[i];
        vec3 place = in_view(i, P);
        float depth = max(place.z, 1e-30), grown = params.radius / depth * max(lens.x, lens.y);
        vec2 screen = place.xy / depth * lens.xy + lens.zw;
        bool beside = any(lessThan(screen, vec2(-grown))) || any(greaterThan(screen, size.xy + grown));
        set |= place.z > -params.radius && !(place.z > params.radius && beside) ? 1u << uint(i) : 0u;
    }
    return set;
}

// The slice's undecided sectors, cell by cell: one ray of each cell that has any.
void decide_by_views(inout Sectors sectors, Side s, vec3 V, vec3 across, float n, vec3 P, uint views, float place_jitter, float jitter) {
    const float width = PI / float(CELLS);
    uvec2 guessed = guessed_sectors(sectors), blocked = uvec2(0u), decided = uvec2(0u);
    uint cells = 0u;
    float c = 0.0;
    for (int i = 0; i < CELLS; i++) {
        float next = cell_end(s, n, i);
        uvec2 mask = sectors_between(c, next, jitter) & guessed;
        c = next;
        cells |= (mask.x | mask.y) != 0u ? 1u << uint(i) : 0u;
    }
    cells = views != 0u ? cells : 0u;
    for (; cells != 0u; cells &= cells - 1u) { // a rasteriser on the CPU saves turns of a loop, not branches
        int i = findLSB(cells);
        float low = cell_end(s, n, i - 1), high = cell_end(s, n, i);
        uvec2 mask = sectors_between(low, high, jitter) & guessed;
        int first = mask.x != 0u ? findLSB(mask.x) : 32 + findLSB(mask.y), last = mask.y != 0u ? 32 + findMSB(mask.y) : findMSB(mask.x);
        float u = fract(place_jitter + 0.6180340 * float(i + 1));
        c = (float(first) + min(floor(u * float(last - first + 1)), float(last - first)) + jitter) / 64.0;
        float t = n - 0.5 * PI + (float(i) + clamp((c - low) / max(high - low, 1e-6), 0.0, 1.0)) * width;
        float is_open = openness_within(P, cos(t) * V + sin(t) * across, views, fract(place_jitter + 0.7548777 * float(i + 1)));
        decided |= is_open == OPEN_THERE || is_open == BLOCKED_THERE ? mask : uvec2(0u);
        blocked |= is_open == BLOCKED_THERE || is_open == PERHAPS_BLOCKED ? mask : uvec2(0u);
    }
    sectors.blocked = (sectors.blocked & ~decided) | blocked;
    sectors.unseen &= ~decided;
}
