// Light that surfaces send to the receiver. That of a side that the camera does not see is a guess.
#include "include/senders.glsl"

vec3 unseen = vec3(0.0); // of such a side, in the side of the slice that is marched; before albedo if not EXITANT

#ifdef EXITANT
// It faces the receiver and sees much the same surroundings, so it sends this share of what the receiver sends.
const float UNSEEN = 0.4;
#else
// It gets the light of its own direction: of the environment that planes leave (src/passes/hidden.h), of that the share that reaches the
// receiver, too, and of that this share, since the blocker's own surroundings are nearer to it.
const float UNSEEN = 0.8;
float received_share = 1.0;
#endif

// Once for all slices. own: what the sender image holds of the receiver.
void guess_of_receiver(vec3 own, vec3 N) {
#ifdef EXITANT
    unseen = UNSEEN * own;
#else
    float all = dot(sh_irradiance_over_pi(arc_block.hidden, to_map(N)), LUMINANCE);
    received_share = all > 0.0 ? min(dot(own, LUMINANCE) / all, 1.0) : 1.0;
#endif
}

// For each side of a slice. The hidden side of what blocks there faces the receiver.
void guess_of_side(vec3 outwards) {
#ifndef EXITANT
    unseen = UNSEEN * received_share * sh_irradiance_over_pi(arc_block.hidden, to_map(-outwards));
#endif
}

// `seen`: the receiver sees the side that the camera sees.
vec3 sent_by(uvec2 sender, bool seen) {
#ifdef EXITANT
    return seen ? sender_light(sender) : unseen;
#else
    return seen ? sender_light(sender) : unseen * sender_albedo(sender);
#endif
}
