// The screen line of a slice, and where its steps fall.

struct Line {
    vec2 origin;    // centre of the receiver's pixel
    vec2 direction; // unit, in pixels
    float border;   // distance at which the line leaves the frame
    float reach;    // distance beyond which no view ray meets the ball of radius R
};

float leaves_frame(vec2 origin, vec2 direction) {
    vec2 room = mix(origin, vec2(frame.size.xy) - origin, greaterThan(direction, vec2(0.0)));
    vec2 steps = room / max(abs(direction), vec2(1e-6));
    return min(steps.x, steps.y) - 1e-3;
}

// Derivative of the projection of P along a direction, times a positive factor.
vec2 screen_direction(vec3 P, vec3 direction) {
    vec2 d = is_orthographic() ? direction.xy : direction.xy * P.z - P.xy * direction.z;
    return normalize(d * frame.lens.xy);
}

// The slice cuts the ball in a circle; seen from the eye it reaches asin(R / |P|) to either side of P.
float ball_reach(vec3 P, vec3 V, vec3 across, vec2 origin) {
    if (is_orthographic()) return length(across.xy * params.radius * frame.lens.xy);
    float distance = length(P), sine = params.radius / distance;
    if (sine >= 1.0) return 1e9;
    vec3 edge = sine * across - sqrt(1.0 - sine * sine) * V;
    return edge.z <= 1e-3 ? 1e9 : length(screen_of(edge) - origin);
}

// The line towards the other side.
Line reversed(Line l, vec3 P, vec3 V, vec3 across) {
    l.direction = -l.direction;
    l.border = leaves_frame(l.origin, l.direction);
    l.reach = ball_reach(P, V, -across, l.origin);
    return l;
}

Line line_of(vec3 P, vec3 V, vec3 across, vec2 origin) {
    Line l;
    l.origin = origin;
    l.direction = screen_direction(P, across);
    l.border = leaves_frame(origin, l.direction);
    l.reach = ball_reach(P, V, across, origin);
    return l;
}

// Distance of step i in pixels: at the squares of an even spacing, and at least a pixel beyond the step before.
float step_distance(int i, float jitter, float limit) {
    float u = (float(i) + jitter) / float(params.steps);
    return max(limit * u * u, float(i + 1));
}
