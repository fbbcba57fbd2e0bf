// s3ho: the SH vector of the visibility against the brute-force reference, its filter, its light, and relighting from a file.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "light/sh.h"
#include "must.h"
#include "near.h"
#include "pipeline/frame.h"
#include "reference.h"
#include "rig.h"
#include "scene_picture.h"

enum { PIXELS = 200, WIDTH = 160, HEIGHT = 110, SH_LAYERS = 1 << LAYER_SH_0 | 1 << LAYER_SH_1 | 1 << LAYER_SH_2 };

static vec3 direction(int i)
{
    double z = 1.0 - (i % 97 + 0.5) / 48.5, phi = 2.399963 * i, r = sqrt(1.0 - z * z);
    return v3(r * cos(phi), r * sin(phi), z);
}

static void turned_coefficients_give_the_same_light(void **state)
{
    (void)state;
    double in[16][3], out[16][3], a[SH_MAX], b[SH_MAX];
    for (int i = 0; i < 48; i++) in[i / 3][i % 3] = sin(1.7 * i + 0.3);
    mat3 turn = m3_mul(rotation_about(v3_normalize(v3(1, 2, 3)), 77.0), rotation_about(v3(0, 0, 1), -31.0));
    for (int mirror = 0; mirror < 2; mirror++) {
        for (int c = 0; mirror && c < 3; c++) turn.m[1][c] = -turn.m[1][c];
        sh_turn((const double(*)[3])in, turn, 4, out);
        for (int k = 0; k < 50; k++) {
            vec3 d = direction(k);
            sh_basis(d, 4, a);
            sh_basis(m3_apply(turn, d), 4, b);
            for (int c = 0; c < 3; c++) {
                double got = 0, wanted = 0;
                for (int i = 0; i < 16; i++) got += out[i][c] * a[i], wanted += in[i][c] * b[i];
                assert_near(got, wanted, 1e-12);
            }
        }
    }
}

// ---- the vector

// Y of three coefficients as a sky: its radiance is their o_lm / pi.
static vec3 basis_sky(void *data, vec3 world)
{
    double y[SH_MAX + 2] = {0};
    int first = *(int *)data;
    sh_basis(world, 4, y);
    return v3(y[first], y[first + 1], y[first + 2]);
}

typedef struct fixture {
    rig r;
    scene s;
    view v;
    gbuffer gb;
    layer l;
    pixel pixels[PIXELS];
    int count;
    double expected[PIXELS][SH_MAX + 2];
} fixture;

static void fixture_make(fixture *f)
{
    error e = {0};
    *f = (fixture){0};
    must(rig_open(&f->r, NULL, &e), &e);
    scene_clutter(&f->s);
    f->v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&f->v, &f->s);
    must(scene_gbuffer(&f->s, &f->v, &f->gb, &e), &e);
    must(layer_build(&f->gb, &f->l, &e), &e);
    f->count = reference_pixels(&f->l, PIXELS, f->pixels);
    for (int first = 0; first < SH_MAX; first += 3) {
        reference_ssdo_options o = {.radius = f->s.radius,
                                    .thickness = INFINITY,
                                    .elevations = 32,
                                    .azimuths = 40,
                                    .distances = 20,
                                    .sky = basis_sky,
                                    .sky_data = &first};
        for (int i = 0; i < f->count; i++) {
            vec3 r = v3_scale(reference_ssdo(&f->l, f->pixels[i], &o).radiance, M_PI);
            f->expected[i][first] = r.x, f->expected[i][first + 1] = r.y, f->expected[i][first + 2] = r.z;
        }
    }
}

static void fixture_free(fixture *f)
{
    layer_free(&f->l);
    gbuffer_free(&f->gb);
    rig_close(&f->r);
}

// Root mean square error of each band over its coefficients.
static void band_errors(fixture *f, pass_settings set, double rmse[4])
{
    error e = {0};
    frame_result out;
    must(rig_run(&f->r, &f->gb, method_find("s3ho"), &set, SH_LAYERS | 1 << LAYER_SH_3, &out, &e), &e);
    for (int l = 0; l < 4; l++) {
        double sum = 0.0;
        for (int c = l * l; c < (l + 1) * (l + 1); c++)
            for (int i = 0; i < f->count; i++) {
                size_t at = (size_t)(f->pixels[i].y * WIDTH + f->pixels[i].x);
                const float *three = out.layers[LAYER_SH_0 + (c < 9 ? c / 3 : 0)] + 3 * at,
                            *seven = out.layers[LAYER_SH_3] + 7 * at;
                double low_pass = exp(-0.5 * set.sh_sigma * set.sh_sigma * l * (l + 1));
                double d = (double)(c < 9 ? three[c % 3] : seven[c - 9]) - low_pass * f->expected[i][c];
                sum += d * d / f->count / (2 * l + 1);
            }
        rmse[l] = sqrt(sum);
    }
    rig_free_result(&out);
}

// Bands 0 to 3, so that the rest of them is seen to be what it is with fewer.
static void vector_converges(void **state)
{
    (void)state;
    static fixture f;
    fixture_make(&f);
    for (int smooth = 0; smooth < 2; smooth++) {
        double before = INFINITY, rmse[4];
        pass_settings set = rig_settings(method_find("s3ho"), f.s.radius);
        set.sh_bands = 3;
        set.sh_sigma = smooth ? 0.5 : 0.0;
        for (set.samples = 16; set.samples <= 4096; set.samples *= 4) {
            band_errors(&f, set, rmse);
            print_message("s3ho N=%d: rmse %.5f %.5f %.5f %.5f of bands 0 1 2 3\n", set.samples, rmse[0], rmse[1], rmse[2],
                          rmse[3]);
            assert_true(rmse[0] + rmse[1] + rmse[2] + rmse[3] < before);
            before = rmse[0] + rmse[1] + rmse[2] + rmse[3];
        }
        for (int l = 0; l < 4; l++) assert_true(rmse[l] < 0.004);
    }
    fixture_free(&f);
}

// Sixteen pixels' sets together are better than one: the filter lowers the error at few samples.
static void pattern_filter_helps(void **state)
{
    (void)state;
    static fixture f;
    double raw[4], filtered[4];
    fixture_make(&f);
    pass_settings set = rig_settings(method_find("s3ho"), f.s.radius);
    set.samples = 16, set.sh_bands = 3;
    band_errors(&f, set, raw);
    set.blur = 2;
    band_errors(&f, set, filtered);
    print_message("s3ho N=16: rmse %.5f %.5f %.5f, filtered %.5f %.5f %.5f\n", raw[0], raw[1], raw[2], filtered[0], filtered[1],
                  filtered[2]);
    for (int l = 0; l < 4; l++) assert_true(filtered[l] < 0.7 * raw[l]);
    fixture_free(&f);
}

// An open surface: o_lm = A_l Y_lm(n), A = pi, 2 pi / 3, pi / 4; exactly so in band 0, and nearly the same from any set.
static void open_plane_has_the_cosine_lobe(void **state)
{
    (void)state;
    static const double a[3] = {M_PI, 2.0 * M_PI / 3.0, M_PI / 4.0};
    rig r;
    scene s = {0};
    error e = {0};
    frame_result out;
    must(rig_open(&r, NULL, &e), &e);
    scene_tilted_plane(&s, 35.0, 4.0);
    view v = view_perspective(64, 48, 45.0, 1.0);
    view_look(&v, s.eye, s.target, 20.0);
    gbuffer gb;
    must(scene_gbuffer(&s, &v, &gb, &e), &e);
    pass_settings set = rig_settings(method_find("s3ho"), s.radius);
    set.samples = 32;
    for (set.blur = 0; set.blur <= 2; set.blur += 2) {
        must(rig_run(&r, &gb, method_find("s3ho"), &set, SH_LAYERS, &out, &e), &e);
        for (int i = 0; i < 64 * 48; i++) {
            double y[SH_MAX];
            vec3 n = v3((double)gb.normal[4 * i], (double)gb.normal[4 * i + 1], (double)gb.normal[4 * i + 2]);
            sh_basis(m3_apply(gb.camera.world_from_camera, n), 3, y);
            for (int c = 0; gb.depth[i] > 0.0f && c < 9; c++) {
                double got = (double)out.layers[LAYER_SH_0 + c / 3][3 * i + c % 3], wanted = a[c < 1 ? 0 : c < 4 ? 1 : 2] * y[c];
                bool border = i % 64 < 2 || i % 64 >= 62 || i / 64 < 2 || i / 64 >= 46; // parts of the pattern are missing there
                assert_near(got, wanted, c == 0 ? 1e-6 : set.blur && !border ? 0.001 : 0.06);
            }
        }
        rig_free_result(&out);
    }
    gbuffer_free(&gb);
    rig_close(&r);
}

// ---- files

typedef struct whole {
    options o;
    log_t log;
    job j;
    frame_result r;
} whole;

static bool run_whole(whole *x, int bands, const char *input, const char *output, const char *env, bool from_sh,
                      const char *layers, error *e)
{
    *x = (whole){0};
    options_defaults(&x->o);
    x->o.method = "s3ho";
    x->o.layers = layers;
    x->o.from_sh = from_sh;
    x->o.sh_bands = bands;
    x->o.env = env;
    x->o.env_rotate = 40.0;
    log_init(&x->log, LOG_QUIET);
    job_open(&x->j, &x->o, &x->log);
    return frame_run(&x->j, input, output, &x->r, e);
}

static void free_whole(whole *x)
{
    frame_free(&x->r);
    job_close(&x->j);
    log_free(&x->log);
}

static double band_norm(const double sh[][3], int l, int channel)
{
    double sum = 0.0;
    for (int i = l * l; i < (l + 1) * (l + 1); i++) sum += sh[i][channel] * sh[i][channel];
    return sqrt(sum);
}

// What half precision of the stored coefficients may do to the light.
static double half_bound(const whole *x, int i, int channel)
{
    double sum = 0.0;
    for (int l = 0; l <= x->o.sh_bands; l++) {
        double o = 0.0;
        for (int c = l * l; c < (l + 1) * (l + 1); c++)
            o += pow((double)(c < 9 ? x->r.layers[LAYER_SH_0 + c / 3][3 * i + c % 3] : x->r.layers[LAYER_SH_3][7 * i + c - 9]),
                     2.0);
        sum += sqrt(o) * band_norm((const double(*)[3])x->j.light.env.sh, l, channel);
    }
    return sum / M_PI / 2048.0 + 1e-5;
}

static void relights(int bands)
{
    static whole first, direct, again;
    char stored[64], output[64];
    error e = {0};
    snprintf(stored, sizeof stored, "/tmp/ssdo_s3ho_%d.exr", (int)getpid());
    snprintf(output, sizeof output, "/tmp/ssdo_s3ho_%d_out.exr", (int)getpid());
    // Stored under no environment, relit under one; directly under that one.
    must(run_whole(&first, bands, "samples/still.exr", stored, NULL, false,
                   bands == 3 ? "occlusion,sh_0,sh_1,sh_2,sh_3" : "occlusion,sh_0,sh_1,sh_2", &e),
         &e);
    must(run_whole(&direct, bands, "samples/still.exr", output, "samples/sky_sun.exr", false,
                   bands == 3 ? "occlusion,radiance,sh_0,sh_1,sh_2,sh_3" : "occlusion,radiance,sh_0,sh_1,sh_2", &e),
         &e);
    must(run_whole(&again, bands, stored, output, "samples/sky_sun.exr", true, "occlusion,radiance", &e), &e);
    int n = direct.r.gb.width * direct.r.gb.height;
    double brightest = 0.0, darkest = 1.0;
    int edges = 0; // pixels that hold a surface but whose centre missed it: they have their neighbour's vector
    for (int i = 0; i < n; i++)
        if (first.r.gb.depth[i] == 0.0f && first.r.gb.coverage[i] > 0.0f) {
            for (int k = 0; k < 3; k++) {
                const float *v = first.r.layers[LAYER_SH_0 + k] + 3 * i;
                assert_true(v[0] != 0.0f || v[1] != 0.0f || v[2] != 0.0f);
            }
            edges++;
        }
    assert_true(edges > 0);
    for (int i = 0; i < n; i++) {
        assert_near((double)again.r.layers[LAYER_OCCLUSION][i], (double)direct.r.layers[LAYER_OCCLUSION][i], 1.0 / 1024.0);
        darkest = fmin(darkest, (double)again.r.layers[LAYER_OCCLUSION][i]);
        for (int c = 0; c < 3; c++) {
            double got = (double)again.r.layers[LAYER_RADIANCE][3 * i + c],
                   wanted = (double)direct.r.layers[LAYER_RADIANCE][3 * i + c];
            assert_near(got, wanted, half_bound(&direct, i, c));
            brightest = fmax(brightest, got);
        }
    }
    assert_true(brightest > 0.1 && darkest < 0.8);
    free_whole(&first);
    free_whole(&direct);
    free_whole(&again);
    remove(stored);
    remove(output);
}

static void stored_vector_relights(void **state)
{
    (void)state;
    relights(2);
    relights(3);
}

static void missing_layers_are_named(void **state)
{
    (void)state;
    static whole x;
    char output[64];
    error e = {0};
    snprintf(output, sizeof output, "/tmp/ssdo_s3ho_%d.exr", (int)getpid());
    assert_false(run_whole(&x, 2, "samples/still.exr", output, NULL, true, "radiance", &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_string_equal(e.channel, "sh_0.R");
    free_whole(&x);
    e = (error){0};
    options_defaults(&x.o);
    x = (whole){.o = x.o};
    x.o.layers = "sh_1";
    x.o.method = "ssdo";
    log_init(&x.log, LOG_QUIET);
    job_open(&x.j, &x.o, &x.log);
    assert_false(frame_run(&x.j, "samples/still.exr", output, &x.r, &e));
    assert_non_null(strstr(e.message, "s3ho"));
    free_whole(&x);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turned_coefficients_give_the_same_light),
        cmocka_unit_test(open_plane_has_the_cosine_lobe),
        cmocka_unit_test(vector_converges),
        cmocka_unit_test(pattern_filter_helps),
        cmocka_unit_test(stored_vector_relights),
        cmocka_unit_test(missing_layers_are_named),
    };
    return cmocka_run_group_tests_name("s3ho", tests, NULL, NULL);
}
