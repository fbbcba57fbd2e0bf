#version 450 core
// lint: | VISIBILITY
// Adds the suns' light to the filtered light of the rest of the environment: their shadows have sharp edges that no filter should
// touch. Only single pixels and pairs that differ from all around them on their surface are brought between the second lowest and
// the second highest of their neighbours: what a march with few steps has missed, or a silhouette's averaged normal misled.
// With VISIBILITY the share of open light takes the suns in, weighed against the irradiance of the rest of the map.
#include "include/frame.glsl"
#include "include/environment.glsl"
#include "include/arc_params.glsl"
#include "include/suns.glsl"

layout(r32f, binding = 2) uniform image2D scalar_image;
layout(rgba32f, binding = 3) readonly uniform image2D sun_image;
layout(rgba32f, binding = 4) uniform image2D light_image;

const float CONNECTED = 2.0; // footprints between a neighbour and a tangent plane, either's

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float depth = depth_at(p);
    if (depth == 0.0) return;
    vec3 P = position_of(p, depth), N = normal_at(p), all = vec3(0.0);
    for (int i = 0; i < params.suns; i++) all += sunlight(i, N);
    vec4 own = imageLoad(sun_image, p);
    float near = CONNECTED * footprint(depth);
    vec2 low = vec2(2.0), high = vec2(-1.0); // the two lowest, the two highest
    for (int k = 0; k < 9; k++) {
        ivec2 q = p + ivec2(k % 3, k / 3) - 1;
        float other = depth_at(q);
        if (k == 4 || other == 0.0) continue;
        vec3 gap = position_of(q, other) - P;
        if (min(abs(dot(N, gap)), abs(dot(normal_at(q), gap))) > near) continue;
        float share = imageLoad(sun_image, q).a;
        low = vec2(min(low.x, share), clamp(share, low.x, low.y));
        high = vec2(max(high.x, share), clamp(share, high.y, high.x));
    }
    float share = high.y < 0.0 ? own.a : clamp(own.a, low.y, high.y);
    vec3 light = share <= own.a ? own.rgb * (own.a > 0.0 ? share / own.a : 1.0) : own.rgb + (share - own.a) * all;
    imageStore(light_image, p, vec4(imageLoad(light_image, p).rgb + light, 0.0));
#ifdef VISIBILITY
    float sky = dot(sh_irradiance_over_pi(stored.rest, to_map(N)), LUMINANCE), suns = dot(all, LUMINANCE);
    float seen = imageLoad(scalar_image, p).r;
    if (sky + suns > 0.0) imageStore(scalar_image, p, vec4((seen * sky + share * suns) / (sky + suns)));
#endif
}
