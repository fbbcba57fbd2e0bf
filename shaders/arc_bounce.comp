#version 450 core
// One bounce by slices around the view vector (README, Slices and sectors). With the weight w of a slice, and sums over slices:
//   indirect = sum w (blocked share x light that the nearest blocker sends) / sum w
// With EXITANT the sender image is a picture that the renderer lit. Without, it is light before albedo (senders.comp multiplies them).
// Light comes from any distance, so the march has no radius. OUTSIDE: not all directions that leave the frame are open, and what closes
// the others sends light too (include/outside.glsl); SURROUND: further G-buffers say which. PLANES, RECEIVERS and LONE:
// include/arc_slices.glsl.
#define RUNS
#define BOUNCE
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/environment.glsl"
#include "include/arc_slices.glsl"
#include "include/arc_bounce.glsl"
#ifdef SURROUND
#include "include/outlook.glsl"
#endif

void main() {
    ivec2 p;
    if (!receiver_pixel(p)) return;
    Receiver here = receiver_at(p);
    vec3 bounced = vec3(0.0);
    float all = 1.0;
    if (here.depth != 0.0) {
        Centre centre = centre_of(here, p);
        guess_light(here);
        all = 0.0;
        for (int i = 0; i < params.slices; i++) {
            Slice s = march_slice(centre, i);
            all += s.weight;
            add_bounce(bounced, centre, s);
#ifdef SURROUND
            bounced += s.weight * look_outside(centre, s).sent;
#endif
        }
    }
    imageStore(indirect_image, p, vec4(params.strength * bounced / all, 0.0));
}
