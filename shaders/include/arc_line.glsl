// The screen line of a slice, and where its steps fall.

struct Line {
    vec2 origin;    // centre of the receiver's pixel
    vec2 direction; // unit, in pixels
    float border;   // distance at which the line leaves the frame
    float reach;    // distance beyond which no view ray meets the ball of radius R
};

const float NO_REACH = 1e9;

// Both halves of the line of a slice. With V' = -V, a direction V' + tan(a) across appears at the distance
// tan(a) |J| / (V'_z (V'_z + tan(a) across_z)) from P's pixel, J the derivative of the projection. The slice cuts the ball in a
// circle that reaches asin(R / |P|) to either side of P; `tangent` is the tangent of that angle, negative if the eye is in the ball.
struct Lines { Line right, left; };

Lines lines_of(vec3 V, vec3 across, vec2 origin, float tangent) {
    vec2 derivative = (is_orthographic() ? across.xy : across.xy * V.z - V.xy * across.z) * frame_lens.xy;
    float size = inversesqrt(max(dot(derivative, derivative), 1e-30));
    vec2 direction = derivative * size * (is_orthographic() ? 1.0 : -1.0);
    vec2 here = origin, there = vec2(frame_size) - origin, inverse = 1.0 / max(abs(direction), vec2(1e-6));
    bvec2 up = greaterThan(direction, vec2(0.0));
    vec2 ahead = mix(here, there, up) * inverse, behind = mix(there, here, up) * inverse;
    Line right = Line(origin, direction, min(ahead.x, ahead.y) - 1e-3, NO_REACH);
    Line left = Line(origin, -direction, min(behind.x, behind.y) - 1e-3, NO_REACH);
#ifdef LIMITED
    if (is_orthographic()) {
        right.reach = left.reach = params.radius / size;
    } else {
        float numerator = tangent / (size * -V.z), towards = -V.z + tangent * across.z, from = -V.z - tangent * across.z;
        if (tangent >= 0.0 && towards > 1e-3) right.reach = numerator / towards;
        if (tangent >= 0.0 && from > 1e-3) left.reach = numerator / from;
    }
#endif
    return Lines(right, left);
}

// No step lies beyond this. The reach is a quotient, and drivers divide with errors of up to 2.5 units in the last place (GLSL 4.50,
// 4.7.1). Under an orthographic camera a step can lie at the reach itself. The margin makes every driver take that step.
float last_step(Line line) { return min(line.reach * (1.0 + 4.0 * ULP), line.border); }

float ball_tangent(vec3 P) {
    float squared = dot(P, P) - params.radius * params.radius;
    return squared > 0.0 ? params.radius * inversesqrt(squared) : -1.0;
}

// Distance of step i in pixels. Each step is at least a pixel beyond the one before. The rest of the line is divided by squares of an
// even spacing, so steps are dense near the receiver.
float step_distance(int i, float jitter, float limit) {
    float u = (float(i) + jitter) * params.inverse_steps;
    return float(i + 1) + max(0.0, limit - float(params.steps)) * u * u;
}
