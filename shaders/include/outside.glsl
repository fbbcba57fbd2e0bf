// Directions that leave the frame (README, Outside). Where the march has met nothing, a direction is open if the picture shows that it
// passes through an opening. Of the others a share is taken to be open, by direction (`unknown_openness`). What closes the rest sends the
// frame's mean light.

#ifdef SURROUND
// The surround (src/passes/surround.h): what further G-buffers show, each around its own eye, one map below the other. A texel holds the
// distance of a shell about the eye, negative where that is an opening and 0 where nothing is known; and the distance of what is seen
// through the opening, 0 for the sky. The last row holds the eyes, in camera space.
PICTURE(rg32f, surround_image);

const int SURROUND_STEPS = 12, SURROUND_HALVINGS = 4;
const float SHELL_STEP = 0.2;  // between two directions the shell steps by more than this share: an edge, not a surface
const float BEYOND = 1.02;     // what is not farther than this lies on the shell
const float OWN_EYE = 1e-4;    // squared share of the receiver's distance: an eye that near is the frame's own
const float OFF_SURFACE = 0.05; // radians: before that the receiver's own surface could block it
const float OUT_OF_SIGHT = 0.3; // how open the directions are, out there, that no eye sees

vec2 shell_at(int view, vec3 direction) { // camera space
    ivec2 size = ivec2(SURROUND_WIDTH, SURROUND_HEIGHT);
    return FETCH(surround_image, min(ivec2(map_uv(to_map(direction)) * vec2(size)), size - 1) + ivec2(0, view * SURROUND_HEIGHT)).rg;
}

vec3 surround_eye(int view) {
    int row = params.views * SURROUND_HEIGHT;
    return vec3(FETCH(surround_image, ivec2(2 * view, row)).rg, FETCH(surround_image, ivec2(2 * view + 1, row)).r);
}

// A ray from a point, as an eye sees it. It turns by the angle `whole` until infinity. At the angle a it is `rise` / sin(whole - a) away
// from the eye (law of sines), and so are all distances here. It is indoors inside the shell, and outdoors once it has passed an opening.
struct Ray {
    vec3 towards, aside; // unit: where it starts, and across that to where it goes
    float whole, rise;
    float from;          // up to this angle another pass has found what blocks it
    bool outdoors, left; // left: through an opening that it has met
    bool before;         // at the last look it was nearer than what can block it
    float angle, wall;   // of the last look; wall: how far what can block it was there
};

const float OPEN = 1.0, BLOCKED = 0.0, UNDECIDED = -1.0;

vec3 heading(Ray r, float a) { return cos(a) * r.towards + sin(a) * r.aside; }
bool is_beyond(Ray r, float a, float wall) { return r.rise > wall * (BEYOND * sin(r.whole - a)); }

Ray ray_from(vec3 P, vec3 direction, float from) {
    Ray r;
    float size = length(P), cosine = dot(P, direction) / size;
    r.towards = P / size;
    r.aside = direction - cosine * r.towards;
    float sine = length(r.aside);
    r.aside /= max(sine, 1e-6);
    r.whole = fast_atan(sine, cosine);
    r.rise = size * sine;
    r.from = from;
    r.before = r.left = r.outdoors = false;
    r.angle = r.wall = 0.0;
    return r;
}

// Between the last look and the one at angle a the ray has passed the shell. Finds where; `shell` becomes what is there. True if it has
// only passed behind the edge of something: then the shell is not connected there, and the ray may be free.
bool passes_an_edge(Ray r, int view, float a, inout vec2 shell) {
    float low = r.angle, high = a, low_wall = r.wall, high_wall = abs(shell.x);
    for (int k = 0; k < SURROUND_HALVINGS; k++) {
        float middle = 0.5 * (low + high);
        vec2 s = shell_at(view, heading(r, middle));
        if (s.x != 0.0 && is_beyond(r, middle, abs(s.x))) {
            high = middle;
            shell = s;
            high_wall = abs(s.x);
        } else {
            low = middle;
            low_wall = s.x != 0.0 ? abs(s.x) : low_wall;
        }
    }
    return abs(high_wall - low_wall) > SHELL_STEP * low_wall;
}

// A look at angle a, indoors: past a surface the ray is blocked, past an opening it is outdoors.
float look_indoors(inout Ray r, int view, float a, bool last, inout vec2 shell) {
    bool beyond = last || is_beyond(r, a, abs(shell.x));
    bool passes = beyond && r.before && !passes_an_edge(r, view, a, shell);
    bool leaves = shell.x < 0.0 && (passes || last);
    if (leaves) r.left = r.outdoors = true;
    r.before = !beyond;
    if (leaves) return !last ? UNDECIDED : shell.y > 0.0 ? BLOCKED : OPEN;
    return passes && a > r.from ? BLOCKED : UNDECIDED;
}

// A look at angle a, outdoors: what is seen through the opening blocks the ray. It is indoors again where it comes before a surface of
// the shell.
float look_outdoors(inout Ray r, float a, bool last, vec2 shell) {
    if (shell.x > 0.0) {
        r.before = !last && !is_beyond(r, a, shell.x);
        r.outdoors = !r.before;
        r.left = r.left && r.outdoors;
        return UNDECIDED;
    }
    bool beyond = shell.y > 0.0 && (last || is_beyond(r, a, shell.y));
    bool behind_an_edge = abs(shell.y - r.wall) > SHELL_STEP * shell.y; // of what is seen there
    bool blocked = beyond && r.before && a > r.from && !behind_an_edge;
    r.before = !beyond;
    return last || blocked ? (beyond ? BLOCKED : OPEN) : UNDECIDED;
}

// Follows the ray from P in a direction through one map: how open it is, or UNDECIDED if that map does not tell.
float leaves_by_opening(int view, vec3 P, vec3 direction, float from) {
    Ray r = ray_from(P, direction, from);
    vec2 start = shell_at(view, r.towards);
    r.outdoors = start.x < 0.0 && length(P) > -start.x;
    for (int i = 0; i <= SURROUND_STEPS; i++) {
        bool last = i == SURROUND_STEPS; // at infinity
        float a = last ? r.whole : r.whole * (float(i) + 0.5) / float(SURROUND_STEPS + 1);
        vec2 shell = shell_at(view, heading(r, a));
        if (shell.x == 0.0) continue;
        float open = r.outdoors ? look_outdoors(r, a, last, shell) : look_indoors(r, view, a, last, shell);
        if (open != UNDECIDED) return open;
        r.angle = a;
        r.wall = r.outdoors ? shell.y : abs(shell.x);
    }
    return r.left ? OPEN : r.outdoors ? OUT_OF_SIGHT : UNDECIDED;
}
#endif

// The share of `open` sectors that are open outside, where those that are not `seen` are so by the share `unseen`.
float open_share(uvec2 open, uvec2 seen, float unseen) {
    float known = sector_share(open & seen);
    return known + unseen * (sector_share(open) - known);
}

// What a look outside needs of the receiver: its place, and at which angles from its view ray the slice's two lines leave the frame.
struct Exits { vec3 P; float right, left; };

Exits exits_of(vec3 P, vec3 V, Lines lines) {
    Exits x = Exits(P, 0.0, 0.0);
#ifdef SURROUND
    vec3 right = normalize(ray_at(lines.right.origin + lines.right.border * lines.right.direction));
    vec3 left = normalize(ray_at(lines.left.origin + lines.left.border * lines.left.direction));
    x.right = fast_atan(length(cross(V, right)), -dot(V, right));
    x.left = fast_atan(length(cross(V, left)), -dot(V, left));
#endif
    return x;
}

// Density of the slice's cosine weight over the angle t from V.
float density(Side s, float t) { return abs(sin(t)) * max(cos(t) * s.cos_n + sin(t) * s.sin_n, 0.0); }

// Where a cell of the slice, which begins at the angle `begin` from V, looks outside. In a surround that is anywhere in it, or a small
// opening would lie between the looks of all pixels of a plane. The angle is drawn by the density, taken as linear on either side of V,
// where it has a kink.
vec2 look_in(Side s, float begin, float width, int cell, float jitter) {
#ifndef SURROUND
    return vec2(cos(begin + 0.5 * width), sin(begin + 0.5 * width));
#else
    float u = fract(jitter + 0.6180340 * float(cell + 1)), end = begin + width, first = density(s, begin), last = density(s, end);
    if (begin < 0.0 && end > 0.0) {
        float before = -begin * first, after = end * last;
        bool is_before = u * (before + after) < before;
        u = is_before ? u * (before + after) / before : (u * (before + after) - before) / max(after, 1e-12);
        first = is_before ? first : 0.0;
        last = is_before ? 0.0 : last;
        begin = is_before ? begin : 0.0;
        end = is_before ? 0.0 : end;
    }
    float part = abs(last - first) > 1e-3 * (first + last) ? (sqrt(mix(first * first, last * last, u)) - first) / (last - first) : u;
    float t = mix(begin, end, clamp(part, 0.0, 1.0));
    return vec2(cos(t), sin(t));
#endif
}

vec3 upright(vec3 v) { // from camera space, to the axes of the grid and its box
    vec4 rows[3] = arc_block.upright_from_camera;
    return vec3(dot(rows[0].xyz, v), dot(rows[1].xyz, v), dot(rows[2].xyz, v));
}

// A number of the lat-long grid (src/passes/openness.h).
float stored_openness(int row, int column) {
    int i = row == 0 ? 0 : row > OPENNESS_ROWS ? 1 : 2 + (row - 1) * OPENNESS_COLUMNS + (column & (OPENNESS_COLUMNS - 1));
    return arc_block.openness[i >> 2][i & 3];
}

// Where a ray from P leaves the box, as a direction from the middle of the box, whose sides count as equally long. From the middle of
// a box without a size that is the ray's own direction. Upright axes, d unit.
vec3 way_through_walls(vec3 P, vec3 d) {
    vec3 low = arc_block.walls_low.xyz, high = arc_block.walls_high.xyz;
    vec3 times = (mix(low, high, greaterThan(d, vec3(0.0))) - P) / mix(d, vec3(1e-20), lessThan(abs(d), vec3(1e-20)));
    vec3 from_middle = P + max(0.0, min(times.x, min(times.y, times.z))) * d - 0.5 * (low + high);
    vec3 aside = from_middle / max(high - low, vec3(1e-12));
    float most = max(abs(aside.x), max(abs(aside.y), abs(aside.z)));
    return most > 1e-12 && most < 1e30 ? normalize(aside / most) : d;
}

// How open the outside is where nothing is known: linear between the numbers of the grid.
float unknown_openness(vec3 P, vec3 d) { // upright axes, d unit
#ifdef SUNS
    if (params.sun_openness >= 0.0) return params.sun_openness;
#endif
    vec2 place = map_uv(way_through_walls(P, d)) * vec2(OPENNESS_COLUMNS, OPENNESS_ROWS + 1), low = floor(place), t = place - low;
    int x = int(low.x), y = clamp(int(low.y), 0, OPENNESS_ROWS);
    return mix(mix(stored_openness(y, x), stored_openness(y, x + 1), t.x),
               mix(stored_openness(y + 1, x), stored_openness(y + 1, x + 1), t.x), t.y);
}

// How open the outside is in the direction at.x V + at.y across: closed if one map shows a surface there, else as open as one shows.
float openness(vec3 V, vec3 across, vec2 at, Exits x) {
    float open = -1.0;
#ifdef SURROUND
    for (int i = 0; i < params.views; i++) {
        vec3 eye = surround_eye(i), P = x.P - eye;
        bool own = dot(eye, eye) < OWN_EYE * dot(x.P, x.P); // only for the frame's own eye the march has looked already
        float o = leaves_by_opening(i, P, at.x * V + at.y * across, own ? (at.y > 0.0 ? x.right : x.left) : OFF_SURFACE);
        open = o == 0.0 || open == 0.0 ? 0.0 : max(open, o);
    }
#endif
    return open >= 0.0 ? open : unknown_openness(upright(x.P), upright(at.x * V + at.y * across));
}
