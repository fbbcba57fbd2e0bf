// Directions that leave the frame (README, Outside). Where the march has met nothing, a direction is open if the picture shows that it
// passes through an opening. Of the others the share `openness` is taken to be open. What closes the rest sends the frame's mean light.

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

// Follows the ray from P in a direction through one map and returns how open it is, or -1 if that map does not tell.
//
// Seen from the eye the ray turns by the angle `whole` until infinity; at the angle a it is |P| sin(whole) / sin(whole - a) away (law of
// sines), distances from the eye. Up to the angle `from` another pass has found what blocks it. Indoors it runs until it is beyond the
// shell: past a surface it is blocked, unless it only passes behind the edge of one; past an opening it is outdoors. There what is seen
// through the opening blocks it, and it is indoors again where it comes before a surface of the shell.
float leaves_by_opening(int view, vec3 P, vec3 direction, float from) {
    float size = length(P), cosine = dot(P, direction) / size;
    vec3 towards = P / size, aside = direction - cosine * towards;
    float sine = length(aside), whole = fast_atan(sine, cosine), rise = size * sine, low = 0.0, low_wall = 0.0, result = -1.0;
    aside /= max(sine, 1e-6);
    vec2 start = shell_at(view, towards);
    bool outdoors = start.x < 0.0 && size > -start.x, before = false, left = false; // before: nearer than what can block it
    for (int i = 0; i <= SURROUND_STEPS && result < 0.0; i++) {
        bool last = i == SURROUND_STEPS;
        float a = last ? whole : whole * (float(i) + 0.5) / float(SURROUND_STEPS + 1), high = a, scale = sin(whole - a) * BEYOND;
        vec2 shell = shell_at(view, cos(a) * towards + sin(a) * aside);
        if (shell.x == 0.0) continue;
        if (outdoors && shell.x > 0.0) {
            before = !last && rise < shell.x * scale;
            outdoors = !before;
            left = left && outdoors;
        } else if (outdoors) {
            bool beyond = shell.y > 0.0 && (last || rise > shell.y * scale);
            bool edge = abs(shell.y - low_wall) > SHELL_STEP * shell.y; // it passes behind the edge of what is seen there
            if (last || (beyond && before && a > from && !edge)) result = beyond ? 0.0 : 1.0;
            before = !beyond;
        } else {
            bool beyond = last || rise > abs(shell.x) * scale, edge = false;
            if (beyond && before) {
                float high_wall = abs(shell.x);
                for (int k = 0; k < SURROUND_HALVINGS; k++) {
                    float middle = 0.5 * (low + high);
                    vec2 s = shell_at(view, cos(middle) * towards + sin(middle) * aside);
                    if (s.x != 0.0 && rise > abs(s.x) * BEYOND * sin(whole - middle)) {
                        high = middle;
                        shell = s;
                        high_wall = abs(s.x);
                    } else {
                        low = middle;
                        low_wall = s.x != 0.0 ? abs(s.x) : low_wall;
                    }
                }
                edge = abs(high_wall - low_wall) > SHELL_STEP * low_wall;
            }
            if ((beyond && before && !edge) || (last && shell.x < 0.0)) {
                left = outdoors = shell.x < 0.0;
                if (!outdoors && a > from) result = 0.0;
                else if (outdoors && last) result = shell.y > 0.0 ? 0.0 : 1.0;
            }
            before = !beyond;
        }
        low = a;
        low_wall = outdoors ? shell.y : abs(shell.x);
    }
    return result >= 0.0 ? result : left ? 1.0 : outdoors ? OUT_OF_SIGHT : -1.0;
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

// Where a cell of the slice, which begins at the angle `begin` from V, looks outside: anywhere in it, or a small opening would lie between
// the looks of all pixels of a plane. The angle is drawn by the density, taken as linear on either side of V, where it has a kink.
vec2 look_in(Side s, float begin, float width, int cell, float jitter) {
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
    return open >= 0.0 ? open : params.openness;
}

#if defined(BOUNCE) && defined(OUTSIDE)
// The share of the sectors that meet a surface outside the frame.
float closed_share(Side s, vec3 V, vec3 across, float n, Sectors slots, float jitter, Exits x) {
#ifdef SURROUND
    const float width = PI / float(CELLS);
    float from = n - 0.5 * PI, c = 0.0, closed = 0.0;
    for (int i = 0; i < CELLS; i++) {
        float next = i + 1 == CELLS ? 1.0 : share_at(s, from + float(i + 1) * width);
        uvec2 open = sectors(c, next, jitter) & ~slots.blocked;
        closed += sector_share(open) - open_share(open, slots.seen, openness(V, across, look_in(s, from + float(i) * width, width, i, jitter), x));
        c = next;
    }
    return closed;
#else
    return sector_share(~slots.blocked) - open_share(~slots.blocked, slots.seen, params.openness);
#endif
}
#endif
