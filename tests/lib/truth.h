// The truth of a scene, knowing all of its geometry: closed forms, and brute force by ray casting (tests/README.md, reference B).
//
// Occlusion values are open shares, as in the `occlusion` layer. Angles are in radians. Brute force is deterministic for a seed;
// two seeds give independent noise. The intersector is a tracer (scene.h), so that another one can stand in.
#ifndef SSDO_TESTS_TRUTH_H
#define SSDO_TESTS_TRUTH_H

#include <stdint.h>

#include "scene.h"

// --- Closed forms: open share ---

// Anything that fills the cone around a direction m: cosine-weighted share of the upper hemisphere inside w.m >= k, where cos_m
// is the cosine between m and the normal, 0 < k < 1. Handles cones cut by the horizon (Stokes: half the loop integral of x dy - y
// dx around the cone's projection onto the ground disc).
double truth_cone(double cos_m, double k);

// Half-space wall at elevation a: (1 + cos a) / 2, at any distance.
double truth_wall(double a);
// The same with cutoff R, at ground distance x from the foot. At a = pi/2 the formula of truth_corner.
double truth_wall_cutoff(double a, double x, double radius);
// Perpendicular corner: 1 - (acos k - k sqrt(1 - k^2)) / pi, k = x/R.
double truth_corner(double x, double radius);
// Sphere of radius r, centre at height h above the ground, at ground distance d; no cutoff. Exact also where the sphere dips
// below the horizon.
double truth_sphere(double r, double h, double d);
// Trench of width w and depth `depth`, at offset u from its middle line: (sin a1 + sin a2) / 2. Infinitely long.
double truth_slit(double w, double depth, double u);
// Infinitely long bar, width x thickness, underside at height h, at offset u from below its middle.
double truth_bar(double width, double thickness, double h, double u);
// Below the middle of a square of edge `size` at distance gap, facing down.
double truth_patch(double size, double gap);
// What the point test of SSDO (no thickness) converges to at a perpendicular corner that the camera sees whole: a direction that
// hits the wall at distance t is blocked for the share 1 - t/R of its samples. With k = x/R:
// 1 - (acos k + k sqrt(1 - k^2) - 2 k ln((1 + sqrt(1 - k^2)) / k)) / pi.
double truth_corner_point_test(double x, double radius);

// --- Brute force ---

// Radiance arriving from a world direction.
typedef vec3 (*truth_sky)(void *data, vec3 direction);
vec3 truth_white_sky(void *data, vec3 direction);       // 1 everywhere; data is ignored
vec3 truth_environment_sky(void *data, vec3 direction); // data: a light/environment.h environment, level 0

typedef struct truth_options {
    double radius;   // reach of V; 0 or INFINITY for no limit
    int rays;        // rounded up to a square; 0 = 4096
    int bounce_rays; // rays of each second hemisphere; 0 = 64
    double offset;   // of ray origins along the normal; 0 = 1e-9 of the coordinates' size (a float tracer needs 1e-4 or so)
    uint32_t seed;
    truth_sky sky; // NULL = truth_white_sky
    void *sky_data;
} truth_options;

// Cosine-weighted share of the hemisphere open within the radius.
double truth_occlusion(const tracer *t, vec3 point, vec3 normal, const truth_options *o);
// (1/pi) integral of L V cos: the `radiance` layer.
vec3 truth_radiance(const tracer *t, vec3 point, vec3 normal, const truth_options *o);
// (1/pi) integral over the blocked directions (within the radius) of albedo_s radiance_s cos, radiance_s being the sender's own
// direct light with V of unlimited reach: the `indirect` layer.
vec3 truth_indirect(const tracer *t, vec3 point, vec3 normal, const truth_options *o);

// i-th of n * n stratified cosine-distributed directions around a unit normal; jittered within its stratum by the seed. With
// density cos/pi the estimate of (1/pi) integral f cos is the plain mean of f.
vec3 truth_direction(vec3 normal, int i, int n, uint32_t seed);

#endif
