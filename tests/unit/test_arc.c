// The slice methods against their own references on the same layers (THEORY.md 4, reference A) and against closed forms.
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
#include "truth.h"

enum { PIXELS = 300, WIDTH = 160, HEIGHT = 110 };

static void must(bool ok, const error *e)
{
    char text[1024];
    if (ok) return;
    err_format(e, text, sizeof text);
    fail_msg("%s", text);
}

typedef struct fixture {
    rig r;
    scene s;
    view v;
    gbuffer gb;
    layer l;
    pixel pixels[PIXELS];
    int count;
    double expected[PIXELS];
} fixture;

static void fixture_make(fixture *f, void (*build)(scene *), double fov)
{
    error e = {0};
    *f = (fixture){0};
    must(rig_open(&f->r, NULL, &e), &e);
    build(&f->s);
    f->v = fov > 0.0 ? view_perspective(WIDTH, HEIGHT, fov, 1.0) : view_orthographic(WIDTH, HEIGHT, 8.0, 1.0);
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
    rig_close(&f->r);
}

// Root mean square difference from what is expected, and the mean difference.
static double difference(fixture *f, const char *name, pass_settings set, double *bias)
{
    error e = {0};
    frame_result out;
    must(rig_run(&f->r, &f->gb, method_find(name), &set, 1 << LAYER_OCCLUSION, &out, &e), &e);
    double sum = 0.0;
    *bias = 0.0;
    for (int i = 0; i < f->count; i++) {
        double d = (double)out.layers[LAYER_OCCLUSION][f->pixels[i].y * WIDTH + f->pixels[i].x] - f->expected[i];
        sum += d * d / f->count;
        *bias += d / f->count;
    }
    rig_free_result(&out);
    return sqrt(sum);
}

static void converges(fixture *f, const char *name, double thickness, double rmse_limit, double bias_limit)
{
    double before = INFINITY, rmse = 0.0, bias = 0.0;
    for (int n = 16; n <= 4096; n *= 4) {
        pass_settings set = rig_settings(method_find(name), f->s.radius);
        set.samples = n;
        set.thickness = thickness;
        rmse = difference(f, name, set, &bias);
        print_message("%s N=%d: rmse %.5f bias %+.5f\n", name, n, rmse, bias);
        assert_true(rmse < before);
        before = rmse;
    }
    if (rmse > rmse_limit || fabs(bias) > bias_limit)
        fail_msg("%s: rmse %.5f (limit %g), bias %+.5f (limit %g)", name, rmse, rmse_limit, bias, bias_limit);
}

static void horizon_converges(void **state)
{
    (void)state;
    static fixture f;
    for (double fov = 0.0; fov < 80.0; fov += 35.0) {
        fixture_make(&f, scene_clutter, fov);
        reference_slice_options o = {.radius = f.s.radius, .slices = 64};
        for (int i = 0; i < f.count; i++) f.expected[i] = reference_horizon(&f.l, f.pixels[i], &o);
        converges(&f, "gtao", INFINITY, 0.02, 0.005);
        fixture_free(&f);
    }
}

static void bitmask_converges(void **state)
{
    (void)state;
    static fixture f;
    for (double share = 0.2; share < 1.0; share += 0.5) {
        fixture_make(&f, scene_clutter, 50.0);
        reference_slice_options o = {.radius = f.s.radius, .thickness = share * f.s.radius, .slices = 64};
        for (int i = 0; i < f.count; i++) f.expected[i] = reference_bitmask(&f.l, f.pixels[i], &o);
        converges(&f, "bitmask", o.thickness, 0.02, 0.005);
        fixture_free(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(horizon_converges), cmocka_unit_test(bitmask_converges)};
    return cmocka_run_group_tests_name("arc", tests, NULL, NULL);
}
