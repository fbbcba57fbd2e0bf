#version 450 core
// Depth darkening (Luft, Colditz, Deussen 2006): the unsharp mask of the depth buffer. With D the depth normalised to 0..1 and G a
// Gaussian over the pixels that hold a surface (the weights of the rest are left out and divided away),
//   mask = min(0, G*D - D)
// is negative where a surface lies behind something near it on the screen, and 0 elsewhere (README, correction 15). Separable: ACROSS sums
// along rows, DOWN along columns.
#include "include/frame.glsl"

#include "params/depthmask.glsl"

#ifdef DOWN
PICTURE(rg32f, sums_image); // sum of w D, sum of w
layout(r32f) writeonly uniform image2D mask_image;
#else
layout(rg32f) writeonly uniform image2D sums_image;
#endif

float normalised(float depth) { return clamp((depth - params.near) * params.scale, 0.0, 1.0); }

float gaussian(int i) { return exp(-0.5 * float(i * i) / (params.sigma * params.sigma)); }

// Near a border the Gaussian is cut on both sides alike. Cut on one side only, it would take every slope for an edge.
int reach_at(int x, int size) { return min(params.radius, min(x, size - 1 - x)); }

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    vec2 sums = vec2(0.0);
#ifdef DOWN
    float depth = depth_at(p), mask = 0.0;
    int reach = depth != 0.0 ? reach_at(p.y, frame_size.y) : -1;
    for (int i = -reach; i <= reach; i++) sums += gaussian(i) * FETCH(sums_image, p + ivec2(0, i)).rg;
    if (depth != 0.0) mask = sums.r / sums.g - normalised(depth);
    imageStore(mask_image, p, vec4(mask < -1e-6 ? mask : 0.0)); // smaller values are rounding of the sums
#else
    int reach = reach_at(p.x, frame_size.x);
    for (int i = -reach; i <= reach; i++) {
        float depth = depth_at(p + ivec2(i, 0));
        if (depth != 0.0) sums += gaussian(i) * vec2(normalised(depth), 1.0);
    }
    imageStore(sums_image, p, vec4(sums, 0.0, 0.0));
#endif
}
