#version 450 core
// What the surfaces that further G-buffers show send: the environment's light that reaches them through the openings of their own map, times
// their albedo (rgb; a 1), or the light alone where their albedo is not known (a 0). a -1: nothing is there. A texel stands for
// BLOCK x BLOCK of the map; some points of them are lit, each by a few cosine-weighted rays and by the suns. A sun counts only where the
// map shows the sky that it stands in: a patch of sun that is not there spoils the bounce of a whole court.
#include "include/frame.glsl"
#include "include/sampling.glsl"
#include "include/environment.glsl"
#include "include/arc_params.glsl"
#include "include/surround.glsl"
#include "include/suns.glsl"

layout(rgba32f) writeonly uniform image2D surround_light_image;
PICTURE(rgba32f, surround_albedo_image);

const int BLOCK = SURROUND_SIDE / SURROUND_COARSE, POINTS = 2, RAYS = 4; // points a side; rays a point
const float FOOTPRINT = 0.5; // share of a ray's solid angle that its mip level covers

vec3 direction_at(vec2 texel) { // src/passes/surround.c
    vec2 p = 2.0 * texel / float(SURROUND_SIDE) - 1.0;
    float z = 1.0 - abs(p.x) - abs(p.y);
    vec2 folded = (1.0 - abs(p.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    return normalize(vec3(z >= 0.0 ? p : folded, z));
}

// How far the surface is that the map shows, through an opening or not; 0: none.
float distance_at(int map, vec3 d) {
    vec2 shell = shell_at(map, d);
    return shell.x > 0.0 ? (isinf(shell.x) ? 0.0 : shell.x) : shell.y;
}

// Along a tangent of the map: to the neighbour whose distance differs less.
vec3 along(int map, vec3 d, float far, vec3 tangent) {
    const float TURN = 2.0 * PI / float(SURROUND_SIDE);
    vec3 a = normalize(d + TURN * tangent), b = normalize(d - TURN * tangent);
    float to_a = distance_at(map, a), to_b = distance_at(map, b);
    bool first = to_a > 0.0 && (to_b == 0.0 || abs(to_a - far) <= abs(to_b - far));
    return first ? to_a * a - far * d : to_b > 0.0 ? far * d - to_b * b : tangent;
}

float lets_through(int map, vec3 P, vec3 direction) {
    vec3 met;
    float open = follow(map, P, direction, OFF_SURFACE, met);
    return open == UNDECIDED ? params.sun_openness : open;
}

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    int map = p.y / SURROUND_COARSE;
    ivec2 corner = BLOCK * ivec2(p.x, p.y - map * SURROUND_COARSE);
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (int i = 0; i < POINTS * POINTS; i++) {
        vec3 d = direction_at(vec2(corner) + (vec2(i % POINTS, i / POINTS) + 0.5) * (float(BLOCK) / float(POINTS)));
        float far = distance_at(map, d);
        if (far == 0.0) continue;
        mat3 around = tangent_frame(d);
        vec3 P = far * d, N = normalize(cross(along(map, d, far, around[0]), along(map, d, far, around[1])));
        N = dot(N, d) > 0.0 ? -N : N;
        mat3 over = tangent_frame(N);
        vec2 turn = pixel_hash(uvec2(p) * uint(POINTS * POINTS) + uvec2(i, 0));
        vec3 light = vec3(0.0);
        for (int k = 0; k < RAYS; k++) {
            vec2 u = fract(turn + vec2((float(k) + 0.5) / float(RAYS), 0.6180340 * float(k)));
            float phi = 2.0 * PI * u.y, r = sqrt(u.x), up = sqrt(1.0 - u.x);
            vec3 S = r * cos(phi) * over[0] + r * sin(phi) * over[1] + up * N;
            light += lets_through(map, P, S) / float(RAYS) * radiance_from(S, map_level(S, FOOTPRINT * PI / (float(POINTS * POINTS * RAYS) * max(up, 0.1))));
        }
        for (int k = 0; k < params.suns; k++) {
            vec3 S = arc_block.sun_direction[k].xyz;
            if (dot(N, S) > 0.0) light += lets_through(map, P, S) == OPEN ? sunlight(k, N) : vec3(0.0);
        }
        sum += light;
        count += 1.0;
    }
    vec4 albedo = FETCH(surround_albedo_image, p);
    vec3 light = sum / max(count, 1.0);
    imageStore(surround_light_image, p, vec4(albedo.a == 1.0 ? light * albedo.rgb : light, count == 0.0 ? -1.0 : albedo.a));
}
