// The light of small bright sources: its amount on an empty plane, and where shadows fall, against traced rays.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/mem.h"
#include "must.h"
#include "rig.h"
#include "scene_picture.h"

enum { WIDTH = 256, HEIGHT = 128 };

// A dim sky with one bright texel at column x and row y.
static void light_with(rig *r, int x, int y)
{
    error e = {0};
    float *rgb = mem_zero(3 * WIDTH * HEIGHT, sizeof *rgb, &e);
    assert_non_null(rgb);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) rgb[i] = 1e-3f;
    for (int k = 0; k < 3; k++) rgb[3 * (y * WIDTH + x) + k] = 1000.0f;
    must(environment_prepare(rgb, WIDTH, HEIGHT, &(env_options){.path = "sun", .up_z = true, .scale = 1.0}, &r->job.light.env,
                             &r->log, &e),
         &e);
    r->job.light.loaded = true;
    must(pass_upload_environment(&r->job.g, &r->job.light.env, &r->job.light.image, &e), &e);
    free(rgb);
}

static vec3 direction_of(double x, double y)
{
    double phi = (0.5 - x / WIDTH) * 2.0 * M_PI, theta = y / HEIGHT * M_PI;
    return v3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

static pass_settings settings(double radius, bool half)
{
    pass_settings set = rig_settings(method_find("arc"), radius);
    set.thickness = 0.3 * radius;
    set.planes = true;
    set.blur = 4;
    set.size = half ? SIZE_HALF : SIZE_FULL;
    return set;
}

static void empty_planes_get_all(void **state)
{
    (void)state;
    for (int y = 8; y < 56; y += 16) {
        rig r;
        error e = {0};
        scene s = {.eye = v3(0, -4, 3), .target = v3(0, 0, 0), .radius = 1.0};
        gbuffer gb;
        frame_result out;
        must(rig_open(&r, NULL, &e), &e);
        light_with(&r, 40, y);
        scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), v3(0.5, 0.5, 0.5));
        view v = view_perspective(64, 48, 40.0, 1.0);
        view_scene(&v, &s);
        must(scene_gbuffer(&s, &v, &gb, &e), &e);
        pass_settings set = settings(1.0, false);
        must(rig_run(&r, &gb, method_find("arc"), &set, 1 << LAYER_RADIANCE, &out, &e), &e);
        double direct = env_texel_solid_angle(WIDTH, HEIGHT, y) * (1000.0 - 1e-3) * direction_of(40.5, y + 0.5).z / M_PI;
        double worst = 0.0, wanted = 1e-3 + direct;
        for (int i = 0; i < 3 * 64 * 48; i++) worst = fmax(worst, fabs((double)out.layers[LAYER_RADIANCE][i] / wanted - 1.0));
        printf("figure: sun at %.0f degrees from the zenith on an empty plane: largest relative error %.5f\n",
               (y + 0.5) * 180.0 / HEIGHT, worst);
        assert_true(worst < 0.01);
        rig_free_result(&out);
        gbuffer_free(&gb);
        rig_close(&r);
    }
}

// Share of the pixels whose light differs by more than half of the full sun from what rays to the sun's middle say.
static double wrong_shadows(bool half, double *shadowed)
{
    static rig r;
    error e = {0};
    scene s = {.eye = v3(0.5, -6, 3.5), .target = v3(0, 0, 0.4), .radius = 1.0};
    gbuffer gb;
    frame_result out;
    must(rig_open(&r, NULL, &e), &e);
    light_with(&r, 90, 40);
    scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), v3(0.5, 0.5, 0.5));
    scene_add_sphere(&s, v3(-0.8, 0.2, 0.6), 0.6, v3(0.5, 0.5, 0.5));
    scene_add_sphere(&s, v3(0.9, 0.6, 1.2), 0.4, v3(0.5, 0.5, 0.5));
    scene_add_box(&s, v3(0.6, -0.8, 0.3), v3(0.3, 0.3, 0.3), 20.0, v3(0.5, 0.5, 0.5));
    view v = view_perspective(320, 240, 40.0, 1.0);
    view_scene(&v, &s);
    must(scene_gbuffer(&s, &v, &gb, &e), &e);
    pass_settings set = settings(1.0, half);
    must(rig_run(&r, &gb, method_find("arc"), &set, 1 << LAYER_RADIANCE, &out, &e), &e);
    tracer t = scene_tracer(&s);
    vec3 S = direction_of(90.5, 40.5);
    double full = env_texel_solid_angle(WIDTH, HEIGHT, 40) * 1000.0 / M_PI;
    size_t wrong = 0, dark = 0, all = 0;
    for (int i = 0; i < gb.width * gb.height; i++) {
        if (gb.depth[i] == 0.0f) continue;
        const float *n = gb.normal + 4 * i;
        vec3 normal = m3_apply(gb.camera.world_from_camera, v3((double)n[0], (double)n[1], (double)n[2]));
        vec3 P =
            v3_add(gb.camera.origin, m3_apply(gb.camera.world_from_camera, gbuffer_position(&gb, i % gb.width, i / gb.width)));
        double cosine = fmax(0.0, v3_dot(normal, S));
        bool blocked = t.blocked(t.data, v3_add(P, v3_scale(normal, 1e-4)), S, 0.0, 1e9);
        double wanted = blocked ? 0.0 : cosine, got = (double)out.layers[LAYER_RADIANCE][3 * i] / full;
        wrong += fabs(got - wanted) > 0.5 * cosine && cosine > 0.05;
        dark += blocked && cosine > 0.05;
        all++;
    }
    *shadowed = (double)dark / (double)all;
    rig_free_result(&out);
    gbuffer_free(&gb);
    rig_close(&r);
    return (double)wrong / (double)all;
}

static void shadows_fall_where_rays_say(void **state)
{
    (void)state;
    for (int half = 0; half < 2; half++) {
        double shadowed, wrong = wrong_shadows(half, &shadowed);
        printf("figure: sun, spheres and a box%s: %.2f %% of the pixels on the wrong side, %.1f %% in shadow\n",
               half ? ", half resolution" : "", 100.0 * wrong, 100.0 * shadowed);
        assert_true(shadowed > 0.05);
        assert_true(wrong < 0.15 * shadowed);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(empty_planes_get_all),
        cmocka_unit_test(shadows_fall_where_rays_say),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests_name("suns", tests, NULL, NULL);
}
