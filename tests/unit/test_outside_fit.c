// How open the outside is, learned from the picture's own light.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/mem.h"
#include "must.h"
#include "outside_rooms.h"
#include "pipeline/outside_fit.h"
#include "rig.h"
#include "truth.h"

enum { W = 96, H = 54, PIXELS = W * H, ENV_W = 64, ENV_H = 32 };

// The room seen from the window: no opening is in the picture.
static scene room_from_its_window(void)
{
    scene s = room(true, true);
    s.eye = v3(2, 4.6, 1.4), s.target = v3(1.8, 0, 1.1);
    return s;
}

// Skies of the upper half: even, or brighter towards a side.
static void paint(float *rgb, double angle, double contrast)
{
    for (int y = 0; y < ENV_H; y++)
        for (int x = 0; x < ENV_W; x++) {
            double around = 2.0 * M_PI * (0.5 - (x + 0.5) / ENV_W), down = M_PI * (y + 0.5) / ENV_H;
            double side = sin(down) * cos(around - angle), sky = 1.0 + contrast * side + 0.3 * cos(down);
            for (int k = 0; k < 3; k++) rgb[3 * (y * ENV_W + x) + k] = (float)(sky * (k == 2 ? 1.2 : 1.0));
        }
}

static void light_by(rig *r, double angle, double contrast)
{
    static float rgb[3 * ENV_W * ENV_H];
    error e = {0};
    paint(rgb, angle, contrast);
    job_forget_light(&r->job);
    must(environment_prepare(rgb, ENV_W, ENV_H, &(env_options){.path = "sky", .up_z = true, .scale = 1.0}, &r->job.light.env,
                             &r->log, &e),
         &e);
    r->job.light.loaded = true;
    must(pass_upload_environment(&r->job.g, &r->job.light.env, &r->job.light.image, &e), &e);
}

// The direct light of every pixel by rays, 4 floats a pixel.
static float *truth_of(const scene *s, const gbuffer *gb, environment *env)
{
    tracer t = scene_tracer(s);
    truth_options o = {.rays = 1024, .offset = 1e-4, .sky = truth_environment_sky, .sky_data = env};
    float *out = calloc((size_t)4 * PIXELS, sizeof *out);
    assert_non_null(out);
    for (int i = 0; i < PIXELS; i++) {
        const float *n = gb->normal + 4 * i;
        if (gb->depth[i] == 0.0f) continue;
        vec3 N = m3_apply(gb->camera.world_from_camera, v3((double)n[0], (double)n[1], (double)n[2]));
        vec3 P = v3_add(gb->camera.origin, m3_apply(gb->camera.world_from_camera, gbuffer_position(gb, i % W, i / W)));
        vec3 L = truth_radiance(&t, P, N, &o);
        out[4 * i] = (float)L.x, out[4 * i + 1] = (float)L.y, out[4 * i + 2] = (float)L.z;
    }
    return out;
}

static pass_settings settings_for(const gbuffer *gb, double outside)
{
    pass_settings set = rig_settings(method_find("arc"), 0.5);
    set.thickness = 0.1, set.planes = true, set.blur = 4, set.outside = openness_even(outside);
    set.world_from_camera = set.upright_from_camera = gb->camera.world_from_camera;
    set.upright_eye = gb->camera.origin;
    return set;
}

// Fits the picture with this light of its own; whether the prior was left.
static bool fit_to(rig *r, const gbuffer *gb, float *light, bool told, double prior, openness *out)
{
    error e = {0};
    frame_result f = {.gb = *gb, .set = settings_for(gb, prior)};
    f.gb.diffuse_direct = light;
    f.plan = (plan){.method = method_find("arc"), .blur = true, .need = ~0u, .need_to_fit = NEED_DIFFUSE_LIGHT};
    must(outside_fit_gather(&r->job, &f, &e), &e);
    *out = f.set.outside;
    must(outside_fit(&r->job, &f, &r->job.light, told, out, &e), &e);
    gbuffer_free(&f.lit);
    return memcmp(out, &f.set.outside, sizeof *out) != 0;
}

// Radiance against the truth: the difference over the truth's root mean square.
static double error_of(rig *r, const gbuffer *gb, const openness *o, const float *truth)
{
    error e = {0};
    frame_result out;
    pass_settings set = settings_for(gb, 0.0);
    set.outside = *o;
    must(rig_run(r, gb, method_find("arc"), &set, 1 << LAYER_RADIANCE, &out, &e), &e);
    double squares = 0.0, all = 0.0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        double t = (double)truth[i / 3 * 4 + i % 3], d = (double)out.layers[LAYER_RADIANCE][i] - t;
        squares += d * d, all += t * t;
    }
    rig_free_result(&out);
    return sqrt(squares / all);
}

// Learned under one sky, scored under that and under another one.
static void light_tells_where_it_is_open(void **state)
{
    (void)state;
    static rig r;
    error e = {0};
    gbuffer gb;
    openness fitted, covered = openness_even(OUTSIDE_COVERED);
    scene s = room_from_its_window();
    double left[2], prior[2];
    must(rig_open(&r, NULL, &e), &e);
    look(&s, W, H, 60.0, &gb);
    light_by(&r, 0.5, 0.6);
    float *truth = truth_of(&s, &gb, &r.job.light.env);
    assert_true(fit_to(&r, &gb, truth, true, OUTSIDE_COVERED, &fitted));
    left[0] = error_of(&r, &gb, &fitted, truth), prior[0] = error_of(&r, &gb, &covered, truth);
    free(truth);
    light_by(&r, 3.0, 0.6);
    truth = truth_of(&s, &gb, &r.job.light.env);
    left[1] = error_of(&r, &gb, &fitted, truth), prior[1] = error_of(&r, &gb, &covered, truth);
    printf("figure: room with its window behind the eye, learned from its light: radiance %.3f of the truth's rms, %.3f under "
           "another "
           "sky (%.2f and %.2f without)\n",
           left[0], left[1], prior[0], prior[1]);
    assert_true(left[0] < 0.35 && left[1] < 0.35);
    assert_true(prior[0] > 2.0 * left[0]);
    free(truth);
    gbuffer_free(&gb);
    rig_close(&r);
}

// A further G-buffer shows a curtain before most of the window, which lets the light through. It makes the room too dark for its
// own picture, but not the picture too bright for its sky.
static void a_curtain_refuses_no_fit(void **state)
{
    (void)state;
    static rig r;
    error e = {0};
    gbuffer gb;
    openness o;
    scene s = room_from_its_window(), curtained = s;
    quad(&curtained, 1, 4.99, 1, v3(1.4, 0, 0), v3(0, 0, 1));
    latlong_camera c = {.eye = v3(1.2, 2.2, 1.3), .up = 2, .start = 1.0, .sense = -1};
    must(rig_open(&r, NULL, &e), &e);
    look(&s, W, H, 60.0, &gb);
    light_by(&r, 0.5, 0.6);
    float *truth = truth_of(&s, &gb, &r.job.light.env);
    r.job.views[r.job.view_count++] = view_around(&curtained, &c);
    assert_true(fit_to(&r, &gb, truth, true, OUTSIDE_COVERED, &o));
    free(truth);
    gbuffer_free(&gb);
    rig_close(&r);
}

// Without a word on what lit it, a picture that is as bright as under an open sky stays open, and one that looks like it in
// another exposure. One that is a tenth as bright and lit through a window is closed, whether the window is in view or not.
static void the_unasked_decision(void **state)
{
    (void)state;
    static rig r;
    error e = {0};
    gbuffer gb;
    openness o;
    scene s = room_from_its_window(), table = {.eye = v3(0.5, -3, 4), .target = v3(0, 0, 0.3), .radius = 0.5};
    scene_add_plane(&table, v3(0, 0, 0), v3(0, 0, 1), grey);
    scene_add_box(&table, v3(0, 0, 0.4), v3(0.4, 0.3, 0.4), 20.0, grey);
    must(rig_open(&r, NULL, &e), &e);
    light_by(&r, 0.5, 0.6);
    look(&s, W, H, 60.0, &gb);
    float *truth = truth_of(&s, &gb, &r.job.light.env);
    assert_true(fit_to(&r, &gb, truth, false, 1.0, &o));
    assert_true(openness_mean(&o) < 0.4);
    free(truth);
    gbuffer_free(&gb);
    // The lower half of the window is in view, no ceiling.
    scene towards = room(true, true);
    towards.target = v3(2, 5, 0.5);
    look(&towards, W, H, 40.0, &gb);
    assert_in_range(gb.valid, PIXELS / 2, PIXELS - PIXELS / 20);
    truth = truth_of(&towards, &gb, &r.job.light.env);
    assert_true(fit_to(&r, &gb, truth, false, 1.0, &o));
    assert_true(openness_mean(&o) < 0.4);
    free(truth);
    gbuffer_free(&gb);
    look(&table, W, H, 30.0, &gb);
    assert_int_equal(gb.valid, PIXELS);
    truth = truth_of(&table, &gb, &r.job.light.env);
    assert_false(fit_to(&r, &gb, truth, false, 1.0, &o));
    for (int i = 0; i < 4 * PIXELS; i++) truth[i] *= 0.2f; // the same under a sky of another exposure
    assert_false(fit_to(&r, &gb, truth, false, 1.0, &o));
    assert_false(fit_to(&r, &gb, truth, true, 1.0, &o));
    free(truth);
    gbuffer_free(&gb);
    rig_close(&r);
}

// The small frame shows the large one's surfaces where they are, with the light that is there: light that is a function of the
// place still is one.
static void the_small_frame_is_the_same_place(void **state)
{
    (void)state;
    error e = {0};
    job j = {.threads = 2};
    gbuffer gb;
    scene s = {.eye = v3(0.5, -3, 4), .target = v3(0, 0, 0.3), .radius = 0.5};
    scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), grey);
    look(&s, 1031, 581, 30.0, &gb);
    frame_result f = {.gb = gb, .plan = {.need = ~0u, .need_to_fit = NEED_DIFFUSE_LIGHT}};
    f.gb.diffuse_direct = mem_pixels(4 * (size_t)gb.width * (size_t)gb.height, sizeof(float), &e);
    assert_non_null(f.gb.diffuse_direct);
    for (int i = 0; i < gb.width * gb.height; i++)
        for (int k = 0; k < 3; k++)
            f.gb.diffuse_direct[4 * i + k] = (float)(3.0 + gbuffer_position(&gb, i % gb.width, i / gb.width).x);
    must(outside_fit_gather(&j, &f, &e), &e);
    assert_in_range(f.lit.width * f.lit.height, 2000, 1 << 14);
    for (int i = 0; i < f.lit.width * f.lit.height; i++) {
        int x = i % f.lit.width, y = i / f.lit.width;
        if (x + 1 == f.lit.width || y + 1 == f.lit.height) continue; // means over what is left of a block
        vec3 p = gbuffer_position(&f.lit, x, y);
        vec3 world = v3_add(gb.camera.origin, m3_apply(gb.camera.world_from_camera, p));
        double pixel = p.z / f.lit.camera.fx, weight = (double)f.lit.beauty[4 * i + 3];
        assert_true(fabs(world.z) < 1e-4 && weight > 0.0);
        assert_true(fabs((double)f.lit.beauty[4 * i] / weight - 3.0 - p.x) < 0.05 * pixel);
    }
    free(f.gb.diffuse_direct);
    gbuffer_free(&f.lit);
    gbuffer_free(&gb);
}

// Lamps that hang in the picture: no outside explains their pools of light, so the prior stays.
static void lamps_explain_nothing(void **state)
{
    (void)state;
    static rig r;
    error e = {0};
    gbuffer gb;
    openness o;
    scene s = room_from_its_window();
    float *light = calloc((size_t)4 * PIXELS, sizeof *light);
    assert_non_null(light);
    must(rig_open(&r, NULL, &e), &e);
    light_by(&r, 0.5, 0.6);
    look(&s, W, H, 60.0, &gb);
    for (int i = 0; i < PIXELS; i++) {
        static const vec3 lamps[2] = {{1, 0.15, 1.2}, {3.85, 2.0, 0.6}};
        const float *n = gb.normal + 4 * i;
        vec3 N = m3_apply(gb.camera.world_from_camera, v3((double)n[0], (double)n[1], (double)n[2]));
        vec3 P = v3_add(gb.camera.origin, m3_apply(gb.camera.world_from_camera, gbuffer_position(&gb, i % W, i / W)));
        for (int k = 0; k < 2; k++) {
            vec3 to = v3_sub(lamps[k], P);
            double far = v3_length(to), facing = fmax(0.0, v3_dot(N, to) / far);
            light[4 * i] += (float)(facing / (far * far)), light[4 * i + 1] += (float)(0.7 * facing / (far * far));
        }
    }
    assert_false(fit_to(&r, &gb, light, true, OUTSIDE_COVERED, &o));
    assert_false(fit_to(&r, &gb, light, false, 1.0, &o));
    free(light);
    gbuffer_free(&gb);
    rig_close(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_tells_where_it_is_open), cmocka_unit_test(a_curtain_refuses_no_fit),
        cmocka_unit_test(the_unasked_decision),         cmocka_unit_test(the_small_frame_is_the_same_place),
        cmocka_unit_test(lamps_explain_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
