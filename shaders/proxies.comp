#version 450 core
// Spheres that the camera does not see. Each is a cone of directions, exactly clipped by the receiver's horizon. F_i is the
// cosine-weighted share of the hemisphere in cone i. Where cones overlap, directions count for the first of them: F_i is multiplied by
// 1 - (share of cone i that lies in cone j) for each j before i. What the cones block is taken to be independent of what the method found:
//   occlusion *= 1 - sum F_i                      of what the spheres block within R
//   radiance, visibility *= 1 - sum F_i L_i / E   at any distance; L_i the environment's mean over the cone, E the irradiance / pi
//   bent      -= F_i d_i                             d_i: the cone's axis
//   VECTOR:   radiance and visibility are scaled like occlusion, and SH scales the sh layers by the same factor, so that a relight
//             agrees. SH is a run of its own, because one program may not have more images than GL promises
//   BOUNCE:   indirect += sum F_i albedo_i E(-d_i) (1 - m (d_i . N)) / 2. The last factor is the mean open share of the side of the
//             sphere that the receiver sees, over the receiver's tangent plane; m is the mean cosine between that side's normals and -d_i
#include "include/frame.glsl"
#include "include/environment.glsl"

#include "params/proxies.glsl"

PICTURE(rgba32f, sphere_image); // row 0: centre in camera space, radius; row 1: albedo
#ifdef BOUNCE
layout(rgba32f) uniform image2D indirect_image;
#endif
#ifdef OCCLUSION
layout(r32f) uniform image2D occlusion_image;
#endif
#ifdef VISIBILITY
layout(r32f) uniform image2D visibility_image;
#endif
#ifdef RADIANCE
layout(rgba32f) uniform image2D radiance_image;
#endif
#ifdef BENT
layout(rgba32f) uniform image2D bent_image;
#endif
#ifdef SH
layout(rgba32f) uniform image2D sh0_image;
layout(rgba32f) uniform image2D sh1_image;
layout(rgba32f) uniform image2D sh2_image;
#ifdef BANDS3
layout(rgba32f) uniform image2D sh3_image;
layout(rgba32f) uniform image2D sh4_image;
#endif
#endif

const float UNLIMITED = 1e15;

// Cosine-weighted share of the hemisphere inside a cone: c the cosine between its axis and the normal, cs and sn the cosine and sine of
// its half angle. Half the loop integral of n . (r x dr) / pi around the part above the horizon: the arc of the cone's rim, from -phi to
// phi where it is above, and the piece of the horizon between its ends.
float cone_share(float c, float cs, float sn) {
    if (c >= sn) return sn * sn * c;
    if (c <= -sn) return 0.0;
    float q = sqrt(max(1.0 - c * c, 1e-12)), cos_phi = clamp(-c * cs / (q * sn), -1.0, 1.0);
    float sin_phi = sqrt(1.0 - cos_phi * cos_phi);
    float rim = acos(cos_phi) * sn * sn * c - sn * cs * q * sin_phi;
    float horizon = atan(sn * sin_phi, cs * q - sn * c * cos_phi);
    return clamp((rim + horizon) / PI, 0.0, 1.0);
}

struct Cone { vec3 axis; float cs, sn; }; // axis, cosine and sine of the half angle; sn 0: nothing of the sphere is within reach

// The directions in which the sphere is met within `reach`. A rim that lies farther than that is replaced by the circle where a sphere
// of radius `reach` around P cuts it. Inside the sphere all is blocked.
Cone cone_of(vec4 sphere, vec3 P, vec3 N, float reach) {
    vec3 to = sphere.xyz - P;
    float d = length(to), r = sphere.w;
    if (d <= r) return Cone(N, 0.0, 1.0);
    vec3 axis = to / d;
    if (d - r >= reach) return Cone(axis, 1.0, 0.0);
    float sn = r / d, cs = sqrt(max(0.0, (1.0 - sn) * (1.0 + sn)));
    if (d * cs <= reach) return Cone(axis, cs, sn);
    cs = min(1.0, 0.5 * (d / reach + (reach - r) * (reach + r) / (d * reach)));
    return Cone(axis, cs, sqrt(max(0.0, (1.0 - cs) * (1.0 + cs))));
}

float share_of(Cone k, vec3 N) { return k.sn > 0.0 ? cone_share(dot(k.axis, N), k.cs, k.sn) : 0.0; }

// Share of cone a that lies in cone b: 1 where b holds a, 0 where they are apart, smooth between (Oat and Sander 2007).
float overlap(Cone a, Cone b) {
    if (b.sn == 0.0) return 0.0;
    float ra = acos(a.cs), rb = acos(b.cs), apart = acos(clamp(dot(a.axis, b.axis), -1.0, 1.0)), inside = abs(ra - rb);
    float t = smoothstep(0.0, 1.0, (apart - inside) / max(ra + rb - inside, 1e-6));
    return (1.0 - t) * min(1.0 - a.cs, 1.0 - b.cs) / (1.0 - a.cs);
}

Cone cone_at(int i, vec3 P, vec3 N, float reach) { return cone_of(FETCH(sphere_image, ivec2(i, 0)), P, N, reach); }

// F_i over the share of cone i alone.
float left_by_others(int i, Cone k, vec3 P, vec3 N, float reach) {
    float rest = 1.0;
    for (int j = 0; j < i; j++) rest *= 1.0 - overlap(k, cone_at(j, P, N, reach));
    return rest;
}

// What of the light E at normal N comes through the share F of a cone.
vec3 light_share(Cone k, float F, vec3 N, vec3 E) {
    float c = dot(k.axis, N);
    vec3 seen = c > 0.0 ? k.axis : normalize(k.axis - c * N + 1e-6 * N); // the part above the horizon
    vec3 L = radiance_from(to_map(seen), map_level(to_map(seen), 2.0 * PI * (1.0 - k.cs)));
    return clamp(F * L / max(E, vec3(1e-20)), vec3(0.0), vec3(1.0));
}

#ifdef BOUNCE
void apply(ivec2 p, vec3 P, vec3 N) {
    vec3 light = vec3(0.0);
    for (int i = 0; i < params.count; i++) {
        Cone k = cone_at(i, P, N, UNLIMITED);
        float F = share_of(k, N);
        if (F == 0.0) continue;
        float lean = 2.0 / 3.0 + k.sn * (0.5 - k.sn / 6.0); // m: 2/3 from afar, 1 where it touches; within 0.007
        // Directions nearer to N count more, and their normals lean up: 0.25 (1 - c^2) g / c, g the mean of the two sines' product.
        float c = dot(k.axis, N), g = 0.5 * k.sn * sqrt(1.0 - k.sn);
        float open = min(0.5 - 0.5 * lean * c + 0.25 * (1.0 - c * c) * g / max(c, k.sn), 1.0);
        light += F * left_by_others(i, k, P, N, UNLIMITED) * open * FETCH(sphere_image, ivec2(i, 1)).rgb * sh_irradiance_over_pi(to_map(-k.axis));
    }
    imageStore(indirect_image, p, LOAD(indirect_image, p) + vec4(params.strength * light, 0.0));
}
#else
void apply(ivec2 p, vec3 P, vec3 N) {
    float blocked = 0.0, blocked_luminance = 0.0;
    vec3 blocked_light = vec3(0.0), shut = vec3(0.0);
#if defined(RADIANCE) || defined(VISIBILITY)
    vec3 E = sh_irradiance_over_pi(to_map(N));
#endif
    for (int i = 0; i < params.count; i++) {
        Cone k = cone_at(i, P, N, params.radius);
        float F = share_of(k, N);
        if (F > 0.0) F *= left_by_others(i, k, P, N, params.radius);
        blocked += F;
        shut += F * k.axis;
#if defined(RADIANCE) || defined(VISIBILITY)
        k = cone_at(i, P, N, UNLIMITED);
        F = share_of(k, N);
        if (F > 0.0) F *= left_by_others(i, k, P, N, UNLIMITED);
        vec3 light = light_share(k, F, N, E);
        blocked_light += light;
        blocked_luminance += dot(LUMINANCE, light * E) / max(dot(LUMINANCE, E), 1e-20);
#endif
    }
    float open = 1.0 - min(blocked, 1.0), open_luminance = 1.0 - min(blocked_luminance, 1.0);
    vec3 open_light = 1.0 - min(blocked_light, vec3(1.0));
#ifdef VECTOR
    open_light = vec3(open);
    open_luminance = open;
#endif
#ifdef OCCLUSION
    imageStore(occlusion_image, p, open * LOAD(occlusion_image, p));
#endif
#ifdef SH
    imageStore(sh0_image, p, open * LOAD(sh0_image, p));
    imageStore(sh1_image, p, open * LOAD(sh1_image, p));
    imageStore(sh2_image, p, open * LOAD(sh2_image, p));
#ifdef BANDS3
    imageStore(sh3_image, p, open * LOAD(sh3_image, p));
    imageStore(sh4_image, p, open * LOAD(sh4_image, p));
#endif
#endif
#ifdef VISIBILITY
    imageStore(visibility_image, p, open_luminance * LOAD(visibility_image, p));
#endif
#ifdef RADIANCE
    imageStore(radiance_image, p, vec4(open_light, 1.0) * LOAD(radiance_image, p));
#endif
#ifdef BENT
    imageStore(bent_image, p, LOAD(bent_image, p) - vec4(shut, 0.0));
#endif
}
#endif

void main() {
    ivec2 p = this_pixel();
    if (!in_tile(p)) return;
    float depth = depth_at(p);
    if (depth != 0.0) apply(p, position_of(p, depth), normal_at(p));
}
