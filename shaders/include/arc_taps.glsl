// The march of the older methods, sample by sample: the horizon (all beyond the highest sample is blocked) and the bitmask (each
// sample blocks from its front to `thickness` behind it on its view ray).
void march(inout Sectors sectors, Side s, Line line, vec3 P, vec3 N, float step_jitter, float jitter) {
    float limit = min(line.reach, line.border), last = last_step(line), lowest = 1.0;
    for (int i = 0; i < params.steps; i++) {
        float at = step_distance(i, step_jitter, limit);
        if (at > last) break;
        ivec2 q = ivec2(floor(line.origin + at * line.direction));
        float depth = FETCH_INSIDE(depth_image, q, vec4(0.0)).r;
        vec3 to = position_of(q, depth) - P;
        bool counts = depth != 0.0 && dot(to, to) < params.radius * params.radius;
        vec2 w = in_slice(s, to);
        float front = share(s, w);
#ifdef HORIZON
        if (counts) lowest = min(lowest, front);
#else
        if (counts) sectors.blocked |= sectors_between(front, share(s, w + params.thickness * away(s, w, 1.0 / length(w - s.eye))), jitter);
#endif
    }
#ifdef HORIZON
    sectors.blocked |= sectors_between(lowest, 1.0, jitter);
#endif
}
