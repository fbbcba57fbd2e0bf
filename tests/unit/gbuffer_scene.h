// A sphere over a ground plane, rendered ray by ray into an exrio_file in memory: what the gbuffer tests build frames from.
#ifndef SSDO_TESTS_GBUFFER_SCENE_H
#define SSDO_TESTS_GBUFFER_SCENE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/half.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/solve.h"

enum { W = 160, H = 96, N = W * H };
enum { PX, PY, PZ, NX, NY, NZ, Z, R, G, B, A, AR, AG, AB, ROUGH, CHANNELS };

static char *const names[CHANNELS] = {
    "L.Position.X", "L.Position.Y", "L.Position.Z", "L.Normal.X",  "L.Normal.Y",  "L.Normal.Z",  "L.Depth.Z",   "L.Combined.R",
    "L.Combined.G", "L.Combined.B", "L.Combined.A", "L.DiffCol.R", "L.DiffCol.G", "L.DiffCol.B", "L.Roughness",
};

typedef struct scene {
    camera camera;
    double jitter;     // of the sample within its pixel, full width in pixels
    double background; // what Z and P hold there
    double background_p;
    bool radial, only_plane, no_ground, averaged_edges;
    vec3 shift; // of the whole world
} scene;

static float pixels[CHANNELS][N];
static double true_depth[N]; // at the pixel centre; 0 background
static vec3 true_normal[N];  // camera space
static exrio_channel channels[CHANNELS];
static exrio_part part;
static exrio_file file;

static inline mat3 looking_down(void)
{
    // Yaw 0.4, 25 degrees down, roll 0.1, in a z-up world; columns: camera x (right), y (down), z (forward).
    double yaw = 0.4, pitch = 0.44, roll = 0.1;
    vec3 f = v3(-sin(yaw) * cos(pitch), cos(yaw) * cos(pitch), -sin(pitch)), r = v3(cos(yaw), sin(yaw), 0), d = v3_cross(f, r);
    vec3 x = v3_add(v3_scale(r, cos(roll)), v3_scale(d, sin(roll))), y = v3_cross(f, x);
    return (mat3){{{x.x, y.x, f.x}, {x.y, y.y, f.y}, {x.z, y.z, f.z}}};
}

static inline scene base_scene(camera_kind kind)
{
    scene s = {.camera = {.kind = kind, .fx = 180, .fy = 180, .cx = W / 2.0, .cy = H / 2.0, .has_world = true},
               .background = 1e10};
    if (kind == CAMERA_ORTHOGRAPHIC) s.camera.fx = s.camera.fy = 25;
    s.camera.world_from_camera = looking_down();
    s.camera.origin = v3_sub(v3(0, 0, 0.6), v3_scale(m3_apply(s.camera.world_from_camera, v3(0, 0, 1)), 6.0));
    return s;
}

// Nearest hit along the ray through data-window position (x, y): camera-space position and normal.
static inline bool cast(const scene *s, double x, double y, vec3 *p, vec3 *n)
{
    const camera *c = &s->camera;
    vec3 d = v3((x - c->cx) / c->fx, (y - c->cy) / c->fy, 1), o = v3(0, 0, 0);
    if (c->kind == CAMERA_ORTHOGRAPHIC) o = v3(d.x, d.y, 0), d = v3(0, 0, 1);
    mat3 to_camera = m3_transpose(c->world_from_camera);
    vec3 up = m3_apply(to_camera, v3(0, 0, 1)), ground = camera_from_world(c, v3(0, 0, 0)),
         ball = camera_from_world(c, v3(0, 0, 1));
    double best = INFINITY, t = v3_dot(v3_sub(ground, o), up) / v3_dot(d, up);
    if (!s->no_ground && t > 0 && t < 8) best = t, *n = up;
    vec3 oc = v3_sub(o, ball);
    double a = v3_dot(d, d), b = v3_dot(oc, d), q = b * b - a * (v3_dot(oc, oc) - 1.0);
    if (!s->only_plane && q > 0 && (t = (-b - sqrt(q)) / a) > 0 && t < best)
        best = t, *n = v3_sub(v3_add(o, v3_scale(d, t)), ball);
    if (isinf(best)) return false;
    *p = v3_add(o, v3_scale(d, best));
    return true;
}

static inline void put(int base, size_t i, vec3 v)
{
    pixels[base][i] = (float)v.x, pixels[base + 1][i] = (float)v.y, pixels[base + 2][i] = (float)v.z;
}

// The mean normal of a pixel's 8 x 8 sub-samples, background counting as zero: its length is the coverage.
static inline vec3 mean_normal(const scene *s, int x, int y)
{
    vec3 sum = {0}, p, n;
    for (int j = 0; j < 64; j++)
        if (cast(s, x + (j % 8 + 0.5) / 8, y + (j / 8 + 0.5) / 8, &p, &n)) sum = v3_add(sum, v3_scale(n, 1.0 / 64));
    return sum;
}

static inline void render(const scene *s)
{
    uint64_t random = 5;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            size_t i = (size_t)y * W + (size_t)x;
            vec3 p = {0}, n = {0};
            true_depth[i] = cast(s, x + 0.5, y + 0.5, &p, &n) ? p.z : 0.0;
            true_normal[i] = true_depth[i] > 0 ? n : v3(0, 0, 0);
            double jx = (double)(solve_random(&random) >> 11) * 0x1p-53 - 0.5,
                   jy = (double)(solve_random(&random) >> 11) * 0x1p-53 - 0.5;
            bool hit = cast(s, x + 0.5 + s->jitter * jx, y + 0.5 + s->jitter * jy, &p, &n);
            const mat3 *m = &s->camera.world_from_camera;
            put(PX, i,
                hit ? v3_add(v3_add(m3_apply(*m, p), s->camera.origin), s->shift)
                    : v3(s->background_p, s->background_p, s->background_p));
            if (s->averaged_edges) n = mean_normal(s, x, y);
            put(NX, i, hit || s->averaged_edges ? m3_apply(*m, n) : v3(0, 0, 0));
            pixels[Z][i] = (float)(hit ? (s->radial ? v3_length(p) : p.z) : s->background);
            put(R, i, v3(x, y, 0.5));
            put(AR, i, v3(0.25, 0.5, 0.75));
            pixels[A][i] = 1.0f;
            pixels[ROUGH][i] = 0.3f;
        }
    for (int c = 0; c < CHANNELS; c++) channels[c] = (exrio_channel){.name = names[c], .type = SAMPLE_FLOAT, .data = pixels[c]};
    static char empty[] = "", path[] = "in.exr";
    box2 window = {0, 0, W - 1, H - 1};
    part = (exrio_part){.name = empty, .view = empty, .data_window = window, .display_window = window, .pixel_aspect = 1};
    part.channels = channels, part.channel_count = CHANNELS;
    file = (exrio_file){.path = path, .parts = &part, .part_count = 1};
}

static inline bool try_build(const resolve_options *ro, gbuffer_options o, gbuffer *g, error *e)
{
    resolution r;
    resolve_options none = {0};
    if (!resolve_channels(&file, ro ? ro : &none, &r, NULL, e)) return false;
    o.threads = 2;
    return gbuffer_build(&file, &r, &o, g, NULL, e);
}

static inline gbuffer built_with(const resolve_options *ro, gbuffer_options o)
{
    gbuffer g;
    error e = {0};
    if (!try_build(ro, o, &g, &e)) fail_msg("%s", e.message);
    return g;
}

static inline gbuffer built(void) { return built_with(NULL, (gbuffer_options){0}); }

// Channels `first` .. `last` leave the file (they get a name nobody looks for).
static inline void drop(int first, int last)
{
    static char unknown[] = "unknown";
    for (int c = first; c <= last; c++) channels[c].name = unknown;
}

static inline double offset_of(const gbuffer *g, size_t i)
{
    return g->camera.kind == CAMERA_ORTHOGRAPHIC ? (double)g->depth[i] - true_depth[i] : 0;
}

// Shares of pixels whose depth or normal is off by more than the tolerance; both must know the same surfaces.
static inline void compare(const gbuffer *g, double *depth_off, double *normal_off, double depth_tolerance,
                           double normal_tolerance)
{
    size_t surfaces = 0, bad_depth = 0, bad_normal = 0;
    double base = 0;
    for (size_t i = 0; i < N && base == 0; i++)
        if (g->depth[i] > 0 && true_depth[i] > 0) base = offset_of(g, i);
    for (size_t i = 0; i < N; i++) {
        const float *n = g->normal + 4 * i;
        assert_true(isfinite(g->depth[i]) && g->depth[i] >= 0 && n[3] <= 0 && n[3] > -1);
        if (!(g->depth[i] > 0) || !(true_depth[i] > 0)) continue;
        surfaces++;
        bad_depth += fabs(((double)g->depth[i] - base) / true_depth[i] - 1) > depth_tolerance;
        vec3 m = v3((double)n[0], (double)n[1], (double)n[2]);
        assert_true(fabs(v3_length(m) - 1) < 1e-5);
        bad_normal += v3_length(v3_sub(m, true_normal[i])) > normal_tolerance;
    }
    assert_true(surfaces > 1000);
    *depth_off = (double)bad_depth / (double)surfaces;
    *normal_off = (double)bad_normal / (double)surfaces;
}

static inline void assert_exact(const gbuffer *g, double tolerance)
{
    double d, n;
    compare(g, &d, &n, tolerance, 1e-3);
    assert_true(d == 0 && n == 0);
    for (size_t i = 0; i < N; i++) {
        assert_int_equal(g->depth[i] > 0, true_depth[i] > 0);
        assert_true(g->normal[4 * i + 3] == 0);
    }
}

#endif
