// --bounce vpl: the choice of lights, and the bounce against the sum over every pixel.
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
#include "near.h"
#include "passes/vpl.h"
#include "reference.h"
#include "rig.h"
#include "scene_picture.h"

enum { PIXELS = 250, WIDTH = 128, HEIGHT = 96, ALL = WIDTH * HEIGHT, NEEDED = 1 << LAYER_RADIANCE | 1 << LAYER_INDIRECT };

static gbuffer shoot(void (*build)(scene *), double fov)
{
    static scene s;
    gbuffer gb;
    error e = {0};
    memset(&s, 0, sizeof s);
    build(&s);
    view v = fov > 0.0 ? view_perspective(WIDTH, HEIGHT, fov, 1.0) : view_orthographic(WIDTH, HEIGHT, 6.0, 1.25);
    view_scene(&v, &s);
    must(scene_gbuffer(&s, &v, &gb, &e), &e);
    return gb;
}

// ---- the lights

static void tilted(scene *s) { scene_tilted_plane(s, 50.0, 10.0); }

// The discs of all lights together are the area that is seen. On a plane that is known: the frame's corners, projected onto it.
// A smaller extent draws the lights nearer, and their areas make up for it.
static void areas_add_up(void **state)
{
    (void)state;
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        gbuffer gb = shoot(tilted, orthographic ? 0.0 : 40.0);
        float *light = calloc(ALL, 4 * sizeof *light);
        for (int i = 0; i < 4 * ALL; i++) light[i] = 0.7f;
        enum { COUNT = 500 };
        vpl lights[COUNT];
        double sum = 0.0, near_sum = 0.0, mean = 0.0, near_mean = 0.0;
        gb.extent = 5.0;
        assert_int_equal(vpl_choose(&gb, light, NULL, COUNT, lights), COUNT);
        for (int k = 0; k < COUNT; k++) near_sum += lights[k].area, near_mean += lights[k].position.z / COUNT;
        gb.extent = 0.0;
        assert_int_equal(vpl_choose(&gb, light, NULL, COUNT, lights), COUNT);
        for (int k = 0; k < COUNT; k++) sum += lights[k].area, mean += lights[k].position.z / COUNT;
        const camera *c = &gb.camera;
        vec3 n = lights[0].normal, corner[4];
        for (int k = 0; k < 4; k++) {
            double x = ((k == 1 || k == 2) * WIDTH - c->cx) / c->fx, y = ((k >= 2) * HEIGHT - c->cy) / c->fy;
            double h = v3_dot(n, lights[0].position);
            corner[k] =
                orthographic ? v3(x, y, (h - n.x * x - n.y * y) / n.z) : v3_scale(v3(x, y, 1), h / v3_dot(n, v3(x, y, 1)));
        }
        vec3 area = v3_cross(v3_sub(corner[2], corner[0]), v3_sub(corner[3], corner[1]));
        assert_near(sum / (0.5 * v3_length(area)), 1.0, 1e-3);
        assert_near(near_sum / sum, 1.0, 0.005);
        assert_true(near_mean < 0.99 * mean);
        free(light);
        gbuffer_free(&gb);
    }
}

static double luminance_of(const vpl *v) { return 0.2126 * v->radiance[0] + 0.7152 * v->radiance[1] + 0.0722 * v->radiance[2]; }

static void lights_follow_what_is_sent(void **state)
{
    (void)state;
    gbuffer gb = shoot(scene_clutter, 50.0);
    gb.extent = 0.0; // by power alone
    float *light = calloc(ALL, 4 * sizeof *light), *albedo = calloc(ALL, 4 * sizeof *albedo);
    vpl lights[400], again[400];
    assert_int_equal(vpl_choose(&gb, light, NULL, 400, lights), 0); // nothing sends: no light, and no NaN
    for (int i = 0; i < ALL; i++)
        for (int k = 0; k < 3; k++) {
            light[4 * i + k] = i % WIDTH < WIDTH / 2 ? 1.0f : 3.0f;
            albedo[4 * i + k] = i / WIDTH < HEIGHT / 2 ? 0.0f : 0.25f * (float)(k + 1);
        }
    light[4 * (ALL - 5)] = NAN;
    assert_int_equal(vpl_choose(&gb, light, albedo, 400, lights), 400);
    assert_int_equal(vpl_choose(&gb, light, albedo, 400, again), 400);
    assert_memory_equal(lights, again, sizeof lights);
    double power = luminance_of(&lights[0]) * lights[0].area;
    for (int k = 0; k < 400; k++) {
        double x, y, lum = luminance_of(&lights[k]);
        assert_true(camera_project(&gb.camera, lights[k].position, &x, &y));
        assert_true(y >= HEIGHT / 2); // the upper half is black
        double L = x < WIDTH / 2 ? 1.0 : 3.0;
        assert_near3(v3(lights[k].radiance[0], lights[k].radiance[1], lights[k].radiance[2]), v3(0.25 * L, 0.5 * L, 0.75 * L),
                     1e-6);
        assert_near(lum * lights[k].area, power, 1e-9); // each stands for the same share of the light
    }
    free(light), free(albedo);
    gbuffer_free(&gb);
}

// ---- the bounce

typedef struct figures {
    double difference, gain; // relative rms; truth ~ gain
} figures;

static figures compare(rig *r, const gbuffer *gb, const layer *l, const pixel *pixels, int n, const vec3 *expected, int count)
{
    error e = {0};
    frame_result out;
    pass_settings set = rig_settings(method_find("ssdo"), 0.5);
    set.vpl_count = count;
    must(rig_run(r, gb, method_find("ssdo"), &set, NEEDED, &out, &e), &e);
    double sd = 0, st = 0, sxt = 0;
    for (int i = 0; i < n; i++) {
        const float *x = out.layers[LAYER_INDIRECT] + 3 * (pixels[i].y * l->width + pixels[i].x);
        vec3 got = v3((double)x[0], (double)x[1], (double)x[2]), d = v3_sub(got, expected[i]);
        sd += v3_dot(d, d), st += v3_dot(expected[i], expected[i]), sxt += v3_dot(got, expected[i]);
    }
    rig_free_result(&out);
    return (figures){sqrt(sd / st), sxt / st};
}

static void patches(scene *s) { scene_patches(s, 1.0, 0.5); }

static void converges(void (*build)(scene *), double fov, double limit)
{
    rig r;
    error e = {0};
    layer l;
    frame_result out;
    static pixel pixels[PIXELS];
    static vec3 expected[PIXELS];
    must(rig_open(&r, &(env_options){.up_z = true, .scale = 1.0}, &e), &e);
    r.options.bounce = "vpl";
    gbuffer gb = shoot(build, fov);
    must(layer_build(&gb, &l, &e), &e);
    int n = reference_pixels(&l, PIXELS, pixels);
    pass_settings set = rig_settings(method_find("ssdo"), 0.5);
    must(rig_run(&r, &gb, method_find("ssdo"), &set, NEEDED, &out, &e), &e);
    for (int i = 0; i < n; i++) expected[i] = reference_vpl(&l, pixels[i], out.layers[LAYER_RADIANCE]);
    rig_free_result(&out);
    figures f = {0};
    double before = INFINITY;
    for (int count = 16; count <= 4096; count *= 4) {
        f = compare(&r, &gb, &l, pixels, n, expected, count);
        print_message("vpl %d: relative rms difference %.4f, gain %.4f\n", count, f.difference, f.gain);
        assert_true(f.difference < before);
        before = f.difference;
    }
    if (f.difference > limit || fabs(f.gain - 1.0) > 0.5 * limit) fail_msg("difference %.4f, gain %.4f", f.difference, f.gain);
    layer_free(&l);
    gbuffer_free(&gb);
    rig_close(&r);
}

static void bounce_converges(void **state)
{
    (void)state;
    converges(patches, 25.0, 0.01);
    converges(scene_clutter, 50.0, 0.1);
}

// No more arrives than the brightest sender sends, however few the lights.
static void bounce_is_bounded(void **state)
{
    (void)state;
    rig r;
    error e = {0};
    must(rig_open(&r, &(env_options){.up_z = true, .scale = 1.0}, &e), &e);
    r.options.bounce = "vpl";
    gbuffer gb = shoot(scene_furnace, 70.0);
    for (int count = 1; count <= 1024; count *= 4) {
        frame_result out;
        pass_settings set = rig_settings(method_find("ssdo"), 0.5);
        set.vpl_count = count;
        must(rig_run(&r, &gb, method_find("ssdo"), &set, NEEDED, &out, &e), &e);
        float most = 0.0f, brightest = 0.0f;
        for (int i = 0; i < 3 * ALL; i++) {
            most = fmaxf(most, out.layers[LAYER_INDIRECT][i]);
            brightest = fmaxf(brightest, out.layers[LAYER_RADIANCE][i] * gb.albedo[i / 3 * 4 + i % 3]);
        }
        assert_true(most > 0.1f && most <= brightest + 1e-5f);
        rig_free_result(&out);
    }
    gbuffer_free(&gb);
    rig_close(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(areas_add_up), cmocka_unit_test(lights_follow_what_is_sent),
                                       cmocka_unit_test(bounce_converges), cmocka_unit_test(bounce_is_bounded)};
    return cmocka_run_group_tests_name("vpl", tests, NULL, NULL);
}
