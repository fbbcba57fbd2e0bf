#version 450 core
// Adds the suns' light to the filtered light of the rest of the environment. Shadows of suns have sharp edges, so the suns' light is only
// averaged over a pixel's neighbours on its own surface (weights 1 2 1 in each direction). This removes the grain that a march's steps
// leave along the far edge of a shadow, and the stairs along its other edges.
// VISIBILITY: also adds the suns to the share of open light, weighed against the irradiance of the rest of the map.
#include "include/frame.glsl"
#include "include/environment.glsl"
#include "include/arc_params.glsl"
#include "include/suns.glsl"

layout(r32f) uniform image2D scalar_image;
PICTURE(rgba32f, sun_image);
layout(rgba32f) uniform image2D light_image;

const float CONNECTED = 2.0; // footprints between a neighbour and a tangent plane, either's

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float depth = depth_at(p);
    if (depth == 0.0) return;
    vec3 P = position_of(p, depth), N = normal_at(p), all = vec3(0.0);
    for (int i = 0; i < params.suns; i++) all += sunlight(i, N);
    vec4 own = FETCH(sun_image, p);
    if (own.a < 0.0) return; // it faces away from all suns
    float near = CONNECTED * footprint(depth), sum = 4.0 * own.a, total = 4.0;
    for (int k = 0; k < 9; k++) {
        ivec2 q = p + ivec2(k % 3, k / 3) - 1;
        float other = depth_at(q);
        if (k == 4 || other == 0.0) continue;
        vec3 gap = position_of(q, other) - P;
        if (min(abs(dot(N, gap)), abs(dot(normal_at(q), gap))) > near) continue;
        float w = (k & 1) == 1 ? 2.0 : 1.0, share = FETCH(sun_image, q).a;
        if (share < 0.0) continue;
        sum += w * share;
        total += w;
    }
    float share = ratio(sum, total);
    vec3 light = share <= own.a ? own.rgb * (own.a > 0.0 ? ratio(share, own.a) : 1.0) : own.rgb + (share - own.a) * all;
    imageStore(light_image, p, vec4(LOAD(light_image, p).rgb + light, 0.0));
#ifdef VISIBILITY
    float sky = dot(sh_irradiance_over_pi(arc_block.rest, to_map(N)), LUMINANCE), suns = dot(all, LUMINANCE);
    float seen = LOAD(scalar_image, p).r;
    if (sky + suns > 0.0) imageStore(scalar_image, p, vec4(ratio(seen * sky + share * suns, sky + suns)));
#endif
}
