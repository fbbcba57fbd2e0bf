// Planes stand in for what the camera does not see (THEORY.md 3.6). A direction that hits a plane within R is blocked unless the
// picture contradicts it:
//   hit inside the frame:  it must lie behind the surface recorded there, and inside the plane's support
//   hit outside the frame: where the slice's line leaves the frame, the plane must lie at the recorded surface or behind it

struct Plane {
    vec4 equation; // xyz unit normal, w offset: dot(xyz, x) = w
    vec4 u, v;     // xyz axis of the support, w its centre along it
    vec4 half_size;
    vec4 light; // rgb: mean of what its pixels send
    uvec4 cells[2]; // 16 x 16 bits over the support: the picture does not show the plane to be absent there
};
layout(std140, binding = 2) uniform Planes { Plane planes[12]; };

const int CHORDS = 6; // directions tested of the arc that a plane could block
const float ROOM = 0.004; // of the depth: as far as a plane may lie off its own surface, and a little more

// Depth at which a pixel's ray meets a plane; huge if it does not.
float plane_depth(Plane k, vec2 screen) {
    vec3 ray = ray_at(screen);
    float along = is_orthographic() ? k.equation.z : dot(k.equation.xyz, ray);
    float z = (is_orthographic() ? k.equation.w - dot(k.equation.xy, ray.xy) : k.equation.w) / along;
    return z > 0.0 ? z : 1e30;
}

// True if the recorded surface at a pixel lies in front of depth z, or (with a negative sign of ROOM) at it.
bool hidden(float recorded, float z, float room) { return recorded != 0.0 && z > recorded * (1.0 + room); }

bool border_allows(Plane k, Line line) {
    ivec2 q = ivec2(floor(line.origin + line.border * line.direction));
    float recorded = imageLoad(depth_image, q).r;
    return hidden(recorded, plane_depth(k, vec2(q) + 0.5), -ROOM);
}

bool supported(Plane k, vec3 X) {
    vec2 at = vec2(dot(k.u.xyz, X) - k.u.w, dot(k.v.xyz, X) - k.v.w) / k.half_size.xy;
    uvec2 cell = uvec2(clamp(at * 8.0 + 8.0, 0.0, 15.0));
    uvec4 half_rows = cell.y < 8u ? k.cells[0] : k.cells[1];
    uint word = (cell.y & 4u) == 0u ? ((cell.y & 2u) == 0u ? half_rows.x : half_rows.y) : ((cell.y & 2u) == 0u ? half_rows.z : half_rows.w);
    return all(lessThanEqual(abs(at), vec2(1.0))) && ((word >> (cell.x + 16u * (cell.y & 1u))) & 1u) == 1u;
}

// Without a radius a plane is not believed farther from its support than the support is wide.
bool near_support(Plane k, vec3 X) {
    vec2 at = vec2(dot(k.u.xyz, X) - k.u.w, dot(k.v.xyz, X) - k.v.w) / k.half_size.xy;
    return all(lessThanEqual(abs(at), vec2(1.5)));
}

// Whether the plane's point X counts.
bool stands(Plane k, vec3 X, bool border) {
    vec2 screen = screen_of(X);
    ivec2 q = ivec2(floor(screen));
    if (X.z <= 0.0 || !in_frame(q)) return border && (params.radius < UNLIMITED || near_support(k, X));
    return supported(k, X) && hidden(imageLoad(depth_image, q).r, X.z, ROOM);
}

void block_by_planes(inout Sectors slots, Side s, vec3 V, vec3 across, float n, Line right, Line left, vec3 P, float jitter) {
    for (int i = 0; i < params.planes; i++) {
        Plane k = planes[i];
        // Distance to the plane along direction t: h / (m cos(t - t0)).
        float h = k.equation.w - dot(k.equation.xyz, P);
        vec2 normal = vec2(dot(k.equation.xyz, V), dot(k.equation.xyz, across)) * (h < 0.0 ? -1.0 : 1.0);
        float m = length(normal), reach = abs(h) / max(m * params.radius, 1e-20);
        bool relevant = reach < 1.0 && abs(h) > ROOM * P.z;
        float t0 = atan(normal.y, normal.x), half_angle = fast_acos(min(reach, 1.0));
        if (t0 - n > PI) t0 -= 2.0 * PI;
        if (t0 - n < -PI) t0 += 2.0 * PI;
        float from = max(t0 - half_angle, n - 0.5 * PI), to = min(t0 + half_angle, n + 0.5 * PI);
        relevant = relevant && from < to;
        if (!relevant) continue;
        bool border_right = border_allows(k, right), border_left = border_allows(k, left);
        vec3 sent = h < 0.0 ? k.light.rgb : vec3(0.0); // from the side that the camera sees
        float width = (to - from) / float(CHORDS), c = share_at(s, from);
        for (int j = 0; j < CHORDS; j++) {
            float t = from + (float(j) + jitter) * width, next = share_at(s, from + float(j + 1) * width);
            vec3 X = P + abs(h) / (m * cos(t - t0)) * (cos(t) * V + sin(t) * across);
            if (stands(k, X, t > 0.0 ? border_right : border_left)) block(slots, sectors(c, next, jitter), sent);
            c = next;
        }
    }
}
