// The surround (src/passes/surround.h): what further G-buffers show, each map around its own eye, one below the other. A texel holds the
// distance of a shell about the eye, negative where that is an opening and 0 where nothing is known; and the distance of what is seen
// through the opening, 0 for the sky. All is in the axes of the environment's map.
PICTURE(rg32f, surround_image);

const int SURROUND_STEPS = 12, SURROUND_HALVINGS = 4;
const float SHELL_STEP = 0.2;  // between two directions the shell steps by more than this share: an edge, not a surface
const float BEYOND = 1.02;     // what is not farther than this lies on the shell
const float OWN_EYE = 1e-4;    // squared share of the receiver's distance: an eye that near is the frame's own
const float OFF_SURFACE = 0.05; // radians: before that the receiver's own surface could block it
const float OPEN = 1.0, BLOCKED = 0.0, UNDECIDED = -1.0;
const float LEFT = 0.999;       // how open a ray is that has left through an opening, and whose end no eye sees: not surely OPEN
const float OUT_OF_SIGHT = 0.3; // how open the directions are, out there, that no eye sees

ivec2 surround_texel(int map, vec3 direction, int side) { // of any length
    vec3 size = abs(direction);
    vec2 p = direction.xy / max(size.x + size.y + size.z, 1e-30), folded = (1.0 - abs(p.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    vec2 place = ((direction.z < 0.0 ? folded : p) * 0.5 + 0.5) * float(side);
    return min(ivec2(place), ivec2(side - 1)) + ivec2(0, map * side);
}

vec2 shell_at(int map, vec3 direction) { return FETCH(surround_image, surround_texel(map, direction, SURROUND_SIDE)).rg; }

// A ray from a point, as an eye sees it. At the angle a from its nearest point to the eye it is `nearest` / cos(a) away, and there at a
// right angle it is infinitely far. It is indoors inside the shell, and outdoors once it has passed an opening.
struct Ray {
    vec3 foot, direction; // unit: to its nearest point, and where it goes
    float nearest;
    float start, from;   // angles: of its first point; up to this one another pass has found what blocks it
    bool outdoors, left; // left: through an opening that it has met
    bool before;         // at the last look it was nearer than what can block it
    float angle, wall;   // of the last look; wall: how far what can block it was there
};

vec3 heading(Ray r, float a) { return cos(a) * r.foot + sin(a) * r.direction; }
bool is_beyond(Ray r, float a, float wall) { return r.nearest > wall * (BEYOND * cos(a)); }

Ray ray_from(vec3 P, vec3 direction, float from) {
    Ray r;
    float along = dot(P, direction);
    vec3 nearest = P - along * direction;
    r.nearest = length(nearest);
    r.foot = nearest / max(r.nearest, 1e-30);
    r.direction = direction;
    r.start = 0.5 * PI - fast_atan(r.nearest, along);
    r.from = r.start + from;
    r.before = r.left = r.outdoors = false;
    r.angle = r.start;
    r.wall = 0.0;
    return r;
}

// A look at angle a, indoors: past a surface the ray is blocked, past an opening it is outdoors. `passes`: between the last look and this
// one it has passed what `shell` shows.
float look_indoors(inout Ray r, float a, bool last, bool beyond, bool passes, vec2 shell) {
    bool leaves = shell.x < 0.0 && (passes || last);
    r.left = r.left || leaves;
    r.outdoors = leaves;
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

// Follows the ray from P, seen from the map's eye, in a direction: how open it is, or UNDECIDED if that map does not tell. met: towards
// what blocks it. Where it has passed the shell, halvings find whether it has only passed behind the edge of something: then the shell is
// not connected there, and the ray may be free. One look a turn, because a rasteriser on the CPU saves turns of a loop, not branches.
float follow(int map, vec3 P, vec3 direction, float from, out vec3 met) {
    Ray r = ray_from(P, direction, from);
    vec2 start = shell_at(map, P), passed = vec2(0.0);
    r.outdoors = start.x < 0.0 && length(P) > -start.x;
    float low = 0.0, low_wall = 0.0, high = 0.0, at = 0.0, open = UNDECIDED, turn = 0.5 * PI - r.start;
    int halvings = 0, step = 0;
    met = direction;
    for (int looks = 0; looks <= SURROUND_STEPS + 3 * SURROUND_HALVINGS && step <= SURROUND_STEPS && open == UNDECIDED; looks++) {
        bool last = step == SURROUND_STEPS, halving = halvings > 0; // last: at infinity
        float next = r.start + turn * (last ? 1.0 : (float(step) + 0.5) / float(SURROUND_STEPS + 1)), a = halving ? 0.5 * (low + high) : next;
        vec3 way = last && !halving ? direction : heading(r, a);
        vec2 shell = shell_at(map, way);
        bool known = shell.x != 0.0, beyond = known && ((last && !halving) || is_beyond(r, a, abs(shell.x)));
        if (halving) {
            high = beyond ? a : high;
            passed = beyond ? shell : passed;
            met = beyond ? way : met;
            low_wall = known && !beyond ? abs(shell.x) : low_wall;
            low = beyond ? low : a;
            halvings--;
        } else {
            met = way;
            passed = shell;
            low = r.angle, low_wall = r.wall, high = a;
            halvings = !r.outdoors && beyond && r.before ? SURROUND_HALVINGS : 0;
        }
        if (halvings > 0) continue;
        if (known || halving) {
            bool passes = halving && abs(abs(passed.x) - low_wall) <= SHELL_STEP * low_wall;
            open = r.outdoors ? look_outdoors(r, a, last, passed) : look_indoors(r, next, last, halving || beyond, passes, passed);
            r.angle = next;
            r.wall = r.outdoors ? passed.y : abs(passed.x);
        }
        step++;
    }
    return open != UNDECIDED ? open : r.left ? LEFT : r.outdoors ? OUT_OF_SIGHT : UNDECIDED;
}

#if defined(BOUNCE) && !defined(EXITANT)
PICTURE(rgba32f, surround_light_image); // what the maps' surfaces send (surround_light.comp)
PICTURE(rgba32f, outside_image);        // first texel: what the frame's surfaces send, in the mean; second: their mean albedo

// What a texel of the maps sends; `otherwise` where nothing is there.
vec3 sent_from(ivec2 texel, vec3 otherwise) {
    vec4 shown = FETCH(surround_light_image, texel);
    return shown.a < 0.0 ? otherwise : shown.rgb * (shown.a == 1.0 ? vec3(1.0) : FETCH(outside_image, ivec2(1, 0)).rgb);
}
#endif
