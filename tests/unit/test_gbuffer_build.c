// gbuffer_build on a sphere over a ground plane, rendered here ray by ray.
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
static exr_channel channels[CHANNELS];
static exr_part part;
static exr_file file;

static mat3 looking_down(void)
{
    // Yaw 0.4, 25 degrees down, roll 0.1, in a z-up world; columns: camera x (right), y (down), z (forward).
    double yaw = 0.4, pitch = 0.44, roll = 0.1;
    vec3 f = v3(-sin(yaw) * cos(pitch), cos(yaw) * cos(pitch), -sin(pitch)), r = v3(cos(yaw), sin(yaw), 0), d = v3_cross(f, r);
    vec3 x = v3_add(v3_scale(r, cos(roll)), v3_scale(d, sin(roll))), y = v3_cross(f, x);
    return (mat3){{{x.x, y.x, f.x}, {x.y, y.y, f.y}, {x.z, y.z, f.z}}};
}

static scene base_scene(camera_kind kind)
{
    scene s = {.camera = {.kind = kind, .fx = 180, .fy = 180, .cx = W / 2.0, .cy = H / 2.0, .has_world = true},
               .background = 1e10};
    if (kind == CAMERA_ORTHOGRAPHIC) s.camera.fx = s.camera.fy = 25;
    s.camera.world_from_camera = looking_down();
    s.camera.origin = v3_sub(v3(0, 0, 0.6), v3_scale(m3_apply(s.camera.world_from_camera, v3(0, 0, 1)), 6.0));
    return s;
}

// Nearest hit along the ray through data-window position (x, y): camera-space position and normal.
static bool cast(const scene *s, double x, double y, vec3 *p, vec3 *n)
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

static void put(int base, size_t i, vec3 v)
{
    pixels[base][i] = (float)v.x, pixels[base + 1][i] = (float)v.y, pixels[base + 2][i] = (float)v.z;
}

// The mean normal of a pixel's 8 x 8 sub-samples, background counting as zero: its length is the coverage.
static vec3 mean_normal(const scene *s, int x, int y)
{
    vec3 sum = {0}, p, n;
    for (int j = 0; j < 64; j++)
        if (cast(s, x + (j % 8 + 0.5) / 8, y + (j / 8 + 0.5) / 8, &p, &n)) sum = v3_add(sum, v3_scale(n, 1.0 / 64));
    return sum;
}

static void render(const scene *s)
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
    for (int c = 0; c < CHANNELS; c++) channels[c] = (exr_channel){.name = names[c], .type = SAMPLE_FLOAT, .data = pixels[c]};
    static char empty[] = "", path[] = "in.exr";
    box2 window = {0, 0, W - 1, H - 1};
    part = (exr_part){.name = empty, .view = empty, .data_window = window, .display_window = window, .pixel_aspect = 1};
    part.channels = channels, part.channel_count = CHANNELS;
    file = (exr_file){.path = path, .parts = &part, .part_count = 1};
}

static bool try_build(const resolve_options *ro, gbuffer_options o, gbuffer *g, error *e)
{
    resolution r;
    resolve_options none = {0};
    if (!resolve_channels(&file, ro ? ro : &none, &r, NULL, e)) return false;
    o.threads = 2;
    return gbuffer_build(&file, &r, &o, g, NULL, e);
}

static gbuffer built_with(const resolve_options *ro, gbuffer_options o)
{
    gbuffer g;
    error e = {0};
    if (!try_build(ro, o, &g, &e)) fail_msg("%s", e.message);
    return g;
}

static gbuffer built(void) { return built_with(NULL, (gbuffer_options){0}); }

// Channels `first` .. `last` leave the file (they get a name nobody looks for).
static void drop(int first, int last)
{
    static char unknown[] = "unknown";
    for (int c = first; c <= last; c++) channels[c].name = unknown;
}

static double offset_of(const gbuffer *g, size_t i)
{
    return g->camera.kind == CAMERA_ORTHOGRAPHIC ? (double)g->depth[i] - true_depth[i] : 0;
}

// Shares of pixels whose depth or normal is off by more than the tolerance; both must know the same surfaces.
static void compare(const gbuffer *g, double *depth_off, double *normal_off, double depth_tolerance, double normal_tolerance)
{
    size_t surfaces = 0, bad_depth = 0, bad_normal = 0;
    double base = 0;
    for (size_t i = 0; i < N && base == 0; i++)
        if (g->depth[i] > 0 && true_depth[i] > 0) base = offset_of(g, i);
    for (size_t i = 0; i < N; i++) {
        const float *n = g->normal + 4 * i;
        assert_true(isfinite(g->depth[i]) && g->depth[i] >= 0 && n[3] == 0);
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

static void assert_exact(const gbuffer *g, double tolerance)
{
    double d, n;
    compare(g, &d, &n, tolerance, 1e-3);
    assert_true(d == 0 && n == 0);
    for (size_t i = 0; i < N; i++) assert_int_equal(g->depth[i] > 0, true_depth[i] > 0);
}

static void test_perspective(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    gbuffer g = built();
    assert_exact(&g, 1e-5);
    assert_int_equal(g.camera.source, CAMERA_FROM_FIT);
    assert_true(g.camera.residual < 0.01 && g.camera.has_world && fabs(g.camera.fx / 180 - 1) < 1e-5);
    assert_int_equal(g.depth_kind, DEPTH_PLANAR);
    assert_false(g.normals_from_depth || g.position_is_camera_space);
    assert_true(g.depth_from_position && g.off_ray == 0 && g.valid > N / 3 && g.valid < N && g.evidence_count > 0);
    vec3 p = gbuffer_position(&g, W / 2, H / 2);
    double x, y;
    assert_true(camera_project(&g.camera, p, &x, &y) && fabs(x - W / 2.0 - 0.5) < 1e-9 && fabs(y - H / 2.0 - 0.5) < 1e-9);
    double radius = gbuffer_auto_radius(&g);
    assert_true(radius > 0.02 && radius < 2);
    gbuffer_free(&g);
}

static void test_radial_is_measured(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.radial = true;
    render(&s);
    gbuffer g = built();
    assert_exact(&g, 1e-5);
    assert_int_equal(g.depth_kind, DEPTH_RADIAL);
    gbuffer_free(&g);
}

static void test_orthographic(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_ORTHOGRAPHIC);
    render(&s);
    for (int with_depth = 1; with_depth >= 0; with_depth--) {
        if (!with_depth) drop(Z, Z);
        gbuffer g = built();
        assert_int_equal(g.camera.kind, CAMERA_ORTHOGRAPHIC);
        assert_exact(&g, 1e-5);
        assert_true(fabs(g.camera.fx / 25 - 1) < 1e-5);
        gbuffer_free(&g);
    }
    // A mirrored world: the fit alone cannot know, depth and normals can.
    for (int r = 0; r < 3; r++) s.camera.world_from_camera.m[r][0] = -s.camera.world_from_camera.m[r][0];
    render(&s);
    for (int with_depth = 1; with_depth >= 0; with_depth--) {
        if (!with_depth) drop(Z, Z);
        gbuffer g = built();
        assert_exact(&g, 1e-5);
        assert_true(m3_det(g.camera.world_from_camera) < 0);
        gbuffer_free(&g);
    }
}

static void test_backgrounds(void **state)
{
    (void)state;
    const double backgrounds[] = {0, INFINITY, (double)NAN, 1e10, 1e11, 1e30, -1};
    for (size_t i = 0; i < sizeof backgrounds / sizeof *backgrounds; i++)
        for (int p = 0; p < 3; p++) {
            scene s = base_scene(CAMERA_PERSPECTIVE);
            s.background = backgrounds[i], s.background_p = p == 0 ? 0 : p == 1 ? 1e30 : (double)NAN;
            render(&s);
            gbuffer g = built();
            assert_exact(&g, 1e-5);
            gbuffer_free(&g);
            drop(Z, Z); // P alone says it too
            g = built();
            assert_exact(&g, 1e-5);
            gbuffer_free(&g);
        }
}

// The world's origin may lie on a visible surface: the pixel that shows exactly (0, 0, 0) is no hole.
static void test_origin_is_a_place(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    size_t i = (size_t)(H / 2) * W + W / 4;
    assert_true(true_depth[i] > 0);
    s.shift = v3(-(double)pixels[PX][i], -(double)pixels[PY][i], -(double)pixels[PZ][i]);
    render(&s);
    pixels[PX][i] = pixels[PY][i] = pixels[PZ][i] = 0;
    gbuffer g = built();
    assert_exact(&g, 1e-5);
    gbuffer_free(&g);
    // The same P elsewhere, with a valid depth that does not agree, is missing data; so it is with a background depth.
    size_t wrong = (size_t)(H - 5) * W + 10;
    pixels[PX][wrong] = pixels[PY][wrong] = pixels[PZ][wrong] = 0;
    pixels[Z][i] = 1e10f;
    g = built();
    assert_true(g.depth[wrong] == 0 && g.depth[i] == 0);
    gbuffer_free(&g);
}

static void test_bad_positions(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    uint64_t random = 17;
    for (size_t i = 0; i < N; i++)
        if (true_depth[i] > 0 && solve_random(&random) % 3 == 0)
            for (int c = PX; c <= PZ; c++) pixels[c][i] = (float)(solve_random(&random) % 1000) * 0.01f - 5;
    gbuffer g = built();
    assert_true(fabs(g.camera.fx / 180 - 1) < 1e-4);
    // Depth comes to the rescue, but for the few that happen to land near their own ray.
    double d, n;
    compare(&g, &d, &n, 1e-4, 1e-3);
    assert_true(d < 0.003 && n == 0);
    for (size_t i = 0; i < N; i++) assert_int_equal(g.depth[i] > 0, true_depth[i] > 0);
    gbuffer_free(&g);
}

static void test_moved_onto_the_ray(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        scene s = base_scene(kind ? CAMERA_ORTHOGRAPHIC : CAMERA_PERSPECTIVE);
        s.jitter = 1.0;
        render(&s);
        gbuffer g = built();
        double d, n, unmoved;
        compare(&g, &d, &n, 2e-3, 0.1);
        assert_true(d < 0.02 && n < 0.05);
        assert_true(g.off_ray > g.valid * 8 / 10);
        size_t off = 0;
        for (size_t i = 0; i < N; i++)
            off += true_depth[i] > 0 && pixels[Z][i] < 1e9f && fabs((double)pixels[Z][i] / true_depth[i] - 1) > 2e-3;
        unmoved = (double)off / (double)g.valid;
        assert_true(unmoved > 5 * d); // the picture as stored is clearly worse
        gbuffer_free(&g);
    }
}

static void test_half_positions(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.shift = v3(40, -90, 20);
    render(&s);
    static uint16_t half[3][N];
    for (int c = 0; c < 3; c++) {
        for (size_t i = 0; i < N; i++) half[c][i] = float_to_half(pixels[PX + c][i]);
        channels[PX + c].type = SAMPLE_HALF, channels[PX + c].data = half[c];
    }
    gbuffer g = built();
    assert_false(g.depth_from_position);
    double d, n;
    compare(&g, &d, &n, 1e-4, 0.02);
    assert_true(d == 0 && n < 0.01);
    gbuffer_free(&g);
}

static void test_far_from_the_origin(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.shift = v3(20000, -90000, 3000);
    render(&s);
    gbuffer g = built();
    double d, n;
    compare(&g, &d, &n, 1e-4, 0.01);
    assert_true(d == 0 && n < 0.01);
    gbuffer_free(&g);
}

static void test_depth_only(void **state)
{
    (void)state;
    for (int radial = 0; radial < 2; radial++) {
        scene s = base_scene(CAMERA_PERSPECTIVE);
        s.radial = radial;
        render(&s);
        drop(PX, NZ);
        gbuffer g;
        error e = {0};
        assert_false(try_build(NULL, (gbuffer_options){0}, &g, &e));
        assert_int_equal(e.code, ERR_INPUT);
        assert_non_null(strstr(e.message, "--fov"));
        double fov = 2 * atan(W / 360.0) * 180 / 3.14159265358979323846;
        resolve_options ro = {.depth = radial ? DEPTH_RADIAL : DEPTH_AUTO};
        g = built_with(&ro, (gbuffer_options){.fov = fov});
        double d, n;
        compare(&g, &d, &n, 1e-5, 0.05);
        assert_true(d == 0 && n < 0.03);
        for (size_t i = 0; i < N; i++) assert_int_equal(g.depth[i] > 0, true_depth[i] > 0);
        assert_true(g.normals_from_depth && !g.depth_from_position && !g.camera.has_world && g.camera.source == CAMERA_FROM_FLAG);
        gbuffer_free(&g);
    }
}

static void test_lens_given_with_positions(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    double fov = 2 * atan(W / 360.0) * 180 / 3.14159265358979323846;
    gbuffer g = built_with(NULL, (gbuffer_options){.fov = fov});
    assert_int_equal(g.camera.source, CAMERA_FROM_FLAG);
    assert_true(g.camera.has_world && g.camera.residual < 0.01);
    assert_exact(&g, 1e-5);
    gbuffer_free(&g);
}

static void test_one_plane(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.only_plane = true;
    render(&s);
    gbuffer g = built();
    assert_int_equal(g.camera.source, CAMERA_FROM_PLANE);
    assert_true(fabs(g.camera.fx / 180 - 1) < 1e-4);
    assert_exact(&g, 1e-5);
    gbuffer_free(&g);
    drop(Z, Z);
    error e = {0};
    assert_false(try_build(NULL, (gbuffer_options){0}, &g, &e));
    assert_non_null(strstr(e.message, "--camera"));
    assert_string_equal(e.file, "in.exr");
}

static void test_camera_space_positions(void **state)
{
    (void)state;
    // OpenGL's axes: y up, z backwards, for P and N, under names that do not promise world space.
    static char *const plain[] = {"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "Z"};
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    for (size_t i = 0; i < N; i++) {
        if (!(true_depth[i] > 0)) continue;
        vec3 p = v3((double)pixels[PX][i], (double)pixels[PY][i], (double)pixels[PZ][i]), c = camera_from_world(&s.camera, p);
        put(PX, i, v3(c.x, -c.y, -c.z));
        put(NX, i, v3(true_normal[i].x, -true_normal[i].y, -true_normal[i].z));
    }
    for (int c = PX; c <= Z; c++) channels[c].name = plain[c];
    gbuffer g = built();
    assert_true(g.position_is_camera_space && !g.camera.has_world);
    assert_exact(&g, 1e-5);
    gbuffer_free(&g);
}

// Normals in camera space, or stored as 0..1, beside world positions: measured, not believed.
static void test_odd_normals(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    for (int odd = 0; odd < 4; odd++) {
        render(&s);
        for (size_t i = 0; i < N; i++) {
            vec3 n = true_normal[i], w = v3((double)pixels[NX][i], (double)pixels[NY][i], (double)pixels[NZ][i]);
            if (odd == 0) n = v3(n.x, -n.y, -n.z);
            if (odd == 1) n = v3(n.x, -n.y, n.z);
            if (odd == 2) n = v3(w.x * 0.5 + 0.5, w.y * 0.5 + 0.5, w.z * 0.5 + 0.5);
            if (odd == 3) n = v3(n.x * 0.5 + 0.5, -n.y * 0.5 + 0.5, -n.z * 0.5 + 0.5);
            put(NX, i, n);
        }
        gbuffer g = built();
        assert_false(g.normals_from_depth);
        assert_exact(&g, 1e-5);
        gbuffer_free(&g);
    }
}

static void test_damaged_normals(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    uint64_t random = 21;
    for (size_t i = 0; i < N; i++) {
        uint64_t what = solve_random(&random) % 8;
        for (int c = NX; c <= NZ; c++) {
            if (what == 0) pixels[c][i] = 0;
            if (what == 1) pixels[c][i] = NAN;
            if (what == 2) pixels[c][i] *= -1; // the back of a double-sided surface
            if (what == 3) pixels[c][i] *= 0.4f;
        }
    }
    gbuffer g = built();
    double d, n;
    compare(&g, &d, &n, 1e-5, 0.05);
    assert_true(d == 0 && n < 0.02);
    gbuffer_free(&g);
}

// Opaque film: alpha is 1 throughout, coverage is the length of the averaged normal; transparent film: alpha.
static void test_coverage(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.averaged_edges = true, s.no_ground = true;
    for (int film = 0; film < 2; film++) {
        render(&s);
        for (size_t i = 0; film && i < N; i++) {
            vec3 n = v3((double)pixels[NX][i], (double)pixels[NY][i], (double)pixels[NZ][i]);
            pixels[A][i] = (float)(0.5 * v3_length(n));
            if (true_depth[i] > 0 && true_normal[i].z < -0.3) pixels[A][i] = 0.9f;
        }
        gbuffer g = built_with(NULL, (gbuffer_options){.need = NEED_COVERAGE});
        size_t soft = 0, fringe = 0;
        for (int y = 1; y < H - 1; y++)
            for (int x = 1; x < W - 1; x++) {
                size_t i = (size_t)y * W + (size_t)x;
                double k = (double)g.coverage[i];
                int around = 0;
                for (int j = 0; j < 9; j++) around += true_depth[(size_t)(y + j / 3 - 1) * W + (size_t)(x + j % 3 - 1)] > 0;
                assert_true(k >= 0 && k <= 1);
                if (around == 0) assert_true(k < 0.75);
                if (around == 9) assert_true(k == 1);
                if (around > 0 && around < 9) {
                    vec3 n = v3((double)pixels[NX][i], (double)pixels[NY][i], (double)pixels[NZ][i]);
                    assert_true(fabs(k - (film ? (double)pixels[A][i] : fmin(v3_length(n), 1))) < 1e-6);
                    soft += k > 0.1 && k < 0.9;
                }
                if (g.depth[i] == 0 && k > 0) {
                    const float *n = g.normal + 4 * i;
                    assert_true(fabs(sqrt((double)(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])) - 1) < 1e-5);
                    fringe++;
                }
                if (g.depth[i] == 0 && k == 0) assert_true(g.normal[4 * i] == 0 && g.normal[4 * i + 2] == 0);
            }
        assert_true(soft > 20 && fringe > 10);
        gbuffer_free(&g);
    }
}

static void test_colours(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    pixels[R][0] = NAN, pixels[G][0] = INFINITY, pixels[B][0] = -INFINITY, pixels[A][0] = 0.5f;
    pixels[AR][1] = 1e38f, pixels[ROUGH][2] = 7;
    gbuffer g = built_with(NULL, (gbuffer_options){.need = NEED_ALBEDO | NEED_BEAUTY | NEED_MATERIAL | NEED_EMISSION});
    assert_true(g.beauty[0] == 0 && g.beauty[1] == 1e30f && g.beauty[2] == 0 && g.beauty[3] == 0.5f && g.has_alpha);
    assert_true(g.albedo[4] == 1e30f && g.albedo[5] == 0.5f && g.albedo[7] == 0);
    assert_true(g.material[0] == 0.3f && g.material[1] == 0 && g.material[4] == 1);
    assert_null(g.emission);
    assert_null(g.diffuse_direct);
    assert_null(g.coverage);
    size_t i = (size_t)7 * W + 9;
    assert_true(g.beauty[4 * i] == 9 && g.beauty[4 * i + 1] == 7 && g.beauty[4 * i + 3] == 1);
    gbuffer_free(&g);
    drop(A, A);
    g = built_with(NULL, (gbuffer_options){.need = NEED_BEAUTY});
    assert_true(g.beauty[3] == 1 && !g.has_alpha);
    assert_null(g.albedo);
    gbuffer_free(&g);
}

static void test_nothing_there(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.no_ground = s.only_plane = true;
    render(&s);
    gbuffer g = built_with(NULL, (gbuffer_options){.need = NEED_COVERAGE | NEED_ALBEDO});
    assert_true(g.valid == 0 && g.extent == 0 && gbuffer_auto_radius(&g) == 0 && g.camera.fx > 0);
    gbuffer_free(&g);
}

// The radius scales with the scene.
static void test_radius_is_unit_free(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    gbuffer g = built();
    double radius = gbuffer_auto_radius(&g);
    gbuffer_free(&g);
    for (int c = PX; c <= PZ; c++)
        for (size_t i = 0; i < N; i++) pixels[c][i] *= 1024;
    for (size_t i = 0; i < N; i++) pixels[Z][i] *= pixels[Z][i] < 1e9f ? 1024 : 1;
    g = built();
    assert_true(fabs(gbuffer_auto_radius(&g) / radius / 1024 - 1) < 1e-5);
    gbuffer_free(&g);
}

static void test_same_bits_for_any_threads(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.jitter = 1.0;
    render(&s);
    gbuffer g[2];
    for (int i = 0; i < 2; i++) {
        resolution r;
        error e = {0};
        assert_true(resolve_channels(&file, &(resolve_options){0}, &r, NULL, &e));
        assert_true(gbuffer_build(&file, &r, &(gbuffer_options){.need = NEED_COVERAGE, .threads = i ? 7 : 1}, &g[i], NULL, &e));
    }
    assert_memory_equal(g[0].depth, g[1].depth, N * sizeof(float));
    assert_memory_equal(g[0].normal, g[1].normal, 4 * N * sizeof(float));
    assert_memory_equal(g[0].coverage, g[1].coverage, N * sizeof(float));
    assert_true(g[0].extent == g[1].extent && g[0].off_ray == g[1].off_ray);
    for (int i = 0; i < 2; i++) gbuffer_free(&g[i]);
}

// A crop: the data window is a part of the display window, and the centre of projection lies off its middle.
static void test_data_window(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.camera.cx += 70, s.camera.cy -= 40;
    render(&s);
    part.data_window = (box2){30, 50, 30 + W - 1, 50 + H - 1};
    part.display_window = (box2){0, 0, 299, 199};
    gbuffer g = built();
    assert_exact(&g, 1e-5);
    assert_true(g.width == W && g.height == H && g.data_window.x0 == 30 && fabs(g.camera.cx - W / 2.0 - 70) < 0.01);
    gbuffer_free(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_perspective),
        cmocka_unit_test(test_radial_is_measured),
        cmocka_unit_test(test_orthographic),
        cmocka_unit_test(test_backgrounds),
        cmocka_unit_test(test_origin_is_a_place),
        cmocka_unit_test(test_bad_positions),
        cmocka_unit_test(test_moved_onto_the_ray),
        cmocka_unit_test(test_half_positions),
        cmocka_unit_test(test_far_from_the_origin),
        cmocka_unit_test(test_depth_only),
        cmocka_unit_test(test_lens_given_with_positions),
        cmocka_unit_test(test_one_plane),
        cmocka_unit_test(test_camera_space_positions),
        cmocka_unit_test(test_odd_normals),
        cmocka_unit_test(test_damaged_normals),
        cmocka_unit_test(test_coverage),
        cmocka_unit_test(test_colours),
        cmocka_unit_test(test_nothing_there),
        cmocka_unit_test(test_radius_is_unit_free),
        cmocka_unit_test(test_data_window),
        cmocka_unit_test(test_same_bits_for_any_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
