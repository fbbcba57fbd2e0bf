#version 450 core
// How much of a pixel's surroundings is recorded: the cosine-weighted share of the directions, within the radius, that the picture decides
// (include/evidence.glsl). With the weight w of a slice, and sums over slices:
//   confidence = sum w (decided share) / sum w
#define LIMITED
#define RUNS
#define EVIDENCE
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/arc_slices.glsl"

layout(r32f) writeonly uniform image2D confidence_image;

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    Receiver here = receiver_at(p);
    if (here.depth == 0.0) return;
    Centre centre = centre_of(here, p);
    vec2 sums = vec2(0.0); // w (decided share), w
    for (int i = 0; i < params.slices; i++) {
        Slice s = march_slice(centre, i);
        sums += s.weight * vec2(1.0 - sector_share(guessed_sectors(s.sectors)), 1.0);
    }
    imageStore(confidence_image, p, vec4(ratio(sums.x, sums.y)));
}
