// Every renderer's file gives the four layers of the plainly named original, with no options.
//
// The files are written from header facts (tests/lib/renderer_facts.c). What may differ is rounding: of the stored types, and of
// the camera, which is fitted to positions in one file and read from the header in another.
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

#include "must.h"
#include "pipeline/frame.h"
#include "renderer_file.h"

enum { WIDTH = 120, HEIGHT = 80 };

static char folder[] = "/tmp/ssdo-renderers-XXXXXX";
static scene still;
static view seen;
static options defaults;
static log_t quiet;
static job work;
static frame_result originals[2]; // whole, cropped

// Things on a disc, with background all around them.
static void make_scene(void)
{
    scene_add_disc(&still, v3(0, 0, 0), v3(0, 0, 1), 2.0, v3(0.6, 0.6, 0.5));
    scene_add_sphere(&still, v3(-0.7, -0.3, 0.5), 0.5, v3(0.8, 0.2, 0.1));
    scene_add_box(&still, v3(0.7, 0.2, 0.4), v3(0.4, 0.3, 0.4), 25.0, v3(0.2, 0.3, 0.8));
    scene_add_box(&still, v3(0, 1.2, 0.6), v3(0.9, 0.1, 0.6), -10.0, v3(0.7, 0.7, 0.7));
    seen = view_perspective(WIDTH, HEIGHT, 38.0, 1.0);
    view_look(&seen, v3(1.5, -6, 3.5), v3(0, 0.1, 0.4), 4.0);
}

static void filter(char paths[FACT_FILES][256], int count, frame_result *out)
{
    const char *list[FACT_FILES];
    error e = {0};
    for (int i = 0; i < count; i++) list[i] = paths[i];
    must(frame_read_files(&work, list, count, out, &e), &e);
    must(frame_filter(&work, out, &e), &e);
}

static int set_up(void **state)
{
    error e = {0};
    (void)state;
    if (!mkdtemp(folder)) return -1;
    make_scene();
    options_defaults(&defaults);
    log_init(&quiet, LOG_QUIET);
    job_open(&work, &defaults, &quiet);
    for (int i = 0; i < 2; i++) {
        const renderer_fact plain = {.expected = "plain",
                                     .position = "P:XYZ",
                                     .normal = "N:XYZ",
                                     .depth = "Z",
                                     .albedo = "albedo:RGB",
                                     .beauty = ":RGBA",
                                     .cropped = i == 1};
        char paths[FACT_FILES][256];
        int count;
        must(renderer_write(&plain, &still, &seen, folder, paths, &count, &e), &e);
        filter(paths, count, &originals[i]);
    }
    return 0;
}

static int tear_down(void **state)
{
    char command[64];
    (void)state;
    for (int i = 0; i < 2; i++) frame_free(&originals[i]);
    job_close(&work);
    log_free(&quiet);
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

// Root mean square and largest difference of a layer.
static void compare(const frame_result *a, const frame_result *b, layer_id l, double *rms, double *largest)
{
    size_t n = (size_t)a->gb.width * (size_t)a->gb.height * strlen(layer_table[l]->channels);
    double sum = 0;
    assert_true(box2_equal(a->gb.data_window, b->gb.data_window));
    assert_true(a->layers[l] && b->layers[l]);
    *largest = 0;
    for (size_t i = 0; i < n; i++) {
        double d = fabs((double)a->layers[l][i] - (double)b->layers[l][i]);
        sum += d * d;
        *largest = fmax(*largest, d);
    }
    *rms = sqrt(sum / (double)n);
}

// Where the camera is in the renderer's world, wherever the file lets one know: environments depend on it.
static void check_pose(const renderer_fact *f, const camera *c)
{
    fact_camera truth = renderer_camera(f, &seen);
    const vec3 axes[3] = {truth.right, v3_scale(truth.up, -1.0), truth.forward};
    bool known = f->position_space == IN_WORLD || f->attributes;
    assert_int_equal(c->has_world, known);
    for (int k = 0; known && k < 3; k++) {
        vec3 found = v3(c->world_from_camera.m[0][k], c->world_from_camera.m[1][k], c->world_from_camera.m[2][k]);
        assert_true(v3_length(v3_sub(found, axes[k])) < 1e-4);
    }
    if (known) assert_true(v3_length(v3_sub(c->origin, truth.eye)) < 1e-3 * v3_length(truth.eye));
}

// Rounding of halves where there are any, else of floats. The bounce takes light from the pixel that a sample falls on, so where
// a sample lies on the border of two pixels, a rounding in the camera decides which: its error is that of a few other samples.
static double bound(const renderer_fact *f, layer_id l)
{
    if (l == LAYER_INDIRECT) return 1e-3;
    return f->half_normals || f->half_colours ? 0x1p-11 : 1e-6;
}

static void check_fact(const renderer_fact *f)
{
    char paths[FACT_FILES][256];
    int count;
    error e = {0};
    frame_result r;
    must(renderer_write(f, &still, &seen, folder, paths, &count, &e), &e);
    filter(paths, count, &r);
    print_message("%s (%s)\n", f->expected, f->source);
    assert_string_equal(r.resolution.convention, f->expected);
    const frame_result *original = &originals[f->cropped];
    assert_int_equal(r.gb.valid, original->gb.valid);
    assert_false(r.gb.normals_from_depth);
    if (gbuffer_doubt(&r.gb)) fail_msg("%s, %s: its %s is doubted", f->expected, f->source, gbuffer_doubt(&r.gb));
    for (int l = LAYER_OCCLUSION; l <= LAYER_COMPOSITE; l++) {
        double rms, largest;
        compare(&r, original, (layer_id)l, &rms, &largest);
        if (!(rms <= bound(f, (layer_id)l))) print_error("%s, %s:\n", f->expected, f->source);
        assert_true(rms <= bound(f, (layer_id)l));
        print_message("    %-10s rms %.2g, largest %.2g\n", layer_table[l]->name, rms, largest);
    }
    check_pose(f, &r.gb.camera);
    frame_free(&r);
}

static void every_renderer_gives_the_same_layers(void **state)
{
    (void)state;
    for (int i = 0; i < renderer_fact_count; i++) check_fact(&renderer_facts[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_renderer_gives_the_same_layers),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
