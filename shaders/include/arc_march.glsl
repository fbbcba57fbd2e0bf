// Walking outwards along one side of a slice: samples become runs, runs become blocked arcs (README, Runs).
//
// A run is a piece of connected surface: of two neighbouring samples, the tangent plane of one predicts the other. A run blocks the arc
// from its lowest share to its highest. Its back counts too; it lies `thickness` behind the front on the view ray. The run that starts at
// the receiver blocks everything between its highest point and the tangent, so its highest share is 1 from the start.

#ifdef BOUNCE
#include "include/arc_unseen.glsl"
UPICTURE(rgba32ui, surface_image); // senders.comp
#else
UPICTURE(rg32ui, surface_image); // surface.comp
#endif

// In a march without a radius, the last run goes on beyond the frame for this multiple of the length that is seen of it. Ground that no
// plane holds gets the second value: it sends light from wherever its tangent leads.
const float BELIEVED = 0.3;
#ifdef SUNS
const float BELIEVED_BENT = BELIEVED;
const int BACKS = 4; // depths that are tried for a back: each serves every fourth sector
#else
const float BELIEVED_BENT = 30.0;
#endif

// The hidden back of a surface sends this share of the light that its front sends.
const float HIDDEN = 0.5;

struct Run {
    bool alive, starts; // starts: begins at its own silhouette
    float low, high;    // shares of the parts inside the ball; low > high: none
    float width;        // of what is seen, times kappa
    vec2 first, last;   // ends, in the slice
    vec2 rim;           // the point of the highest share
    float rim_inverse;  // 1 / its distance from the eye
    float last_share, last_squared, facing; // of the last sample: share, squared distance, cosine towards the receiver
    vec3 point, normal, light; // of the last sample
#ifdef OUTSIDE
    float rim_depth, rim_share, seen_depth; // of the opening that the last sample shows (depth 0: none), and of what is seen through it
#endif
};

// What a march needs of its line and of the frame.
struct Walk {
    Line line;
    float limit;  // where it ends, in pixels
    float jitter; // of the sectors
    float squared_radius, pixel;
};

// Ends a run: blocks what it blocks and its samples have not blocked yet.
void finish(inout Sectors sectors, Side s, Walk k, Run r, bool ends, bool now) {
    float thickness = max(r.width, r.starts && ends ? params.thin : params.thickness);
#ifdef SUNS
    // A sharp shadow ends where the back is, and the depth of the back is a guess. Every depth up to twice the guess is taken to be equally
    // likely, so each gets a share of the sectors. A thickness that the user gave is no guess.
    uvec2 mask = uvec2(0u);
    for (int i = 0; i < BACKS; i++) {
        float depth = thickness * (params.kappa == 0.0 ? 1.0 : float(2 * i + 1) / float(BACKS));
        float back = share(s, r.rim + depth * away(s, r.rim, r.rim_inverse));
        mask |= sectors_between(r.low, max(r.high, back), k.jitter) & (0x11111111u << uint(i));
    }
#else
    float back = share(s, r.rim + thickness * away(s, r.rim, r.rim_inverse));
    uvec2 mask = sectors_between(r.low, max(r.high, back), k.jitter);
#endif
#ifdef OUTSIDE
    mask &= sectors_between(r.low, r.high, k.jitter) | ~sectors.seen; // what has left through an opening is past the backs of its frame
#endif
    block(sectors, now && r.alive && r.low <= r.high ? mask : uvec2(0u), HIDDEN * r.light);
}

#ifdef OUTSIDE
PICTURE(r32f, rim_image); // where the outdoors are seen, the depth of the opening (src/passes/openings.h); else 0

// A pixel that shows the outdoors shows that its view ray is empty from the opening to the surface it sees, or to infinity. Directions
// that meet this part of the ray are outdoors there, so nothing unseen blocks them: an arc. The further out a ray, the lower its arc, and
// the directions between two rays of one opening are outdoors too. The opening ends halfway between a sample that shows it and one that
// does not.
void see(inout Sectors sectors, inout Run run, Side s, Walk k, vec3 P, ivec2 q, float depth, float at, float before) {
    float rim = FETCH_INSIDE(rim_image, q, vec4(0.0)).r;
    bool here = rim > 0.0, there = run.rim_depth > 0.0;
    vec2 screen = k.line.origin + (here && there ? at : 0.5 * (before + at)) * k.line.direction;
    float last = here ? depth : run.seen_depth, opening = here ? rim : run.rim_depth;
    vec3 infinity = is_orthographic() ? vec3(0.0, 0.0, 1.0) : ray_at(screen), end = last > 0.0 ? position_at(screen, last) - P : infinity;
    float far = share(s, in_slice(s, end)), near = share(s, in_slice(s, position_at(screen, opening) - P));
    sectors.seen |= here || there ? sectors_between(near, there ? max(far, run.rim_share) : far, k.jitter) : uvec2(0u);
    run.rim_depth = rim;
    run.rim_share = near;
    run.seen_depth = depth;
}
#endif

// Takes the sample at distance `at`; the sample before lies at `before`.
void visit(inout Sectors sectors, inout Run run, Side s, Walk k, vec3 P, float at, float before) {
    ivec2 q = ivec2(k.line.origin + at * k.line.direction);
    uvec4 stored_texel = FETCH_INSIDE(surface_image, q, uvec4(0u));
    float depth = uintBitsToFloat(stored_texel.x), scale = is_orthographic() ? 1.0 : depth;
    bool surface = depth != 0.0;
    vec3 Q = position_of(q, depth), n = unpack_normal(stored_texel.y), gap = Q - run.point, to = Q - P;
    float step_size = scale * k.pixel * (at - before);
    vec2 before_plane = vec2(dot(run.normal, gap), -dot(n, gap)), off = abs(before_plane); // the one point before the other's plane
    float most_off = params.tolerance * step_size;
    bool joined = run.alive && surface && min(off.x, off.y) <= most_off;
    bool nearer = gap.z < 0.0;
#ifdef BOUNCE
    float facing = dot(n, to) * inversesqrt(max(dot(to, to), 1e-30));
    vec3 light = sent_by(stored_texel.zw, facing < 0.0);
    // What joins two samples is seen on the one that faces the receiver more: the other may be its own ground, edge-on, far behind.
    // If each sample lies before the other's plane, or each behind it, the planes cross between them: an edge or a crease. If one lies
    // before and one behind, the nearer surface stands free, and a march that steps onto it meets its hidden side.
    bool stands_free = before_plane.x * before_plane.y < 0.0 && max(off.x, off.y) > most_off;
    vec3 between = stands_free && nearer ? sent_by(stored_texel.zw, false) : abs(facing) >= run.facing ? light : run.light;
#endif
    finish(sectors, s, k, run, !surface || !nearer, !joined);
    vec2 w = in_slice(s, to), w_in = w;
    bool counts = true;
#ifdef LIMITED
    // Only the part of a run inside the ball counts: a run that leaves the ball is clipped there.
    float squared = dot(to, to);
    bool inside = squared < k.squared_radius, leaves = joined && run.last_squared < k.squared_radius;
    w_in = inside ? w : mix(run.last, w, (k.squared_radius - run.last_squared) / (squared - run.last_squared));
    counts = inside || leaves;
#ifdef EVIDENCE
    bool crosses = joined && run.last_squared < k.squared_radius;
#endif
    run.last_squared = squared;
#endif
    float c = share(s, w_in);
#ifdef EVIDENCE
    sectors.met |= crosses ? sectors_between(min(run.last_share, c), max(run.last_share, c), k.jitter) : uvec2(0u);
    sectors.unseen |= surface ? beyond_on_ray(s, w, away(s, w, inversesqrt(dot(Q, Q))), k.squared_radius, k.jitter) : uvec2(0u);
    run.last_share = c;
#endif
#ifdef BOUNCE
    block(sectors, joined ? sectors_between(min(run.last_share, c), max(run.last_share, c), k.jitter) : uvec2(0u), between);
    run.last_share = c;
    run.light = light;
    run.facing = abs(facing);
#endif
    float low = joined ? run.low : 2.0, high = joined ? run.high : -1.0;
    bool rises = counts && c >= high;
    run.starts = joined ? run.starts : !run.alive || nearer;
    run.first = joined ? run.first : w;
    run.rim = rises ? w_in : run.rim;
    run.rim_inverse = rises ? inversesqrt(dot(Q, Q)) : run.rim_inverse;
    run.low = counts ? min(low, c) : low;
    run.high = counts ? max(high, c) : high;
    run.width = params.kappa * (length(w - run.first) + step_size);
#ifdef OUTSIDE
    see(sectors, run, s, k, P, q, depth, at, before);
#endif
    run.alive = surface;
    run.last = w;
    run.point = Q;
    run.normal = n;
}

// Beyond the frame the last run goes on along its own tangent.
void go_on(inout Sectors sectors, inout Run run, Side s, Walk k, float at) {
    ivec2 q = ivec2(k.line.origin + at * k.line.direction);
    vec3 n = normal_at(q);
    bool on_plane = (FETCH_INSIDE(surface_image, q, uvec4(0u)).y >> 31u) == 1u;
    vec2 facing = vec2(dot(n, s.tangent), dot(n, s.up)) + vec2(0.0, 1e-20);
    vec2 e = vec2(facing.y, -facing.x) * inversesqrt(dot(facing, facing)), ray = away(s, run.last, 1.0);
    if (e.x * ray.y - e.y * ray.x > 0.0) e = -e; // outwards: away from the view ray, clockwise from V
#ifdef LIMITED
    float b = dot(run.last, e);
    vec2 end = run.last + e * (sqrt(max(b * b + k.squared_radius - run.last_squared, 0.0)) - b);
    bool counts = k.line.border < k.line.reach && run.alive && run.last_squared < k.squared_radius;
#else
    vec2 end = run.last + e * ((on_plane ? BELIEVED : BELIEVED_BENT) * length(run.last - run.first));
    bool counts = run.alive && k.line.border <= k.line.reach;
#endif
    float c = share(s, end);
    bool rises = counts && c >= run.high;
    vec2 from_eye = end - s.eye;
    run.rim = rises ? end : run.rim;
    run.rim_inverse = rises ? inversesqrt(dot(from_eye, from_eye)) : run.rim_inverse;
    run.low = counts ? min(run.low, c) : run.low;
    run.high = counts ? max(run.high, c) : run.high;
#ifdef BOUNCE
    // Nothing says that the run ends or is hidden there, so this part sends the same light as the part that is seen. Planes often do end.
    block(sectors, counts && !on_plane ? sectors_between(run.low, run.high, k.jitter) : uvec2(0u), run.light);
#endif
}

void march(inout Sectors sectors, Side s, Line line, vec3 P, vec3 N, float step_jitter, float jitter) {
    Run run = Run(true, false, 2.0, 1.0, 0.0, vec2(0.0), vec2(0.0), vec2(0.0), 0.0, 1.0, 0.0, 0.0, P, N, vec3(0.0)
#ifdef OUTSIDE
                  , 0.0, 0.0, 0.0
#endif
                  );
    Walk k = Walk(line, min(line.reach, line.border), jitter, params.radius * params.radius, footprint(1.0));
    float before = 0.0, last = last_step(line);
    for (int i = 0; i < params.steps; i++) {
        float at = step_distance(i, step_jitter, k.limit);
        if (at > last) break;
        visit(sectors, run, s, k, P, at, before);
        before = at;
    }
#ifdef EVIDENCE
    sectors.unseen |= beyond_frame(s, line, P, jitter);
#endif
    go_on(sectors, run, s, k, before);
    finish(sectors, s, k, run, false, true);
}
