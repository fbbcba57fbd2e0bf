// Directions that leave the frame (README, Outside). Where the march has met nothing, a direction is open if the picture shows that it
// passes through an opening. Of the others a share is taken to be open, by direction (`unknown_openness`). What closes the rest sends the
// frame's mean light.

#ifdef SURROUND
#include "include/surround.glsl"
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

#ifdef SURROUND
// What the maps tell of a direction from P, camera space: how open it is, UNDECIDED if none tells. The first that decides does. Those that
// see the most of what the frame does not come first (src/passes/surround_image.c). exit: the angle from the view ray at which it leaves the
// frame, as far as which the march has looked already. met: the texel of `surround_light_image` that shows what blocks it.
float shown_openness(vec3 P, vec3 direction, float exit, out ivec2 met) {
    vec3 d = to_map(direction), from_eye = to_map(P), way;
    float open = UNDECIDED;
    met = ivec2(0);
    for (int i = 0; i < params.views && (open == UNDECIDED || open == OUT_OF_SIGHT); i++) {
        vec4 eye = arc_block.view_eye[i];
        bool own = dot(eye.xyz, eye.xyz) < OWN_EYE * dot(P, P); // only for the frame's own eye the march has looked already
        float o = follow(int(eye.w), from_eye + eye.xyz, d, own ? exit : OFF_SURFACE, way);
        if (o == BLOCKED) met = surround_texel(int(eye.w), way, SURROUND_COARSE);
        open = o == UNDECIDED ? open : o;
    }
    return open;
}
#endif

// How open the outside is in the direction at.x V + at.y across, and in the surround what closes it.
float openness(vec3 V, vec3 across, vec2 at, Exits x, out ivec2 met) {
    vec3 direction = at.x * V + at.y * across;
#ifdef SURROUND
    float shown = shown_openness(x.P, direction, at.y > 0.0 ? x.right : x.left, met);
    if (shown >= 0.0) return shown;
#endif
    met = ivec2(-1);
    return unknown_openness(upright(x.P), upright(direction));
}
float openness(vec3 V, vec3 across, vec2 at, Exits x) {
    ivec2 met;
    return openness(V, across, at, x, met);
}
