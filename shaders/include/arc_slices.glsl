// The slices around a receiver's view vector: each is marched on both sides, and what it meets there blocks its sectors.
// RUNS (arc), HORIZON (gtao) or BITMASK (bitmask) says what blocks a sector; PLANES adds planes to RUNS. EVIDENCE tells
// what is known from what is guessed, and FURTHER asks further G-buffers about the latter.

#if defined(FURTHER) && !defined(EVIDENCE)
#define EVIDENCE
#endif
#if defined(SURROUND) && !defined(OUTSIDE)
#define OUTSIDE
#endif

#include "include/arc_params.glsl"
#include "include/arc_receiver.glsl"
#include "include/arc_slice.glsl"
#include "include/arc_line.glsl"
#include "include/arc_sectors.glsl"
#ifdef OUTSIDE
#include "include/outside.glsl"
#endif
#ifdef EVIDENCE
#include "include/evidence.glsl"
#endif
#ifdef RUNS
#include "include/arc_march.glsl"
#else
#include "include/arc_taps.glsl"
#endif
#ifdef PLANES
#include "include/arc_planes.glsl"
#endif
#ifdef FURTHER
#include "include/further.glsl"
#endif

// What all slices of a receiver share.
struct Centre {
    vec2 origin;     // on the frame, in pixels
    vec3 P, N, V;
    mat3 around;     // two tangents of V, and V
    float eye_distance;
    float tangent;   // ball_tangent
#ifdef PLANES
    uint planes;     // planes_around
#endif
#ifdef FURTHER
    uint views;      // views_around
#endif
    vec3 turn;       // the pixel's noise: for the angle of the slices, the places of the steps and of the sectors
};

Centre centre_of(Receiver here, ivec2 p) {
    Centre c;
    c.origin = here.origin;
    c.P = position_at(here.origin, here.depth);
    c.N = here.N;
    c.V = view_of(c.P);
    c.around = tangent_frame(c.V);
    c.eye_distance = length(c.P);
    c.tangent = ball_tangent(c.P);
#ifdef PLANES
    c.planes = planes_around(c.P, c.N);
#endif
#ifdef FURTHER
    c.views = views_around(c.P);
#endif
    c.turn = pixel_noise(p, params.seed);
    return c;
}

struct Slice {
    vec3 across; // the slice is the plane of V and this tangent
    Lines lines;
    Side side;    // the side towards `across`; sectors are counted from the end of the other side
    float n;      // angle of the projected normal
    float weight; // |n_p| (cos n + n sin n)
    vec2 noise;   // for the places of the steps and of the sectors
    Sectors sectors;
};

// From slice to slice the noise moves on by these: 1 / golden ratio, and 1 / plastic number, the same for two dimensions.
const vec2 NOISE_STEP = vec2(0.6180340, 0.7548777);

Slice march_slice(Centre c, int i) {
    Slice s;
    float phi = PI * (float(i) + c.turn.x) / float(params.slices);
    s.noise = fract(c.turn.yz + float(i) * NOISE_STEP);
    s.across = cos(phi) * c.around[0] + sin(phi) * c.around[1];
    s.lines = lines_of(c.V, s.across, c.origin, c.tangent);
    s.side = opposite(side_of(c.V, s.across, c.N, c.eye_distance, s.n, s.weight), s.n);
    s.sectors = all_open();
    Line line = s.lines.left;
    // The far side first. There sectors are counted from the other end. One loop, so that the march is compiled once.
    for (int k = 0; k < 2; k++) {
#ifdef BOUNCE
        guess_of_side(s.side.tangent);
#endif
        march(s.sectors, s.side, line, c.P, c.N, k == 0 ? 1.0 - s.noise.x : s.noise.x, k == 0 ? 1.0 - s.noise.y : s.noise.y);
        if (k == 0) {
            s.sectors = counted_from_the_other_end(s.sectors);
            s.side = opposite(s.side, -s.n);
            line = s.lines.right;
        }
    }
#ifdef PLANES
    block_by_planes(s.sectors, s.side, c.V, s.across, s.n, s.lines, c.P, c.planes, s.noise.x, s.noise.y);
#endif
#ifdef FURTHER
    decide_by_views(s.sectors, s.side, c.V, s.across, s.n, c.P, c.views, s.noise.x, s.noise.y);
#endif
    return s;
}
