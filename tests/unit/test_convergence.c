// Each shader method against its own brute-force reference on the same layers (THEORY.md 4, reference A): the error must fall as
// samples grow, and end below a bound that a 5 % error in cosine, weight, thickness or measure exceeds.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "reference.h"
#include "rig.h"
#include "scene_picture.h"

enum { PIXELS = 300, WIDTH = 160, HEIGHT = 110 };

static void must(bool ok, const error *e)
{
    char text[1024];
    if (ok) return;
    err_format(e, text, sizeof text);
    fail_msg("%s", text);
}

typedef struct fixture {
    scene s;
    view v;
    gbuffer gb;
    layer l;
    pixel pixels[PIXELS];
    int count;
    double expected[PIXELS];
} fixture;

static void fixture_make(fixture *f, void (*build)(scene *))
{
    error e = {0};
    *f = (fixture){0};
    build(&f->s);
    f->v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&f->v, &f->s);
    must(scene_gbuffer(&f->s, &f->v, &f->gb, &e), &e);
    must(layer_build(&f->gb, &f->l, &e), &e);
    f->count = reference_pixels(&f->l, PIXELS, f->pixels);
    assert_true(f->count > PIXELS / 4);
}

static void fixture_free(fixture *f)
{
    layer_free(&f->l);
    gbuffer_free(&f->gb);
}

typedef struct figures {
    double rmse, bias;
} figures;

static figures compare(rig *r, fixture *f, const method *m, pass_settings set)
{
    error e = {0};
    frame_result out;
    must(rig_run(r, &f->gb, m, &set, 1 << LAYER_OCCLUSION, &out, &e), &e);
    figures g = {0};
    for (int i = 0; i < f->count; i++) {
        double d = (double)out.layers[LAYER_OCCLUSION][f->pixels[i].y * WIDTH + f->pixels[i].x] - f->expected[i];
        g.rmse += d * d / f->count;
        g.bias += d / f->count;
    }
    g.rmse = sqrt(g.rmse);
    rig_free_result(&out);
    return g;
}

static void converges(fixture *f, const char *name, double thickness, double rmse_limit, double bias_limit)
{
    rig r;
    error e = {0};
    must(rig_open(&r, NULL, &e), &e);
    const method *m = method_find(name);
    double before = INFINITY;
    figures g = {0};
    for (int n = 16; n <= 4096; n *= 4) {
        pass_settings set = rig_settings(m, f->s.radius);
        set.samples = n;
        set.thickness = thickness;
        g = compare(&r, f, m, set);
        print_message("%s N=%d: rmse %.5f bias %+.5f\n", name, n, g.rmse, g.bias);
        assert_true(g.rmse < before);
        before = g.rmse;
    }
    rig_close(&r);
    if (g.rmse > rmse_limit || fabs(g.bias) > bias_limit)
        fail_msg("%s: rmse %.5f (limit %g), bias %+.5f (limit %g) at 4096 samples", name, g.rmse, rmse_limit, g.bias, bias_limit);
}

static void ssdo_converges(void **state)
{
    (void)state;
    static fixture f;
    fixture_make(&f, scene_clutter);
    for (int finite = 0; finite < 2; finite++) {
        double thickness = finite ? 0.5 * f.s.radius : INFINITY;
        reference_ssdo_options o = {
            .radius = f.s.radius, .thickness = thickness, .elevations = 32, .azimuths = 48, .distances = 24};
        for (int i = 0; i < f.count; i++) f.expected[i] = reference_ssdo(&f.l, f.pixels[i], &o).occlusion;
        converges(&f, "ssdo", thickness, 0.003, 0.001);
    }
    fixture_free(&f);
}

static void alchemy_converges(void **state)
{
    (void)state;
    static fixture f;
    fixture_make(&f, scene_clutter);
    reference_alchemy_options o = {.radius = f.s.radius, .bias = 0.0, .measure = TAPS_UNIFORM_IN_RADIUS};
    for (int i = 0; i < f.count; i++) f.expected[i] = fmax(0.0, 1.0 - reference_alchemy(&f.l, f.pixels[i], &o));
    converges(&f, "alchemy", INFINITY, 0.008, 0.001);
    fixture_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(ssdo_converges), cmocka_unit_test(alchemy_converges)};
    return cmocka_run_group_tests_name("convergence", tests, NULL, NULL);
}
