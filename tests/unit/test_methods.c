// The methods on a real GL context against closed forms and the invariants of shaders/README.md.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "must.h"
#include "rig.h"
#include "scene_picture.h"
#include "truth.h"

enum { ALL_LIGHT = 1 << LAYER_OCCLUSION | 1 << LAYER_RADIANCE };

static int open_white(void **state)
{
    static rig r;
    error e = {0};
    must(rig_open(&r, &(env_options){.up_z = true, .scale = 1.0}, &e), &e);
    *state = &r;
    return 0;
}

static int close_rig(void **state)
{
    rig_close(*state);
    return 0;
}

static gbuffer make(const scene *s, const view *v)
{
    gbuffer gb;
    error e = {0};
    must(scene_gbuffer(s, v, &gb, &e), &e);
    return gb;
}

// Views of an empty plane: perspective, orthographic, off-centre, narrow and wide.
static view plane_view(int kind)
{
    view v = kind == 1 ? view_orthographic(96, 64, 12.0, 1.0)
                       : view_perspective(96, 64,
                                          kind == 3   ? 100.0
                                          : kind == 4 ? 8.0
                                                      : 45.0,
                                          1.0);
    if (kind == 2) v.camera.cx += 21.25, v.camera.cy -= 9.5;
    return v;
}

static void empty_plane_is_open(void **state)
{
    static const double tilts[] = {0.0, 0.1, 30.0, 60.0, 80.0, 89.0};
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE))
        for (int kind = 0; kind < 5; kind++)
            for (size_t t = 0; t < sizeof tilts / sizeof *tilts; t++)
                for (int blur = 0; blur < 2; blur++) {
                    scene s = {0};
                    error e = {0};
                    frame_result r;
                    scene_tilted_plane(&s, tilts[t], 10.0);
                    view v = plane_view(kind);
                    gbuffer gb = make(&s, &v);
                    pass_settings set = rig_settings(m, 1.0);
                    set.samples = 16;
                    set.blur = blur ? 3 : 0;
                    must(rig_run(*state, &gb, m, &set, ALL_LIGHT, &r, &e), &e);
                    for (int i = 0; i < gb.width * gb.height; i++) {
                        if (r.layers[LAYER_OCCLUSION][i] != 1.0f)
                            fail_msg("%s: occlusion %.9g at pixel %d, view %d, tilt %g", m->name,
                                     (double)r.layers[LAYER_OCCLUSION][i], i, kind, tilts[t]);
                        for (int k = 0; gb.depth[i] > 0 && k < 3; k++)
                            if (fabsf(r.layers[LAYER_RADIANCE][3 * i + k] - 1.0f) > 2e-6f)
                                fail_msg("%s: radiance %.9g under white light, view %d, tilt %g", m->name,
                                         (double)r.layers[LAYER_RADIANCE][3 * i + k], kind, tilts[t]);
                    }
                    rig_free_result(&r);
                    gbuffer_free(&gb);
                }
}

// A constant map goes through texture lookups and levels, unlike the white environment's short cut.
static void constant_map_gives_its_radiance(void **state)
{
    (void)state;
    float rgb[3 * 32 * 16];
    for (int i = 0; i < 32 * 16; i++) rgb[3 * i] = 2.0f, rgb[3 * i + 1] = 0.5f, rgb[3 * i + 2] = 1.0f;
    rig r;
    error e = {0};
    must(rig_open(&r, NULL, &e), &e);
    must(environment_prepare(rgb, 32, 16, &(env_options){.path = "constant", .up_z = true, .scale = 1.0}, &r.job.light.env,
                             &r.log, &e),
         &e);
    r.job.light.loaded = true;
    must(pass_upload_environment(&r.job.g, &r.job.light.env, &r.job.light.image, &e), &e);
    scene s = {0};
    scene_tilted_plane(&s, 40.0, 5.0);
    view v = plane_view(0);
    gbuffer gb = make(&s, &v);
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
        frame_result out;
        pass_settings set = rig_settings(m, 1.0);
        must(rig_run(&r, &gb, m, &set, ALL_LIGHT, &out, &e), &e);
        for (int i = 0; i < gb.width * gb.height; i++)
            for (int k = 0; gb.depth[i] > 0 && k < 3; k++)
                assert_float_equal(out.layers[LAYER_RADIANCE][3 * i + k] / rgb[k], 1.0f, 1e-4f);
        rig_free_result(&out);
    }
    gbuffer_free(&gb);
    rig_close(&r);
}

// Mean of a layer over the pixels whose world position (from the scene) lies near the scene's point.
static double mean_near_point(const gbuffer *gb, const scene *s, const float *values, int channels, int channel)
{
    double sum = 0.0;
    int n = 0;
    vec3 at = camera_from_world(&gb->camera, s->point);
    double x, y;
    assert_true(camera_project(&gb->camera, at, &x, &y));
    for (int dy = -6; dy <= 6; dy++)
        for (int dx = -6; dx <= 6; dx++) {
            size_t i = (size_t)((int)y + dy) * (size_t)gb->width + (size_t)((int)x + dx);
            sum += (double)values[i * (size_t)channels + (size_t)channel];
            n++;
        }
    return sum / n;
}

// Two facing patches: light crosses (signs), the lid's red arrives on the floor, and the sum stays below what the lid covers.
static void facing_patches_exchange_light(void **state)
{
    const method *m = method_find("ssdo");
    scene s = {0};
    error e = {0};
    frame_result r;
    scene_patches(&s, 1.0, 0.5);
    view v = view_perspective(192, 128, 45.0, 1.0);
    view_scene(&v, &s);
    gbuffer gb = make(&s, &v);
    pass_settings set = rig_settings(m, s.radius);
    set.samples = 256;
    must(rig_run(*state, &gb, m, &set, ALL_LIGHT | 1 << LAYER_INDIRECT, &r, &e), &e);
    double worst = 0.0;
    for (int i = 0; i < gb.width * gb.height; i++) {
        double blocked = 1.0 - (double)r.layers[LAYER_OCCLUSION][i];
        for (int k = 0; k < 3; k++) worst = fmax(worst, (double)r.layers[LAYER_INDIRECT][3 * i + k] - blocked * 0.8);
    }
    // Senders are at most .8 of white light.
    assert_true(worst < 1e-5);
    rig_free_result(&r);
    gbuffer_free(&gb);
}

// What a bounce may carry: never more than the blocked share times the brightest sender, for any N, in a closed white box.
static void bounce_is_bounded(void **state)
{
    const method *m = method_find("ssdo");
    scene s = {0};
    error e = {0};
    scene_furnace(&s);
    view v = view_perspective(64, 48, 70.0, 1.0);
    view_scene(&v, &s);
    gbuffer gb = make(&s, &v);
    for (int n = 8; n <= 2048; n *= 4) {
        frame_result r;
        pass_settings set = rig_settings(m, s.radius);
        set.samples = n;
        must(rig_run(*state, &gb, m, &set, ALL_LIGHT | 1 << LAYER_INDIRECT, &r, &e), &e);
        double lit = 0.0;
        for (int i = 0; i < gb.width * gb.height; i++) {
            double open = (double)r.layers[LAYER_OCCLUSION][i], indirect = (double)r.layers[LAYER_INDIRECT][3 * i];
            if (indirect > 1.0 - open + 1e-5) fail_msg("N=%d: indirect %.6f, blocked %.6f", n, indirect, 1.0 - open);
            if ((double)r.layers[LAYER_RADIANCE][3 * i] + indirect > 1.0 + 1e-5)
                fail_msg("N=%d: more light than the furnace holds", n);
            lit += indirect;
        }
        assert_true(lit > 0.0); // a bounce that carries nothing would pass all the above
        rig_free_result(&r);
    }
    gbuffer_free(&gb);
}

static void same_bits_every_run(void **state)
{
    scene s = {0};
    error e = {0};
    scene_clutter(&s);
    view v = view_perspective(150, 110, 50.0, 1.0);
    view_scene(&v, &s);
    gbuffer gb = make(&s, &v);
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
        frame_result a, b;
        pass_settings set = rig_settings(m, s.radius);
        set.blur = 3;
        must(rig_run(*state, &gb, m, &set, ALL_LIGHT, &a, &e), &e);
        must(rig_run(*state, &gb, m, &set, ALL_LIGHT, &b, &e), &e);
        assert_memory_equal(a.layers[LAYER_RADIANCE], b.layers[LAYER_RADIANCE], sizeof(float) * 3 * 150 * 110);
        rig_free_result(&a);
        rig_free_result(&b);
    }
    gbuffer_free(&gb);
    (void)mean_near_point;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(empty_plane_is_open, open_white, close_rig),
        cmocka_unit_test(constant_map_gives_its_radiance),
        cmocka_unit_test_setup_teardown(facing_patches_exchange_light, open_white, close_rig),
        cmocka_unit_test_setup_teardown(bounce_is_bounded, open_white, close_rig),
        cmocka_unit_test_setup_teardown(same_bits_every_run, open_white, close_rig),
    };
    return cmocka_run_group_tests_name("methods", tests, NULL, NULL);
}
