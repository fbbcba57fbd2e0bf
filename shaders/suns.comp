#version 450 core
// Light of the environment's suns: small bright sources taken out of the map. suns_add.comp adds it to the light of the rest. For each
// sun one side of a slice is marched as `arc` marches (README, Suns). Its 64 sectors divide the sun's own disc, so a penumbra has no
// noise. Planes do not stand in here: a plane would put a point wholly in shadow or wholly out of it, and is wrong too often.
// OUTSIDE: not all directions that leave the frame are open (include/outside.glsl).
#define SUNS
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/environment.glsl"
#include "include/arc_params.glsl"
#include "include/arc_slice.glsl"
#include "include/arc_line.glsl"
#include "include/arc_sectors.glsl"
#ifdef OUTSIDE
#include "include/outside.glsl"
#endif
#include "include/suns.glsl"
#include "include/arc_march.glsl"

layout(rgba32f) writeonly uniform image2D sun_image; // rgb: light; a: its share of the light that arrives with nothing in the way, -1 if none does

// Where a ray leaves the box of all surfaces, beyond which nothing can block it; in pixels along its line.
float way_out(vec3 P, vec3 S, Line line) {
    vec3 from = to_map(P), along = to_map(S);
    vec3 wall = mix(arc_block.box_low.xyz, arc_block.box_high.xyz, greaterThan(along, vec3(0.0)));
    vec3 times = (wall - from) / mix(along, vec3(1e-20), lessThan(abs(along), vec3(1e-20)));
    vec3 X = P + max(0.0, min(times.x, min(times.y, times.z))) * S;
    return in_front(X) ? min(distance(screen_of(X), line.origin), line.border) : line.border;
}

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float depth = depth_at(p);
    if (depth == 0.0) return;
    vec3 P = position_of(p, depth), N = normal_at(p), V = view_of(P);
    vec2 origin = vec2(p) + 0.5;
    float eye_distance = length(P), noise = pixel_noise(p, params.seed).x;
    vec3 light = vec3(0.0), all = vec3(0.0);
    for (int i = 0; i < params.suns; i++) {
        vec3 S = arc_block.sun_direction[i].xyz, L = sunlight(i, N);
        if (dot(N, S) <= 0.0) continue;
        float half_width = arc_block.sun_direction[i].w, along = dot(S, V);
        vec3 aside = S - along * V;
        float sine = length(aside), t = atan(sine, along);
        vec3 across = sine > 1e-4 ? aside / sine : tangent_frame(V)[0];
        float n, weight;
        Side side = side_of(V, across, N, eye_distance, n, weight);
        float low = share_at(side, t - half_width), high = share_at(side, t + half_width);
        divide_into_sectors(low, high);
        Lines lines = lines_of(V, across, origin, -1.0);
        Line line = lines.right;
#ifdef OUTSIDE
        Exits exits = exits_of(P, V, lines);
#endif
#ifndef OUTSIDE // the opening that shows the sky may lie beyond the box
        line.reach = way_out(P, S, line);
#endif
        Sectors sectors = all_open();
        march(sectors, side, line, P, N, noise, 0.5);
#ifdef OUTSIDE
        float open = open_share(~sectors.blocked, sectors.seen, openness(V, across, vec2(along, sine), exits));
#else
        float open = 1.0 - sector_share(sectors.blocked);
#endif
        light += open * L;
        all += L;
    }
    float most = dot(all, LUMINANCE);
    imageStore(sun_image, p, vec4(light, most > 0.0 ? dot(light, LUMINANCE) / most : -1.0));
}
