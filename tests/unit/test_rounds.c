// --error: the estimate against the true error, when rounds stop, and the filter that knows the noise.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "must.h"
#include "pipeline/frame.h"
#include "rig.h"
#include "sample.h"
#include "scene_picture.h"
#include "tile_errors.h"

enum { LAYERS = 1 << LAYER_OCCLUSION | 1 << LAYER_ERROR };

static pass_settings settings(double radius, double limit)
{
    const method *m = method_find("arc");
    pass_settings set = rig_settings(m, radius);
    set.thickness = m->thickness * radius;
    set.planes = true;
    set.blur = m->blur;
    set.target_error = limit;
    set.most_samples = ROUNDS_MOST_SAMPLES;
    return set;
}

// A sample's surfaces as the program reads them; free with frame_free.
static void read_sample(rig *r, const sample *s, frame_result *f)
{
    error e = {0};
    must(frame_read(&r->job, s->file, f, &e), &e);
}

static void run(rig *r, const gbuffer *gb, const pass_settings *set, unsigned layers, frame_result *out)
{
    error e = {0};
    must(rig_run(r, gb, method_find("arc"), set, layers, out, &e), &e);
}

// Over all samples nine of ten tiles have a true error within a factor of 2 of the estimate.
static void the_estimate_holds(void **state)
{
    (void)state;
    rig r;
    error e = {0};
    sample list[SAMPLE_MAX];
    int n = samples_list("samples", list, SAMPLE_MAX, &e), tiles = 0, within = 0, scenes = 0;
    must(rig_open(&r, NULL, &e), &e);
    for (int i = 0; i < n; i++) {
        frame_result f, out;
        if (!list[i].truth[0]) continue;
        read_sample(&r, &list[i], &f);
        pass_settings set = settings(list[i].ao_distance, 0.02);
        float *limit = tile_limit(&r, &f.gb, method_find("arc"), set, 2048, 1, &e);
        assert_non_null(limit);
        run(&r, &f.gb, &set, LAYERS, &out);
        tile_errors t = tile_errors_of(&f.gb, out.layers[LAYER_OCCLUSION], limit, out.layers[LAYER_ERROR], set.target_error);
        printf(
            "figure: %s at 0.02: %.0f samples, true error %.4f, estimate %.4f; of %d tiles %d are within a factor of 2, %d have "
            "more than twice the estimate\n",
            list[i].name, out.mean_samples, t.rms, t.estimated, t.tiles, t.within_2, t.over_2);
        assert_int_equal(out.tiles_above, 0);
        tiles += t.tiles, within += t.within_2, scenes++;
        free(limit);
        rig_free_result(&out);
        frame_free(&f);
    }
    assert_true(scenes >= 5);
    printf("figure: %d of %d tiles\n", within, tiles);
    assert_true(within >= 0.9 * tiles);
    rig_close(&r);
}

static const sample *sample_named(const sample *list, int n, const char *name)
{
    for (int i = 0; i < n; i++)
        if (strcmp(list[i].name, name) == 0) return &list[i];
    fail_msg("no sample %s", name);
    return NULL;
}

// The rig, with a light or NULL, and a sample's surfaces. Returns the radius of the sample's truth.
static double open_sample(rig *r, const env_options *env, const char *name, frame_result *f)
{
    error e = {0};
    sample list[SAMPLE_MAX];
    const sample *s = sample_named(list, samples_list("samples", list, SAMPLE_MAX, &e), name);
    must(rig_open(r, env, &e), &e);
    read_sample(r, s, f);
    return s->ao_distance;
}

static void close_sample(rig *r, frame_result *f)
{
    frame_free(f);
    rig_close(r);
}

// A smaller error takes more samples, most samples are not exceeded, and tiles that need more are counted.
static void rounds_stop(void **state)
{
    (void)state;
    const double limits[] = {0.05, 0.02, 0.01};
    rig r;
    frame_result f, out;
    double radius = open_sample(&r, NULL, "still", &f);
    double before = 0.0;
    for (int i = 0; i < 3; i++) {
        pass_settings set = settings(radius, limits[i]);
        run(&r, &f.gb, &set, LAYERS, &out);
        printf("figure: still at %.2f: %.0f samples in %d rounds\n", limits[i], out.mean_samples, out.rounds);
        assert_true(out.mean_samples > before);
        assert_true(out.mean_samples <= ROUNDS_MOST_SAMPLES);
        before = out.mean_samples;
        rig_free_result(&out);
    }
    // 64 samples, then 192, then 448 if the cap allows.
    const int caps[][2] = {{ROUNDS_LEAST_SAMPLES, 1}, {191, 1}, {192, 2}, {447, 2}, {448, 3}};
    for (size_t i = 0; i < sizeof caps / sizeof *caps; i++) {
        pass_settings set = settings(radius, 0.001);
        set.most_samples = caps[i][0];
        run(&r, &f.gb, &set, LAYERS, &out);
        assert_int_equal(out.rounds, caps[i][1]);
        assert_true(out.mean_samples <= caps[i][0] && out.tiles_above > 0);
        rig_free_result(&out);
    }
    close_sample(&r, &f);
}

// An empty plane is exact after the first round, says so, and gives the radiance of an unblocked sky.
static void an_empty_plane_stops_at_once(void **state)
{
    (void)state;
    rig r;
    error e = {0};
    scene s = {.eye = v3(0, -4, 3), .target = v3(0, 0, 0), .radius = 1.0};
    gbuffer gb;
    frame_result out;
    must(rig_open(&r, &(env_options){.up_z = true, .scale = 1.0}, &e), &e);
    scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), v3(0.5, 0.5, 0.5));
    view v = view_perspective(200, 150, 40.0, 1.0);
    view_scene(&v, &s);
    must(scene_gbuffer(&s, &v, &gb, &e), &e);
    pass_settings set = settings(1.0, 0.001);
    run(&r, &gb, &set, LAYERS | 1 << LAYER_RADIANCE, &out);
    assert_int_equal(out.rounds, 1);
    for (int i = 0; i < 200 * 150; i++) {
        assert_true(out.layers[LAYER_OCCLUSION][i] == 1.0f && out.layers[LAYER_ERROR][i] == 0.0f);
        for (int k = 0; k < 3; k++) assert_true(fabsf(out.layers[LAYER_RADIANCE][3 * i + k] - (gb.depth[i] > 0.0f)) < 1e-5f);
    }
    rig_free_result(&out);
    gbuffer_free(&gb);
    rig_close(&r);
}

// What stops is a part of the picture of its own size, so that results do not depend on how the frame is dispatched.
static void dispatch_does_not_matter(void **state)
{
    (void)state;
    rig r;
    frame_result f, out[2];
    double radius = open_sample(&r, &(env_options){.path = "samples/sky_soft.exr", .up_z = true, .scale = 1.0}, "box", &f);
    pass_settings set = settings(radius, 0.02);
    for (int i = 0; i < 2; i++) {
        if (i == 1) setenv("SSDO_TILE", "48", 1);
        run(&r, &f.gb, &set, LAYERS | 1 << LAYER_RADIANCE | 1 << LAYER_BENT, &out[i]);
    }
    unsetenv("SSDO_TILE");
    size_t bytes = (size_t)f.gb.width * (size_t)f.gb.height * sizeof(float);
    assert_memory_equal(out[0].layers[LAYER_OCCLUSION], out[1].layers[LAYER_OCCLUSION], bytes);
    assert_memory_equal(out[0].layers[LAYER_ERROR], out[1].layers[LAYER_ERROR], bytes);
    assert_memory_equal(out[0].layers[LAYER_RADIANCE], out[1].layers[LAYER_RADIANCE], 3 * bytes);
    assert_memory_equal(out[0].layers[LAYER_BENT], out[1].layers[LAYER_BENT], 3 * bytes);
    for (int i = 0; i < 2; i++) rig_free_result(&out[i]);
    close_sample(&r, &f);
}

// Where sampling has converged the filter leaves the picture alone: with 1024 samples it errs less than no filter does, and where
// there is noise it takes most of it.
static void the_filter_knows_the_noise(void **state)
{
    (void)state;
    const struct {
        int samples;
        double share; // of the error without a filter that may be left
    } cases[] = {{1024, 1.0}, {128, 0.75}};
    rig r;
    frame_result f, out;
    double radius = open_sample(&r, NULL, "still", &f);
    error e = {0};
    pass_settings set = settings(radius, 0.0);
    float *limit = tile_limit(&r, &f.gb, method_find("arc"), set, 4096, 1, &e);
    assert_non_null(limit);
    for (int i = 0; i < 2; i++) {
        double left[2];
        set.samples = cases[i].samples;
        for (int k = 0; k < 2; k++) {
            set.blur = k == 0 ? 0 : 4;
            run(&r, &f.gb, &set, 1 << LAYER_OCCLUSION, &out);
            left[k] = tile_errors_of(&f.gb, out.layers[LAYER_OCCLUSION], limit, NULL, 1.0).rms;
            rig_free_result(&out);
        }
        printf("figure: still, %d samples: rms from the limit %.4f without a filter, %.4f with it\n", cases[i].samples, left[0],
               left[1]);
        assert_true(left[1] < cases[i].share * left[0]);
    }
    free(limit);
    close_sample(&r, &f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_estimate_holds),           cmocka_unit_test(rounds_stop),
        cmocka_unit_test(an_empty_plane_stops_at_once), cmocka_unit_test(dispatch_does_not_matter),
        cmocka_unit_test(the_filter_knows_the_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
