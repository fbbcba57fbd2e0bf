// Closed forms of shaders/README.md, invariant 2, by every method that claims cosine-weighted visibility, with as many samples as
// 64 slices of 64 steps: within 0.01. The others against what they assume, on the same scenes.
//
// A method is held to what it assumes. VISIBILITY: the true open share. HORIZON: the same where nothing overhangs, and its own
// brute-force reference where something does. POINTS: the share of the points of the hemisphere ball that the camera sees. OWN:
// its own brute-force reference.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "method_reference.h"
#include "must.h"
#include "reference.h"
#include "rig.h"
#include "scene_picture.h"
#include "truth.h"

enum { WIDTH = 112, HEIGHT = 76, REACH = 6, STEP = 3, SAMPLES = 8192 }; // 64 x 64 on both sides
static const double LIMIT = 0.01;

typedef enum assumption { VISIBILITY, HORIZON, POINTS, OWN } assumption;

static assumption assumption_of(const method *m)
{
    if (m->weight != WEIGHS_COSINE) return OWN;
    if (strcmp(m->name, "gtao") == 0 || strcmp(m->name, "bitmask") == 0) return HORIZON; // tested with endless thickness
    return m->reach == REACH_POINTS ? POINTS : VISIBILITY;
}

typedef struct fixture {
    const char *name;
    scene s;
    view v;
    gbuffer gb;
    layer l;
    bool overhang;
    double (*truth)(const struct fixture *f, vec3 ground);
} fixture;

static double wall_truth(const fixture *f, vec3 p) { return truth_wall_cutoff(M_PI / 3.0, -p.y, f->s.radius); }
static double corner_truth(const fixture *f, vec3 p) { return truth_corner(-p.y, f->s.radius); }
static double sphere_truth(const fixture *f, vec3 p)
{
    const shape *ball = &f->s.shapes[f->s.shape_count - 1];
    return truth_sphere(ball->radius, ball->at.z, hypot(p.x, p.y));
}
// The closed form has no cutoff; this is the same quadrature that test_truth holds against it.
static double slit_truth(const fixture *f, vec3 p)
{
    tracer t = scene_tracer(&f->s);
    return truth_occlusion(&t, p, v3(0, 0, 1), &(truth_options){.radius = f->s.radius, .rays = 16384, .seed = 1});
}

static void build_wall(scene *s) { scene_wall(s, 60.0, 0.4); }
static void build_corner(scene *s) { scene_corner(s, 0.4); }
static void build_near_corner(scene *s) { scene_corner(s, 0.15); }
static void build_sphere(scene *s)
{
    scene_sphere(s, 1.0, 1.0, 2.0);
    s->radius = 3.4;
}
static void build_slit(scene *s)
{
    scene_slit(s, 1.0, 1.0);
    s->radius = 1.5;
}

static void fixture_make(fixture *f, const char *name, void (*build)(scene *), double (*truth)(const fixture *, vec3),
                         bool overhang)
{
    error e = {0};
    *f = (fixture){.name = name, .truth = truth, .overhang = overhang};
    build(&f->s);
    f->v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&f->v, &f->s);
    must(scene_gbuffer(&f->s, &f->v, &f->gb, &e), &e);
    must(layer_build(&f->gb, &f->l, &e), &e);
}

static void fixture_free(fixture *f)
{
    layer_free(&f->l);
    gbuffer_free(&f->gb);
}

// Share of the points P + lambda w (w by cosine, lambda uniform in (0, R]) that the camera sees or that lie outside the frame.
static double seen_share(const fixture *f, vec3 p)
{
    enum { DIRECTIONS = 32, DISTANCES = 16 };
    tracer t = scene_tracer(&f->s);
    vec3 eye = f->v.camera.origin;
    int seen = 0;
    for (int i = 0; i < DIRECTIONS * DIRECTIONS; i++) {
        vec3 w = truth_direction(v3(0, 0, 1), i, DIRECTIONS, 1);
        double shift = 0.7548776662466927 * i;
        for (int k = 0; k < DISTANCES; k++) {
            vec3 at = v3_add(p, v3_scale(w, f->s.radius * (k + 1.0 - (shift - floor(shift))) / DISTANCES));
            double x, y, z;
            bool inside = view_project(&f->v, at, &x, &y, &z) && x >= 0 && y >= 0 && x < WIDTH && y < HEIGHT;
            seen += !inside || !t.blocked(t.data, eye, v3_sub(at, eye), 0.0, 1.0 - 1e-9);
        }
    }
    return (double)seen / (DIRECTIONS * DIRECTIONS * DISTANCES);
}

static double expected_at(const fixture *f, const method *m, const pass_settings *set, pixel p, vec3 ground)
{
    assumption a = assumption_of(m);
    if (a == OWN) return method_reference(&f->l, p, &(method_reference_options){.method = m, .set = set}).occlusion;
    if (a == POINTS) return seen_share(f, ground);
    if (a == HORIZON && f->overhang)
        return reference_horizon(&f->l, p, &(reference_slice_options){.radius = f->s.radius, .slices = 128});
    return f->truth(f, ground);
}

// Mean error over the ground pixels around the scene's point.
static double error_near_point(const fixture *f, const method *m, const pass_settings *set, const float *occlusion,
                               double *expected)
{
    double x, y, z, sum = 0.0;
    int n = 0;
    *expected = 0.0;
    assert_true(view_project(&f->v, f->s.point, &x, &y, &z));
    for (int dy = -REACH; dy <= REACH; dy += STEP)
        for (int dx = -REACH; dx <= REACH; dx += STEP) {
            pixel p = {(int)x + dx, (int)y + dy};
            hit h;
            if (p.y < 0 || p.y >= HEIGHT || !scene_at_pixel(&f->s, &f->v, p.x, p.y, &h) || h.position.z > 1e-6) continue;
            double wanted = expected_at(f, m, set, p, h.position);
            sum += (double)occlusion[p.y * WIDTH + p.x] - wanted;
            *expected += wanted;
            n++;
        }
    assert_true(n >= 6);
    *expected /= n;
    return sum / n;
}

static bool check(rig *r, const fixture *f, const method *m)
{
    error e = {0};
    frame_result out;
    assumption a = assumption_of(m);
    assert_true(a != OWN || method_has_reference(m));
    pass_settings set = rig_settings(m, f->s.radius);
    set.samples = SAMPLES;
    set.thickness = a == VISIBILITY ? m->thickness * f->s.radius : INFINITY;
    set.planes = true;
    must(rig_run(r, &f->gb, m, &set, 1 << LAYER_OCCLUSION, &out, &e), &e);
    double expected, got = error_near_point(f, m, &set, out.layers[LAYER_OCCLUSION], &expected);
    bool good = fabs(got) <= LIMIT;
    print_message("%-8s %-12s expected %.4f, error %+.4f%s\n", m->name, f->name, expected, got, good ? "" : "  <-- too large");
    rig_free_result(&out);
    return good;
}

static void closed_forms(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        void (*build)(scene *);
        double (*truth)(const fixture *, vec3);
        bool overhang;
    } list[] = {{"wall", build_wall, wall_truth, false},
                {"corner", build_corner, corner_truth, false},
                {"near corner", build_near_corner, corner_truth, false},
                {"sphere", build_sphere, sphere_truth, true},
                {"slit", build_slit, slit_truth, false}};
    static fixture f;
    static rig r;
    error e = {0};
    int bad = 0;
    must(rig_open(&r, NULL, &e), &e);
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        fixture_make(&f, list[i].name, list[i].build, list[i].truth, list[i].overhang);
        for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) bad += !check(&r, &f, m);
        fixture_free(&f);
    }
    rig_close(&r);
    if (bad) fail_msg("%d closed forms are missed by more than %g", bad, LIMIT);
}

// The general expectation of the point test, against its closed form at a corner.
static void points_expect_what_the_corner_says(void **state)
{
    (void)state;
    static fixture f;
    fixture_make(&f, "corner", build_corner, corner_truth, false);
    double a = seen_share(&f, v3(0, -0.4, 0)), b = truth_corner_point_test(0.4, f.s.radius);
    fixture_free(&f);
    if (fabs(a - b) > 0.003) fail_msg("quadrature %.5f, closed form %.5f", a, b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(points_expect_what_the_corner_says), cmocka_unit_test(closed_forms)};
    return cmocka_run_group_tests_name("closed forms", tests, NULL, NULL);
}
