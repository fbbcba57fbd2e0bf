// The surface recorded at a pixel, seen away from the pixel's centre: its tangent plane.

// Depth of the surface recorded at pixel q, on the ray of `point`. The surface is extended by its tangent plane. With the depth at the
// pixel's centre instead, every tilted plane would shadow itself. If the plane is so steep that its depth doubles within the pixel, or
// that the ray misses it, the surface says nothing: the depth returned is then beyond everything.
float recorded_depth(ivec2 q, float depth, vec3 point, vec2 screen) {
    const float NOWHERE = 1e30;
    vec3 n = normal_at(q), centre = position_of(q, depth);
    if (is_orthographic()) return abs(n.z) > 1e-4 ? depth + dot(n.xy, centre.xy - point.xy) / n.z : NOWHERE;
    float ratio = dot(n, ray_at(vec2(q) + 0.5)) / dot(n, ray_at(screen)); // of the depth on this ray to that at the centre
    return ratio > 0.5 && ratio < 2.0 ? depth * ratio : NOWHERE;
}

struct Recorded {
    bool exists; // false outside the frame, behind the eye and where there is no surface
    ivec2 pixel;
    vec2 screen; // where the point appears
    float depth; // of the surface on the point's ray
};

// What the picture holds on the ray of a point.
Recorded recorded_at(vec3 point) {
    Recorded r = Recorded(false, ivec2(-1), vec2(0.0), 0.0);
    if (!in_front(point)) return r;
    r.screen = screen_of(point);
    r.pixel = ivec2(floor(r.screen));
    float depth = depth_at(r.pixel);
    if (depth == 0.0) return r;
    r.exists = true;
    r.depth = recorded_depth(r.pixel, depth, point, r.screen);
    return r;
}

// How far the point lies behind that surface, beyond what rounding can fake; 0 if it does not.
float behind_recorded(Recorded r, vec3 point) {
    float behind = point.z - r.depth;
    return r.exists && behind > 8.0 * rounding(point) ? behind : 0.0;
}
