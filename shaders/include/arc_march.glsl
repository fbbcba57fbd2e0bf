// Walking outwards along one side of a slice: samples become runs, runs become blocked arcs (THEORY.md 3).
//
// A run is a piece of connected surface: either tangent plane predicts the other sample. It blocks the arc from its lowest share to
// its highest, its back included, which lies `thickness` behind its front on the view ray. The run that starts at the receiver
// itself blocks all between its highest point and the tangent.

// Without a radius a run is believed beyond the frame for this share of what is seen of it.
const float BELIEVED = 0.3;

struct Run {
    bool alive, own;  // own: begins at the receiver
    bool starts;      // begins at its own silhouette
    float low, high;  // shares of the parts inside the ball; low > high: none
    vec2 first, last; // ends, in the slice
    vec2 rim;         // the point of the highest share
    float last_share, last_distance;
    vec3 point, normal, light; // of the last sample
};

float thickness_of(Run r, bool ends, float step_size) {
    if (params.fixed_thickness == 1) return params.thickness;
    float own = params.kappa * (length(r.last - r.first) + step_size);
    return r.starts && ends ? own : max(own, params.thickness);
}

// Ends a run: all it blocks, as far as its samples have not done so already.
void finish(inout Sectors slots, Side s, Run r, bool ends, float step_size, float jitter) {
    float high = r.own ? 1.0 : max(r.high, share(s, r.rim + thickness_of(r, ends, step_size) * away(s, r.rim)));
    if (r.alive && r.low <= r.high) block(slots, sectors(r.low, high, jitter), r.light);
}

void include_share(inout Run r, float c, vec2 w) {
    r.low = min(r.low, c);
    if (c >= r.high) r.rim = w;
    r.high = max(r.high, c);
}

Sectors march(Side s, Line line, vec3 P, vec3 N, float step_jitter, float jitter) {
    Sectors slots = all_open();
    Run run = Run(true, true, false, 2.0, -1.0, vec2(0.0), vec2(0.0), vec2(0.0), 1.0, 0.0, P, N, vec3(0.0));
    float limit = min(line.reach, line.border), before = 0.0, step_size = 0.0;
    float R = params.radius;
    for (int i = 0; i < params.steps; i++) {
        float at = step_distance(i, step_jitter, limit);
        if (at > limit) break;
        ivec2 q = ivec2(floor(line.origin + at * line.direction));
        float depth = imageLoad(depth_image, q).r;
        bool surface = depth != 0.0;
        vec3 Q = position_of(q, depth), n = normal_at(q), gap = Q - run.point;
        float pixel = footprint(depth), room = params.tolerance * pixel * (at - before);
        bool joined = run.alive && surface && min(abs(dot(run.normal, gap)), abs(dot(n, gap))) < room;
#ifdef BOUNCE
        vec3 light = sent_by(q) * (dot(n, P - Q) > 0.0 ? 1.0 : 0.0);
#endif
        bool nearer = Q.z < run.point.z;
        vec2 w = in_slice(s, Q - P);
        float distance = length(Q - P), c = share(s, w);
        if (!joined) {
            finish(slots, s, run, !surface || !nearer, step_size, jitter);
            run.starts = !run.alive || nearer;
            run.alive = surface;
            run.own = false;
            run.low = 2.0;
            run.high = -1.0;
            run.first = w;
            if (distance < R) include_share(run, c, w);
        } else {
            bool was_inside = run.last_distance < R, is_inside = distance < R;
            if (was_inside || is_inside) {
                float f = clamp((R - run.last_distance) / (distance - run.last_distance), 0.0, 1.0);
                if (was_inside == is_inside) f = 1.0;
#ifdef BOUNCE
                block(slots, sectors(min(run.last_share, c), max(run.last_share, c), jitter), light);
#endif
                include_share(run, was_inside ? run.last_share : mix(run.last_share, c, f), was_inside ? run.last : mix(run.last, w, f));
                include_share(run, is_inside ? c : mix(run.last_share, c, f), is_inside ? w : mix(run.last, w, f));
            }
        }
        run.last = w;
        run.last_share = c;
        run.last_distance = distance;
        run.point = Q;
        run.normal = n;
#ifdef BOUNCE
        run.light = light;
#endif
        step_size = (at - before) * pixel;
        before = at;
    }
    // Beyond the frame the last run goes on along its own tangent.
    if (line.border < line.reach && run.alive && run.last_distance < R) {
        vec2 facing = normalize(vec2(dot(run.normal, s.tangent), dot(run.normal, s.up)) + vec2(0.0, 1e-20)), e = vec2(facing.y, -facing.x);
        vec2 ray = away(s, run.last);
        if (e.x * ray.y - e.y * ray.x > 0.0) e = -e; // outwards: away from the view ray, clockwise from V
        float b = dot(run.last, e);
        float to_ball = sqrt(max(b * b + R * R - run.last_distance * run.last_distance, 0.0)) - b;
        vec2 end = run.last + e * (R < UNLIMITED ? to_ball : min(to_ball, BELIEVED * length(run.last - run.first)));
        include_share(run, share(s, end), end);
    }
    finish(slots, s, run, false, step_size, jitter);
    return slots;
}
