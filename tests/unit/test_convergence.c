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

#include "must.h"
#include "reference.h"
#include "rig.h"
#include "scene_picture.h"

enum { PIXELS = 300, WIDTH = 160, HEIGHT = 110 };

typedef struct fixture {
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
    build(&f->s);
    f->v = view_perspective(WIDTH, HEIGHT, fov, 1.0);
    view_scene(&f->v, &f->s);
    must(scene_gbuffer(&f->s, &f->v, &f->gb, &e), &e);
    must(layer_build(&f->gb, &f->l, &e), &e);
    f->count = reference_pixels(&f->l, PIXELS, f->pixels);
    assert_true(f->count > PIXELS / 6);
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

static void converges_with(fixture *f, const method *m, pass_settings set, double rmse_limit, double bias_limit)
{
    rig r;
    error e = {0};
    must(rig_open(&r, NULL, &e), &e);
    double before = INFINITY;
    figures g = {0};
    for (int n = 16; n <= 4096; n *= 4) {
        set.samples = n;
        g = compare(&r, f, m, set);
        print_message("%s N=%d: rmse %.5f bias %+.5f\n", m->name, n, g.rmse, g.bias);
        assert_true(g.rmse < before);
        before = g.rmse;
    }
    rig_close(&r);
    if (g.rmse > rmse_limit || fabs(g.bias) > bias_limit)
        fail_msg("%s: rmse %.5f (limit %g), bias %+.5f (limit %g) at 4096 samples", m->name, g.rmse, rmse_limit, g.bias,
                 bias_limit);
}

static void converges(fixture *f, const char *name, double thickness, double rmse_limit, double bias_limit)
{
    pass_settings set = rig_settings(method_find(name), f->s.radius);
    set.thickness = thickness;
    converges_with(f, method_find(name), set, rmse_limit, bias_limit);
}

static void ssdo_converges(void **state)
{
    (void)state;
    static fixture f;
    fixture_make(&f, scene_clutter, 50.0);
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
    fixture_make(&f, scene_clutter, 50.0);
    reference_alchemy_options o = {.radius = f.s.radius, .bias = 0.0, .measure = TAPS_UNIFORM_IN_RADIUS};
    for (int i = 0; i < f.count; i++) f.expected[i] = fmax(0.0, 1.0 - reference_alchemy(&f.l, f.pixels[i], &o));
    converges(&f, "alchemy", INFINITY, 0.008, 0.001);
    fixture_free(&f);
}

static void hemisphere_converges(void **state)
{
    (void)state;
    static fixture f;
    fixture_make(&f, scene_clutter, 50.0);
    reference_hemisphere_options o = {.radius = f.s.radius, .elevations = 40, .azimuths = 40, .distances = 40};
    for (int i = 0; i < f.count; i++) f.expected[i] = reference_hemisphere(&f.l, f.pixels[i], &o);
    converges(&f, "hemisphere", INFINITY, 0.003, 0.001);
    fixture_free(&f);
}

static void hbao_converges(void **state)
{
    (void)state;
    static fixture f;
    fixture_make(&f, scene_clutter, 50.0);
    for (int bias = 0; bias <= 20; bias += 20) {
        reference_hbao_options o = {.radius = f.s.radius, .bias = bias * M_PI / 180.0};
        for (int i = 0; i < f.count; i++) f.expected[i] = fmax(0.0, reference_hbao(&f.l, f.pixels[i], &o));
        pass_settings set = rig_settings(method_find("hbao"), f.s.radius);
        set.angle_bias = bias;
        converges_with(&f, method_find("hbao"), set, 0.01, 0.004);
    }
    fixture_free(&f);
}

// The bounce against the reference's: right sign, the disc form factor's value, bounded sum. The senders are lit with the
// shader's own radiance. The bound B / sum F is taken of noisy sums in the shader, of expected ones in the reference, hence the
// limits.
static void bounce_matches(fixture *f, double relative_limit, double gain_limit)
{
    enum { N = 1024 };
    const method *m = method_find("ssdo");
    rig r;
    error e = {0};
    frame_result out;
    must(rig_open(&r, &(env_options){.up_z = true, .scale = 1.0}, &e), &e);
    pass_settings set = rig_settings(m, f->s.radius);
    set.samples = N;
    must(rig_run(&r, &f->gb, m, &set, 1 << LAYER_RADIANCE | 1 << LAYER_INDIRECT, &out, &e), &e);
    size_t pixels = WIDTH * HEIGHT;
    float *senders = calloc(pixels * 4, sizeof *senders);
    assert_non_null(senders);
    for (size_t i = 0; i < 3 * pixels; i++) senders[i / 3 * 4 + i % 3] = out.layers[LAYER_RADIANCE][i];
    reference_ssdo_options o = {.radius = f->s.radius,
                                .thickness = INFINITY,
                                .elevations = 24,
                                .azimuths = 32,
                                .distances = 24,
                                .sender_radiance = senders,
                                .patches = N,
                                .fade_start = 0.75,
                                .fade_smooth = true};
    double sd = 0, st = 0, sxt = 0;
    for (int i = 0; i < f->count; i++) {
        double x[3], t[3];
        vec3 expected = reference_ssdo(&f->l, f->pixels[i], &o).indirect;
        t[0] = expected.x, t[1] = expected.y, t[2] = expected.z;
        for (int k = 0; k < 3; k++) {
            x[k] = (double)out.layers[LAYER_INDIRECT][3 * (f->pixels[i].y * WIDTH + f->pixels[i].x) + k];
            sd += (x[k] - t[k]) * (x[k] - t[k]), st += t[k] * t[k], sxt += x[k] * t[k];
        }
    }
    print_message("bounce: relative rms difference %.4f, gain %.4f\n", sqrt(sd / st), sxt / st);
    assert_true(st > 0.0);
    if (sqrt(sd / st) > relative_limit || fabs(sxt / st - 1.0) > gain_limit)
        fail_msg("bounce: relative rms difference %.4f, gain %.4f", sqrt(sd / st), sxt / st);
    free(senders);
    rig_free_result(&out);
    rig_close(&r);
}

static void patches_scene(scene *s) { scene_patches(s, 1.0, 0.5); }

static void ssdo_bounce_matches(void **state)
{
    (void)state;
    static fixture f;
    fixture_make(&f, patches_scene, 25.0);
    bounce_matches(&f, 0.10, 0.02);
    fixture_free(&f);
    fixture_make(&f, scene_clutter, 50.0);
    bounce_matches(&f, 0.10, 0.02);
    fixture_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(ssdo_converges), cmocka_unit_test(alchemy_converges),
                                       cmocka_unit_test(hemisphere_converges), cmocka_unit_test(hbao_converges),
                                       cmocka_unit_test(ssdo_bounce_matches)};
    return cmocka_run_group_tests_name("convergence", tests, NULL, NULL);
}
