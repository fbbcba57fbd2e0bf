// What the picture itself says of a slice's directions, within the radius (README, Evidence). A direction is decided if it meets a recorded
// surface, or if the camera sees all of it. Between two samples of one run, every direction between theirs meets the surface. What
// lies on a view ray behind the surface is hidden: there the directions from the surface to where the view ray leaves the ball pass
// unseen. So do those that meet, inside the ball, the view ray at the frame's border. All others are guessed.

// Directions that meet, inside the ball, a view ray farther from the eye than `point` of it. The slice cuts the ball in a circle.
uvec2 beyond_on_ray(Side s, vec2 point, vec2 direction, float squared_radius, float jitter) {
    float b = dot(point, direction), discriminant = b * b + squared_radius - dot(point, point), root = sqrt(max(discriminant, 0.0));
    float first = max(-b - root, 0.0), last = root - b;
    float near = share(s, point + first * direction), far = share(s, point + last * direction);
    return discriminant > 0.0 && last > 0.0 ? sectors_between(near, max(near, far), jitter) : uvec2(0u);
}

// Those that leave the frame on this line.
uvec2 beyond_frame(Side s, Line line, vec3 P, float jitter) {
    vec2 screen = line.origin + line.border * line.direction;
    if (is_orthographic()) {
        vec3 before_ball = vec3(0.0, 0.0, -2.0 * params.radius);
        return beyond_on_ray(s, in_slice(s, position_at(screen, P.z) - P + before_ball), -s.eye, params.radius * params.radius, jitter);
    }
    return beyond_on_ray(s, s.eye, in_slice(s, normalize(ray_at(screen))), params.radius * params.radius, jitter);
}

uvec2 guessed_sectors(Sectors sectors) { return sectors.unseen & ~sectors.met; }
