#version 450 core
// Occlusion by slices around the view vector, each a set of 64 sectors of equal cosine weight (README, Slices and sectors). With the
// weight of a slice w = |n_p| (cos n + n sin n), and sums over slices:
//   occlusion = sum w (open share) / sum w                    so that an empty plane is exactly 1
//   BENT: bent = 2/3 N - sum w (blocked directions) / sum w   the cosine-weighted mean open direction: N on an empty plane
//   HALF_DIFFERENCE: how much the second half of the slices (every other one) moved the occlusion
//   ROUND: adds to the sums of the earlier rounds. A later round has as many slices as all rounds before it, and they lie halfway
//          between those, so that all slices together are evenly spaced
// RUNS (arc), HORIZON (gtao) or BITMASK (bitmask) says what blocks the sectors; PLANES adds planes to RUNS.
#define LIMITED // to the radius
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/arc_slices.glsl"

layout(r32f) writeonly uniform image2D occlusion_image;
#ifdef BENT
layout(rgba32f) writeonly uniform image2D bent_image;
#endif
#ifdef HALF_DIFFERENCE
layout(r32f) writeonly uniform image2D half_difference_image; // of the occlusion, by half of the slices
#endif
#ifdef ROUND
layout(rg32f) uniform image2D sums_image; // of earlier rounds: sum w (open share), sum w
#endif

#ifdef BENT
// Sum of the directions of a slice's blocked sectors, each weighted by its share. The slice is divided into cells of equal angle; the
// middle of a cell stands for all its directions.
vec3 blocked_moment(Centre o, Slice s) {
    const int CELLS_OF_BENT = 24;
    vec3 sum = vec3(0.0);
    if (s.sectors.blocked == uvec2(0u)) return sum;
    float from = s.n - 0.5 * PI, width = PI / float(CELLS_OF_BENT), c = 0.0;
    for (int i = 0; i < CELLS_OF_BENT; i++) {
        float t0 = from + float(i) * width, t = t0 + 0.5 * width, next = i + 1 == CELLS_OF_BENT ? 1.0 : share_at(s.side, t0 + width);
        sum += sector_share(sectors_between(c, next, s.noise.y) & s.sectors.blocked) * (cos(t) * o.V + sin(t) * s.across);
        c = next;
    }
    return sum;
}
#endif

#ifdef ROUND
// The first round's two slices lie at (i + turn.x) / 2 of half a turn. Each later round shifts its slices by half a step, so that they
// fall between the slices there are.
vec3 turn_of_round(vec3 turn) {
    if (params.before > 0) turn.x = fract(0.5 * float(params.before) * turn.x + 0.5);
    turn.yz = fract(turn.yz + float(params.before) * NOISE_STEP);
    return turn;
}
#endif

void store(ivec2 p, float occlusion, vec3 bent, float half_difference) {
    imageStore(occlusion_image, p, vec4(occlusion));
#ifdef BENT
    imageStore(bent_image, p, vec4(bent, 0.0));
#endif
#ifdef HALF_DIFFERENCE
    imageStore(half_difference_image, p, vec4(half_difference));
#endif
}

void main() {
    ivec2 p;
    if (!receiver_pixel(p)) return;
    Receiver here = receiver_at(p);
    if (here.depth == 0.0) {
        store(p, 1.0, vec3(0.0), 0.0);
        return;
    }
    Centre centre = centre_of(here, p);
    vec2 sums = vec2(0.0), first = vec2(0.0); // w (open share), w; first: of the first half of the slices
    vec3 shut = vec3(0.0);
#ifdef ROUND
    centre.turn = turn_of_round(centre.turn);
    if (params.before > 0) first = sums = LOAD(sums_image, p).xy;
#endif
    for (int i = 0; i < params.slices; i++) {
        Slice s = march_slice(centre, i);
        vec2 part = s.weight * vec2(1.0 - sector_share(s.sectors.blocked), 1.0);
        sums += part;
        first += (i & 1) == 0 && params.before == 0 ? part : vec2(0.0);
#ifdef BENT
        shut += s.weight * blocked_moment(centre, s);
#endif
    }
    float occlusion = ratio(sums.x, sums.y);
    store(p, occlusion, 2.0 / 3.0 * centre.N - shut / sums.y, occlusion - ratio(first.x, first.y));
#ifdef ROUND
    imageStore(sums_image, p, vec4(sums, 0.0, 0.0));
#endif
}
