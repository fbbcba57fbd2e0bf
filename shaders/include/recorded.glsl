// The surface recorded at a pixel, seen away from the pixel's centre: its tangent plane.

// Depth, on the ray of `point`, of the surface recorded at pixel q, which is its tangent plane. Taking the pixel centre's depth
// instead would let every tilted plane shadow itself. A plane so steep that it doubles its depth within the pixel, or ends there,
// is no evidence: the depth returned is then beyond everything.
float recorded_depth(ivec2 q, float depth, vec3 point, vec2 screen) {
    const float NOWHERE = 1e30;
    vec3 n = normal_at(q), centre = position_of(q, depth);
    if (is_orthographic()) return abs(n.z) > 1e-4 ? depth + dot(n.xy, centre.xy - point.xy) / n.z : NOWHERE;
    float ratio = dot(n, ray_at(vec2(q) + 0.5)) / dot(n, ray_at(screen)); // of the depth on this ray to that at the centre
    return ratio > 0.5 && ratio < 2.0 ? depth * ratio : NOWHERE;
}
