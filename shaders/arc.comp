#version 450 core
// Slices around the view vector, each a set of 64 sectors of equal cosine weight (README, Runs). With the weight of a slice
// w = |n_p| (cos n + n sin n), and sums over slices:
//   occlusion = sum w (open share) / sum w                          so that an empty plane is exactly 1
//   BENT:   bent = 2/3 N - sum w (blocked directions) / sum w        the cosine-weighted mean open direction: N on an empty plane
//   LIGHT:  radiance = sum w (open share x environment) / sum w,  visibility = its luminance over that of the open sky
//   HALF_DIFFERENCE: how much the second half of the slices (every other one) moved the occlusion
//   ROUND:  adds to the sums of the earlier rounds. A later round has as many slices as all rounds before it, and they lie halfway
//           between those, so that all slices together are evenly spaced
//   BOUNCE: indirect = sum w (blocked share x light that the nearest blocker sends) / sum w. With EXITANT the sender image is a picture
//           that the renderer lit. Without, it is light before albedo (senders.comp multiplies them)
// OUTSIDE: not all directions that leave the frame are open (include/outside.glsl); SURROUND: further G-buffers say which
// RECEIVERS: the pixels are those of a frame of half the size (src/gbuffer/half.h); what they see is the whole frame.
// LONE: the pixels are those of a list.
// HORIZON (gtao), BITMASK (bitmask) or RUNS (arc) says what blocks the sectors; PLANES adds planes to RUNS.
#if !defined(LIGHT) && !defined(BOUNCE)
#define LIMITED // to the radius; light comes from any distance
#endif
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/environment.glsl"
#include "include/arc_params.glsl"
#include "include/arc_slice.glsl"
#include "include/arc_line.glsl"
#include "include/arc_sectors.glsl"
#include "include/outside.glsl"

#if defined(VISIBILITY) || !(defined(LIGHT) || defined(BOUNCE))
#define SCALAR
layout(r32f) writeonly uniform image2D scalar_image; // occlusion, or with LIGHT the visibility
#endif
#if defined(LIGHT) || defined(BENT)
layout(rgba32f) writeonly uniform image2D light_image; // radiance or bent
#endif
#ifdef BOUNCE
#include "include/senders.glsl"
PICTURE(rgba32f, sender_image); // at the receiver
layout(rgba32f) writeonly uniform image2D indirect_image;
#ifdef OUTSIDE
PICTURE(rgba32f, outside_image); // one texel: what surfaces outside the frame send
#endif
#endif
#ifdef HALF_DIFFERENCE
layout(r32f) writeonly uniform image2D half_difference_image; // of the occlusion, by half of the slices
#endif
#ifdef ROUND
layout(rg32f) uniform image2D sums_image; // of earlier rounds: sum w (open share), sum w
#endif

struct Receiver {
    vec2 origin; // where it appears on the frame that it sees, in pixels
    ivec2 pixel; // of that frame, on its surface
    float depth;
    vec3 N;
};
#ifdef RECEIVERS
PICTURE(r32f, receiver_depth);
PICTURE(rgba32f, receiver_normal);
Receiver receiver_at(ivec2 p) {
    vec4 normal = FETCH(receiver_normal, p);
    int chosen = int(normal.w);
    ivec2 q = 2 * p + ivec2(chosen & 1, (chosen >> 1) & 1);
    return Receiver(chosen < 4 ? 2.0 * vec2(p) + 1.0 : vec2(q) + 0.5, q, FETCH(receiver_depth, p).r, normal.xyz);
}
#else
Receiver receiver_at(ivec2 p) { return Receiver(vec2(p) + 0.5, p, depth_at(p), normal_at(p)); }
#endif

// Light that a surface sends to the receiver. The camera does not see its back, so the light of a back is a guess: it faces the
// receiver and sees much the same surroundings, so it gets this share of the receiver's own light.
const float UNSEEN = 0.4;
vec3 unseen = vec3(0.0);

#ifdef BOUNCE
vec3 sent_by(uvec2 stored, bool seen) {
#ifdef EXITANT
    return seen ? sender_light(stored) : unseen;
#else
    return seen ? sender_light(stored) : unseen * sender_albedo(stored);
#endif
}
#endif

#ifdef RUNS
#include "include/arc_march.glsl"
#else
#include "include/arc_taps.glsl"
#endif
#ifdef PLANES
#include "include/arc_planes.glsl"
#endif
#ifdef LIGHT
#include "include/arc_light.glsl"
#endif
#ifdef BENT
#include "include/arc_bent.glsl"
#endif

void store(ivec2 p, float scalar, vec3 light, vec3 indirect) {
#if defined(LIGHT) || defined(BENT)
    imageStore(light_image, p, vec4(light, 0.0));
#endif
#ifdef BOUNCE
    imageStore(indirect_image, p, vec4(indirect, 0.0));
#endif
#ifdef SCALAR
    imageStore(scalar_image, p, vec4(scalar));
#endif
}

#ifdef LONE // tile: x the first of the list's pixels, y their end
layout(std430) readonly buffer Lone { uint lone[]; };
#endif

void main() {
#ifdef LONE
    uint item = uint(tile.x) + gl_WorkGroupID.x * (GROUP_SIDE * GROUP_SIDE) + gl_LocalInvocationIndex;
    if (item >= uint(tile.y)) return;
    ivec2 p = ivec2(lone[item] & 0xffffu, lone[item] >> 16u);
#else
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
#endif
    Receiver here = receiver_at(p);
    if (here.depth == 0.0) {
        store(p, 1.0, vec3(0.0), vec3(0.0));
#ifdef HALF_DIFFERENCE
        imageStore(half_difference_image, p, vec4(0.0));
#endif
        return;
    }
    vec2 origin = here.origin;
    vec3 P = position_at(origin, here.depth), N = here.N, V = view_of(P);
    mat3 around = tangent_frame(V);
    float eye_distance = length(P), open = 0.0, all = 0.0, first_open = 0.0, first_all = 0.0;
    float tangent = ball_tangent(P);
    vec3 turn = pixel_noise(p, params.seed);
#ifdef ROUND
    // The first round's two slices lie at (i + turn.x) / 2 of half a turn. Each later round shifts its slices by half a step, so that
    // they fall between the slices there are.
    if (params.before > 0) turn.x = fract(0.5 * float(params.before) * turn.x + 0.5);
    turn.yz = fract(turn.yz + float(params.before) * vec2(0.6180340, 0.7548777));
#endif
#ifdef LIGHT
    Light light = Light(vec3(0.0), 0.0, 0.0);
#endif
    vec3 bounced = vec3(0.0);
#ifdef BOUNCE
    unseen = UNSEEN * FETCH(sender_image, here.pixel).rgb;
#ifdef OUTSIDE
    vec3 outside_light = FETCH(outside_image, ivec2(0)).rgb;
#endif
#endif
#ifdef BENT
    vec3 shut = vec3(0.0);
#endif
#ifdef ROUND
    if (params.before > 0) {
        vec2 sums = imageLoad(sums_image, p).xy;
        first_open = open = sums.x;
        first_all = all = sums.y;
    }
#endif
    for (int i = 0; i < params.slices; i++) {
        float phi = PI * (float(i) + turn.x) / float(params.slices);
        vec2 noise = fract(turn.yz + float(i) * vec2(0.6180340, 0.7548777));
        vec3 across = cos(phi) * around[0] + sin(phi) * around[1];
        Lines lines = lines_of(V, across, origin, tangent);
        float n, weight;
        Side side = opposite(side_of(V, across, N, eye_distance, n, weight), n);
        Line line = lines.left;
        Sectors slots = all_open();
        // Both sides of the slice, the near one last. On the far side sectors are counted from the other end.
        for (int k = 0; k < 2; k++) {
            march(slots, side, line, P, N, k == 0 ? 1.0 - noise.x : noise.x, k == 0 ? 1.0 - noise.y : noise.y);
            if (k == 0) {
                slots.blocked = bitfieldReverse(slots.blocked.yx);
#ifdef OUTSIDE
                slots.seen = bitfieldReverse(slots.seen.yx);
#endif
                side = opposite(side, -n);
                line = lines.right;
            }
        }
#ifdef PLANES
        block_by_planes(slots, side, V, across, n, lines, P, noise.x, noise.y);
#endif
        Exits exits = exits_of(P, V, lines);
        open += weight * (1.0 - sector_share(slots.blocked));
        all += weight;
#ifdef HALF_DIFFERENCE
        bool first = (i & 1) == 0 && params.before == 0;
        first_open += first ? weight * (1.0 - sector_share(slots.blocked)) : 0.0;
        first_all += first ? weight : 0.0;
#endif
#ifdef LIGHT
        add_sky(light, side, V, across, n, weight, slots, noise.y, exits);
#endif
#ifdef BOUNCE
        bounced += weight * slots.light;
#ifdef OUTSIDE
        bounced += weight * closed_share(side, V, across, n, slots, noise.y, exits) * outside_light;
#endif
#endif
#ifdef BENT
        shut += weight * blocked_moment(side, V, across, n, slots.blocked, noise.y);
#endif
    }
    bounced = params.strength * bounced / all;
#if defined(LIGHT)
    light.open /= all;
    light.open_luminance /= all;
    light.all_luminance /= all;
    store(p, light.all_luminance > 0.0 ? min(1.0, ratio(light.open_luminance, light.all_luminance)) : 1.0, light.open, bounced);
#elif defined(BENT)
    store(p, ratio(open, all), 2.0 / 3.0 * N - shut / all, bounced);
#else
    store(p, ratio(open, all), vec3(0.0), bounced);
#endif
#ifdef ROUND
    imageStore(sums_image, p, vec4(open, all, 0.0, 0.0));
#endif
#ifdef HALF_DIFFERENCE
    imageStore(half_difference_image, p, vec4(ratio(open, all) - ratio(first_open, first_all)));
#endif
}
