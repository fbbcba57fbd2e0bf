#version 450 core
// Direct light by slices around the view vector (README, Slices and sectors). With the weight w of a slice, and sums over slices:
//   radiance = sum w (open share x environment) / sum w
//   VISIBILITY: visibility = its luminance over that of the open sky
//   BOUNCE: the same march makes what arc_bounce.comp makes, of a picture that the renderer lit (EXITANT) or of the first light
//           (src/passes/first_light.c)
// Light comes from any distance, so the march has no radius. OUTSIDE: not all directions that leave the frame are open
// (include/outside.glsl); SURROUND: further G-buffers say which. PLANES, RECEIVERS and LONE: include/arc_slices.glsl.
#define RUNS
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/environment.glsl"
#include "include/arc_slices.glsl"
#ifdef BOUNCE
#include "include/arc_bounce.glsl"
#endif
#ifdef SURROUND
#include "include/outlook.glsl"
#endif

layout(rgba32f) writeonly uniform image2D radiance_image;
#ifdef VISIBILITY
layout(r32f) writeonly uniform image2D visibility_image;
#endif

struct Light {
    vec3 open;
    float open_luminance, all_luminance; // all: that arrives with nothing in the way
};

// A slice is divided into CELLS pieces. Each piece looks the environment up once and weighs it by its share of open sectors. The mip level
// covers the share FOOTPRINT of the piece's solid angle. A level for the whole piece would bring in light from beyond what blocks it.
// What the smaller one leaves out beside the slice, the slices of neighbouring pixels see. Measured: tests/bench/RESULTS.md, Sampling.
const float FOOTPRINT = 0.125;

#ifdef SURROUND
void add_sky(inout Light light, Centre o, Slice s, Outlook outlook) {
#else
void add_sky(inout Light light, Centre o, Slice s) {
#endif
    const float width = PI / float(CELLS);
    const vec2 half_turn = vec2(cos(0.5 * width), sin(0.5 * width));
    float from = s.n - 0.5 * PI, c = 0.0, wedge = PI / float(params.slices);
    vec2 edge = vec2(s.side.sin_n, -s.side.cos_n); // cosine and sine of `from`
#if defined(OUTSIDE) && !defined(SURROUND)
    Exits exits = exits_of(o.P, o.V, s.lines);
#endif
    for (int i = 0; i < CELLS; i++) {
        vec2 middle = turned(edge, half_turn);
        edge = turned(middle, half_turn);
        float next = i + 1 == CELLS ? 1.0 : share_at(s.side, from + float(i + 1) * width, edge);
        uvec2 cell = sectors_between(c, next, s.noise.y);
        float share = sector_share(cell), open = sector_share(cell & ~s.sectors.blocked);
#ifdef SURROUND
        open = open_share(cell & ~s.sectors.blocked, s.sectors.seen, outlook.open[i]);
#elif defined(OUTSIDE)
        vec2 look = look_in(s.side, from + float(i) * width, width, i, s.noise.y);
        open = open_share(cell & ~s.sectors.blocked, s.sectors.seen, openness(o.V, s.across, look, exits));
#endif
        vec3 direction = to_map(middle.x * o.V + middle.y * s.across);
        float solid_angle = FOOTPRINT * wedge * max(abs(middle.y) * width, 0.25 * width * width);
        vec3 L = radiance_from(direction, params.level < 0.0 ? map_level(direction, solid_angle) : params.level);
        light.open += s.weight * open * L;
        light.open_luminance += s.weight * open * dot(L, LUMINANCE);
        light.all_luminance += s.weight * share * dot(L, LUMINANCE);
        c = next;
    }
}

void store(ivec2 p, vec3 radiance, float visibility, vec3 indirect) {
    imageStore(radiance_image, p, vec4(radiance, 0.0));
#ifdef VISIBILITY
    imageStore(visibility_image, p, vec4(visibility));
#endif
#ifdef BOUNCE
    imageStore(indirect_image, p, vec4(indirect, 0.0));
#endif
}

void main() {
    ivec2 p;
    if (!receiver_pixel(p)) return;
    Receiver here = receiver_at(p);
    if (here.depth == 0.0) {
        store(p, vec3(0.0), 1.0, vec3(0.0));
        return;
    }
    Centre centre = centre_of(here, p);
    Light light = Light(vec3(0.0), 0.0, 0.0);
    vec3 bounced = vec3(0.0);
    float all = 0.0;
#ifdef BOUNCE
    guess_light(here);
#endif
    for (int i = 0; i < params.slices; i++) {
        Slice s = march_slice(centre, i);
        all += s.weight;
#ifdef SURROUND
        Outlook outlook = look_outside(centre, s);
        add_sky(light, centre, s, outlook);
#else
        add_sky(light, centre, s);
#endif
#ifdef BOUNCE
        add_bounce(bounced, centre, s);
#ifdef SURROUND
        bounced += s.weight * outlook.sent;
#endif
#endif
    }
    light.open_luminance /= all;
    light.all_luminance /= all;
    float visibility = light.all_luminance > 0.0 ? min(1.0, ratio(light.open_luminance, light.all_luminance)) : 1.0;
    store(p, light.open / all, visibility, params.strength * bounced / all);
}
