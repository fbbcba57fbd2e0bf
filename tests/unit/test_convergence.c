// Each shader method against its own brute-force reference on the same layers (tests/README.md, reference A): the error must fall
// as samples grow, on every generated scene. That it ends at zero, to less than an error of 5 % in cosine, weight, thickness or
// measure makes, is the matter of test_bias.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "method_fixture.h"
#include "must.h"

enum { PIXELS = 300, WIDTH = 96, HEIGHT = 66, MOST = 1024 };

static void fixture_make(fixture *f, const listed_scene *from)
{
    static scene s;
    error e = {0};
    from->build(&s);
    view v = listed_view(from, &s, WIDTH, HEIGHT);
    must(fixture_open(f, &s, &v, PIXELS, &e), &e);
}

// What arc has instead of a reference: its own limit, from other seeds than the one that is compared.
static void expect_own_limit(rig *r, fixture *f, const method *m, pass_settings set)
{
    enum { SEEDS = 2 };
    error e = {0};
    for (int i = 0; i < f->count; i++) f->expected[i] = 0.0;
    set.samples = 4 * MOST;
    for (set.seed = 1; set.seed <= SEEDS; set.seed++) {
        frame_result out;
        must(rig_run(r, &f->gb, m, &set, 1 << LAYER_OCCLUSION, &out, &e), &e);
        for (int i = 0; i < f->count; i++)
            f->expected[i] += (double)out.layers[LAYER_OCCLUSION][f->pixels[i].y * WIDTH + f->pixels[i].x] / SEEDS;
        rig_free_result(&out);
    }
}

static bool falls(rig *r, fixture *f, const method *m, const char *where)
{
    error e = {0};
    figures g;
    double before = INFINITY;
    bool good = true;
    pass_settings set = rig_settings(m, f->s.radius);
    set.thickness = m->thickness * f->s.radius;
    set.planes = true;
    if (method_has_reference(m))
        fixture_expect(f, m, &set, true);
    else
        expect_own_limit(r, f, m, set);
    print_message("%-10s %-13s rmse", m->name, where);
    for (set.samples = 16; set.samples <= MOST; set.samples *= 4) {
        must(fixture_compare(f, r, m, &set, &g, &e), &e);
        print_message(" %.5f", g.rmse);
        good = good && g.rmse < before;
        before = g.rmse;
    }
    print_message(" at 16 64 256 1024 samples%s\n", good ? "" : "  <-- does not fall");
    return good;
}

static void error_falls_with_samples(void **state)
{
    (void)state;
    static fixture f;
    rig r;
    error e = {0};
    int bad = 0;
    must(rig_open(&r, NULL, &e), &e);
    for (const listed_scene *l = scene_list; l->name; l++) {
        fixture_make(&f, l);
        for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE))
            bad += !falls(&r, &f, m, l->name);
        fixture_close(&f);
    }
    rig_close(&r);
    if (bad) fail_msg("the error of %d pairs of method and scene does not fall", bad);
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
    size_t pixels = (size_t)(f->gb.width * f->gb.height);
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
            x[k] = (double)out.layers[LAYER_INDIRECT][3 * (f->pixels[i].y * f->gb.width + f->pixels[i].x) + k];
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
    static scene s;
    for (int clutter = 0; clutter < 2; clutter++) {
        error e = {0};
        (clutter ? scene_clutter : patches_scene)(&s);
        view v = view_perspective(160, 110, clutter ? 50.0 : 25.0, 1.0);
        view_scene(&v, &s);
        must(fixture_open(&f, &s, &v, PIXELS, &e), &e);
        bounce_matches(&f, 0.10, 0.02);
        fixture_close(&f);
    }
}

// test_convergence [FILTER]
int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(error_falls_with_samples), cmocka_unit_test(ssdo_bounce_matches)};
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests_name("convergence", tests, NULL, NULL);
}
