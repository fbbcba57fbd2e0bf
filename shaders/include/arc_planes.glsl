// Planes stand in for what the camera does not see (README, Planes). A direction that hits a plane within R is blocked unless the
// picture contradicts it:
//   hit inside the frame:  it must lie behind the surface recorded there, and inside the plane's support
//   hit outside the frame: where the slice's line leaves the frame, the plane must lie at the recorded surface or behind it

PICTURE(rgba32f, planes_image);

const int CHORDS = 5; // directions tested of the arc in which a plane's support lies
const float UNEVEN_LEAST = 0.04; // uneven ground nearer than this share of its margin is the receiver's own surface

// True if the recorded surface at a pixel lies in front of depth z, or (with a negative margin) at it. A margin is a share of the depth,
// with an orthographic camera a length: twice as far as a plane's own surface may lie off it.
bool hidden(float recorded, float z, float margin) {
    return recorded != 0.0 && z > (is_orthographic() ? recorded + margin : recorded * (1.0 + margin));
}

// The pixel where a line leaves the frame.
struct Border { vec2 ray; float recorded; };

Border border_of(Line line) {
    ivec2 q = ivec2(line.origin + line.border * line.direction);
    return Border(ray_at(vec2(q) + 0.5).xy, FETCH_INSIDE(depth_image, q, vec4(0.0)).r);
}

// Whether a plane may go on beyond the frame there.
bool allows(Border b, vec4 equation, float margin) {
    float across = dot(equation.xy, b.ray);
    float z = is_orthographic() ? (equation.w - across) / equation.z : equation.w / (across + equation.z);
    return hidden(b.recorded, z > 0.0 ? z : 1e30, -margin);
}

// Whether the plane's point X counts; `here`: its place on the support, -1 .. 1.
bool stands(int plane, vec3 X, vec2 here, bool beyond_frame, float margin) {
    vec2 screen = screen_of(X);
    // Compared before the conversion to integers: screen coordinates of a point near the eye do not fit into one.
    bool inside = X.z > 0.0 && all(greaterThanEqual(screen, vec2(0.0))) && all(lessThan(screen, vec2(frame_size)));
    ivec2 q = ivec2(inside ? screen : vec2(0.0)), cell = ivec2(clamp(here * 8.0 + 8.0, 0.0, 15.0));
    vec4 rows = FETCH(planes_image, ivec2(PLANE_MASK + (cell.y >> 2), plane));
    uint row = uint((cell.y & 2) == 0 ? ((cell.y & 1) == 0 ? rows.x : rows.y) : ((cell.y & 1) == 0 ? rows.z : rows.w));
    bool supported = max(abs(here.x), abs(here.y)) <= 1.0 && ((row >> cell.x) & 1u) == 1u;
    bool behind = hidden(FETCH(depth_image, q).r, X.z, margin);
    return inside ? supported && behind : beyond_frame && max(abs(here.x), abs(here.y)) <= BELIEVED_PLANE;
}

// The planes, as bits, that can block directions of a point with normal N: not those that it lies on, whose support lies under its
// tangent plane, or that are out of reach. Found once for all its slices, because a rasteriser on the CPU saves turns of a loop, not
// branches.
uint planes_around(vec3 P, vec3 N) {
    uint set = 0u;
    for (int i = 0; i < params.planes; i++) {
        vec4 equation = FETCH(planes_image, ivec2(PLANE_EQUATION, i));
        float off = FETCH(planes_image, ivec2(PLANE_LIGHT, i)).w, h = equation.w - dot(equation.xyz, P), height = abs(h);
        bool uneven = off < 0.0;
        float least = 2.0 * abs(off) * (uneven ? UNEVEN_LEAST : 1.0) * (is_orthographic() ? 1.0 : P.z);
        bool blocks = height > least && !(uneven && h > 0.0);
        // The support, with what is believed beyond the frame: its middle and its sides.
        vec4 u = FETCH(planes_image, ivec2(PLANE_U, i)), v = FETCH(planes_image, ivec2(PLANE_V, i));
        vec2 squares = vec2(dot(u.xyz, u.xyz), dot(v.xyz, v.xyz)), sides = (1.001 * BELIEVED_PLANE) / squares;
        vec3 middle = equation.w * equation.xyz + u.w / squares.x * u.xyz + v.w / squares.y * v.xyz;
        blocks = blocks && dot(N, middle - P) + sides.x * abs(dot(N, u.xyz)) + sides.y * abs(dot(N, v.xyz)) > 0.0;
#ifdef LIMITED
        vec2 aside = max(abs(vec2(dot(u.xyz, P) - u.w, dot(v.xyz, P) - v.w)) - 1.001 * BELIEVED_PLANE, vec2(0.0));
        blocks = blocks && h * h + dot(aside * aside, 1.0 / squares) < params.radius * params.radius;
#endif
        set |= blocks ? 1u << uint(i) : 0u;
    }
    return set;
}

// The part of a line A + x B that lies in the square -size .. size: from x.x to x.y, none if x.y is less.
vec2 part_inside(vec2 A, vec2 B, float size) {
    vec2 inverse = 1.0 / mix(B, vec2(1e-20), lessThan(abs(B), vec2(1e-20)));
    vec2 a = (-size - A) * inverse, b = (size - A) * inverse, low = min(a, b), high = max(a, b);
    return vec2(max(low.x, low.y), min(high.x, high.y));
}

float angle_of(float tangent) { return fast_atan(abs(tangent), 1.0) * (tangent < 0.0 ? -1.0 : 1.0); }

void block_by_planes(inout Sectors sectors, Side s, vec3 V, vec3 across, float n, Lines lines, vec3 P, uint planes, float place, float jitter) {
    Border right = border_of(lines.right), left = border_of(lines.left);
    for (uint rest = planes; rest != 0u; rest &= rest - 1u) {
        int i = findLSB(rest);
        vec4 equation = FETCH(planes_image, ivec2(PLANE_EQUATION, i));
        vec4 u = FETCH(planes_image, ivec2(PLANE_U, i)), v = FETCH(planes_image, ivec2(PLANE_V, i));
        float margin = 2.0 * abs(FETCH(planes_image, ivec2(PLANE_LIGHT, i)).w);
        bool goes_right = allows(right, equation, margin), goes_left = allows(left, equation, margin);
        // The slice meets the plane in a line. Its points are nearest + x along; x is the tangent of the angle from t0, where the line
        // is nearest. Distance to the plane along direction t: height / (normal . (cos t, sin t)).
        float h = equation.w - dot(equation.xyz, P), height = abs(h);
        vec2 normal = vec2(dot(equation.xyz, V), dot(equation.xyz, across)) * (h < 0.0 ? -1.0 : 1.0);
        float inverse = inversesqrt(max(dot(normal, normal), 1e-30)), distance = height * inverse;
        vec2 d0 = normal * inverse;
        vec3 nearest = P + distance * (d0.x * V + d0.y * across), along = distance * (d0.x * across - d0.y * V);
        vec2 line = part_inside(vec2(dot(u.xyz, nearest) - u.w, dot(v.xyz, nearest) - v.w), vec2(dot(u.xyz, along), dot(v.xyz, along)),
                                goes_right || goes_left ? BELIEVED_PLANE : 1.0);
#ifdef LIMITED
        float reach = min(distance / params.radius, 1.0), most = sqrt(1.0 - reach * reach) / reach;
        line = vec2(max(line.x, -most), min(line.y, most));
#endif
        float t0 = fast_atan(abs(normal.y), normal.x) * (normal.y < 0.0 ? -1.0 : 1.0);
        t0 -= t0 - n > PI ? 2.0 * PI : t0 - n < -PI ? -2.0 * PI : 0.0;
        const float WIDEST = 0.5 * PI - 1e-4;
        float from = max(t0 + max(angle_of(line.x), -WIDEST), n - 0.5 * PI), to = min(t0 + min(angle_of(line.y), WIDEST), n + 0.5 * PI);
        float width = (to - from) / float(CHORDS);
#ifdef BOUNCE
        vec3 sent = h < 0.0 ? FETCH(planes_image, ivec2(PLANE_LIGHT, i)).rgb : vec3(0.0); // from the side that the camera sees
#else
        vec3 sent = vec3(0.0);
#endif
        vec4 belief = FETCH(planes_image, ivec2(PLANE_BELIEF, i));
        uint believed = uint(belief.y) | uint(belief.z) << 16u;
        vec2 edge = vec2(cos(from), sin(from)), turn = vec2(cos(width), sin(width)), part = vec2(cos(place * width), sin(place * width));
        float c = share_at(s, from, edge);
        // Most planes lie where the picture's own surfaces have blocked all already.
        uvec2 left_open = sectors_between(c, share_at(s, to), jitter) & believed & ~sectors.blocked;
        int chords = line.x < line.y && width > 0.0 && (left_open.x | left_open.y) != 0u ? CHORDS : 0;
        for (int j = 0; j < chords; j++) {
            vec2 d = turned(edge, part);
            edge = turned(edge, turn);
            float next = share_at(s, from + float(j + 1) * width, edge);
            vec3 X = P + height / dot(normal, d) * (d.x * V + d.y * across);
            vec2 here = vec2(dot(u.xyz, X) - u.w, dot(v.xyz, X) - v.w);
            bool blocks = stands(i, X, here, d.y > 0.0 ? goes_right : goes_left, margin);
            block(sectors, blocks ? sectors_between(c, next, jitter) & believed : uvec2(0u), sent);
            c = next;
        }
    }
}
