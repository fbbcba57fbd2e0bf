// The looks: depth darkening, what the occlusion is multiplied onto, the parameter sets of --preset.
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

#include "base/mem.h"
#include "base/sort.h"
#include "must.h"
#include "pipeline/frame.h"
#include "rig.h"
#include "scene_picture.h"

enum { WIDTH = 120, HEIGHT = 80, PIXELS = WIDTH * HEIGHT };

static int open_rig(void **state)
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

static gbuffer clutter(void)
{
    static scene s;
    gbuffer gb;
    error e = {0};
    scene_clutter(&s);
    view v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&v, &s);
    must(scene_gbuffer(&s, &v, &gb, &e), &e);
    return gb;
}

// ---- depth darkening

static float *mask_of(rig *r, gbuffer *gb)
{
    error e = {0};
    frame_result out;
    const method *m = method_find("hemisphere");
    pass_settings set = rig_settings(m, 1.0);
    set.samples = 1;
    gb->valid = 0;
    for (int i = 0; i < PIXELS; i++) gb->valid += gb->depth[i] > 0.0f;
    must(rig_run(r, gb, m, &set, 1 << LAYER_DEPTHMASK, &out, &e), &e);
    float *mask = out.layers[LAYER_DEPTHMASK];
    out.layers[LAYER_DEPTHMASK] = NULL;
    rig_free_result(&out);
    return mask;
}

// The definition, in double, as one two-dimensional sum.
static double expected_mask(const gbuffer *gb, int x, int y, double near, double far)
{
    double sigma = 0.01 * hypot(WIDTH, HEIGHT), sum = 0.0, weights = 0.0, here = 0.0;
    int reach = (int)ceil(3.0 * sigma);
    for (int j = -reach; j <= reach; j++)
        for (int i = -reach; i <= reach; i++) {
            // Cut alike on both sides at the borders.
            if (x - abs(i) < 0 || y - abs(j) < 0 || x + abs(i) >= WIDTH || y + abs(j) >= HEIGHT) continue;
            double depth = (double)gb->depth[(y + j) * WIDTH + x + i];
            if (depth <= 0.0) continue;
            double d = fmin(fmax((depth - near) / (far - near), 0.0), 1.0), w = exp(-0.5 * (i * i + j * j) / (sigma * sigma));
            sum += w * d;
            weights += w;
            if (i == 0 && j == 0) here = d;
        }
    return fmin(0.0, sum / weights - here);
}

static void depthmask_is_the_unsharp_mask(void **state)
{
    gbuffer gb = clutter();
    // A hole that shows the background: it must neither darken its surroundings nor be darkened.
    for (int y = 30; y < 50; y++)
        for (int x = 40; x < 70; x++) gb.depth[y * WIDTH + x] = 0.0f;
    float *mask = mask_of(*state, &gb), *sorted = malloc(sizeof(float) * PIXELS), least = 0.0f;
    size_t n = 0;
    for (int i = 0; i < PIXELS; i++)
        if (gb.depth[i] > 0.0f) sorted[n++] = gb.depth[i];
    size_t stride = n / 4096 + 1, kept = 0; // as many as the pass looks at
    for (size_t i = 0; i < n && kept < 4096; i += stride) sorted[kept++] = sorted[i];
    sort_floats(sorted, kept);
    double near = (double)sorted[kept * 2 / 100], far = (double)sorted[kept * 98 / 100];
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double got = (double)mask[y * WIDTH + x];
            if (gb.depth[y * WIDTH + x] <= 0.0f) {
                assert_true(got == 0.0);
                continue;
            }
            double wanted = expected_mask(&gb, x, y, near, far);
            if (!(fabs(got - wanted) <= 1e-5)) fail_msg("pixel %d %d: %.7f, expected %.7f", x, y, got, wanted);
            least = fminf(least, (float)got);
        }
    assert_true(least < -0.1f);
    free(sorted), free(mask);
    gbuffer_free(&gb);
}

static void depthmask_of_a_step(void **state)
{
    gbuffer gb = clutter();
    for (int i = 0; i < PIXELS; i++) gb.depth[i] = i % WIDTH < WIDTH / 2 ? 3.0f : 7.5f;
    float *mask = mask_of(*state, &gb);
    for (int i = 0; i < PIXELS; i++) {
        int beyond = i % WIDTH - WIDTH / 2; // 0 in the first column behind the edge
        assert_true(beyond >= 0 && beyond < 2 ? mask[i] < -0.05f : beyond < 0 || beyond > 6 ? mask[i] == 0.0f : mask[i] <= 0.0f);
    }
    // Another unit gives the same bits if it is a power of two, and the same to rounding if not.
    const float scales[] = {1024.0f, 0.125f, 39.37f};
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < PIXELS; i++) gb.depth[i] = scales[k] * (i % WIDTH < WIDTH / 2 ? 3.0f : 7.5f);
        float *scaled = mask_of(*state, &gb);
        for (int i = 0; i < PIXELS; i++) assert_true(k < 2 ? scaled[i] == mask[i] : fabsf(scaled[i] - mask[i]) < 1e-5f);
        free(scaled);
    }
    // Flat, half of it background.
    for (int i = 0; i < PIXELS; i++) gb.depth[i] = i % WIDTH < WIDTH / 2 ? 0.0f : 7.3f;
    float *flat = mask_of(*state, &gb);
    for (int i = 0; i < PIXELS; i++) assert_true(flat[i] == 0.0f);
    free(flat), free(mask);
    gbuffer_free(&gb);
}

// A plane that recedes has no edge either: 0, also at the picture's borders, but where the Gaussian meets the depth that becomes
// 1, beyond which depths are cut; and there little.
static void depthmask_of_a_tilted_plane(void **state)
{
    error e = {0};
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        scene s = {0};
        gbuffer gb;
        scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), v3(0.5, 0.5, 0.5));
        view v = orthographic ? view_orthographic(WIDTH, HEIGHT, 3.0, 1.0) : view_perspective(WIDTH, HEIGHT, 40.0, 1.0);
        view_look(&v, v3(0.4, -4, 2.5), v3(0, 0, 0), 15.0);
        must(scene_gbuffer(&s, &v, &gb, &e), &e);
        float *mask = mask_of(*state, &gb), *sorted = malloc(sizeof(float) * PIXELS), least = 0.0f, border = 0.0f;
        memcpy(sorted, gb.depth, sizeof(float) * PIXELS);
        sort_floats(sorted, PIXELS);
        float far = sorted[PIXELS * 97 / 100];
        int reach = (int)ceil(0.03 * hypot(WIDTH, HEIGHT)), n = 0;
        for (int i = 0; i < PIXELS; i++) {
            int x = i % WIDTH, y = i / WIDTH;
            bool inside = true;
            for (int k = 0; inside && k < 4; k++) {
                int row = y + (k & 1 ? reach : -reach), column = x + (k & 2 ? reach : -reach);
                row = row < 0         ? 0
                      : row >= HEIGHT ? HEIGHT - 1
                                      : row,
                column = column < 0        ? 0
                         : column >= WIDTH ? WIDTH - 1
                                           : column;
                inside = gb.depth[row * WIDTH + column] < far;
            }
            assert_true(gb.depth[i] > 0.0f);
            if (inside) least = fminf(least, mask[i]), n++;
            border = fminf(border, mask[i]);
        }
        print_message("%s: %.6f inside, %.4f elsewhere\n", orthographic ? "orthographic" : "perspective", (double)least,
                      (double)border);
        assert_true(n > PIXELS / 2 && least == 0.0f && border > -0.02f);
        free(sorted), free(mask);
        gbuffer_free(&gb);
    }
}

// ---- scale and contrast

static float *occlusion_of(rig *r, const gbuffer *gb, const char *name, double scale, double contrast)
{
    error e = {0};
    frame_result out;
    pass_settings set = rig_settings(method_find(name), 0.5);
    set.samples = 16, set.blur = 0;
    set.scale = scale, set.contrast = contrast;
    must(rig_run(r, gb, method_find(name), &set, 1 << LAYER_OCCLUSION, &out, &e), &e);
    float *occlusion = out.layers[LAYER_OCCLUSION];
    out.layers[LAYER_OCCLUSION] = NULL;
    rig_free_result(&out);
    return occlusion;
}

// What is blocked times the scale, what is left to the power of the contrast; never below 0. Methods that are no obscurance hold
// a share: nothing of it is lost before.
static void look_is_the_formula(void **state)
{
    static const char *const names[] = {"arc", "hemisphere", "s3ho"};
    static const double looks[][2] = {{1.5, 1.0}, {1.0, 2.2}, {0.4, 0.5}, {6.0, 3.0}};
    gbuffer gb = clutter();
    for (int m = 0; m < 3; m++) {
        float *plain = occlusion_of(*state, &gb, names[m], 1.0, 1.0);
        for (int k = 0; k < 4; k++) {
            float *is = occlusion_of(*state, &gb, names[m], looks[k][0], looks[k][1]);
            double changed = 0.0;
            for (int i = 0; i < PIXELS; i++) {
                double wanted = pow(fmax(0.0, 1.0 - looks[k][0] * (1.0 - (double)plain[i])), looks[k][1]);
                changed = fmax(changed, fabs(wanted - (double)plain[i]));
                if (!(fabs((double)is[i] - wanted) <= 2e-5)) fail_msg("%s: %.7f, expected %.7f", names[m], (double)is[i], wanted);
            }
            assert_true(changed > 0.1);
            free(is);
        }
        free(plain);
    }
    gbuffer_free(&gb);
}

// ---- the composite, through whole frames

typedef struct whole {
    options o;
    log_t log;
    job j;
    frame_result r;
} whole;

static void run_whole(whole *x, const char *input, double depthmask, multiply_onto multiply)
{
    char output[64];
    error e = {0};
    snprintf(output, sizeof output, "/tmp/ssdo_looks_%d.exr", (int)getpid());
    options_defaults(&x->o);
    x->o.method = "hemisphere";
    x->o.samples = 16;
    x->o.layers = "occlusion,composite,depthmask";
    x->o.depthmask_strength = depthmask;
    x->o.multiply = multiply;
    x->o.keep_none = true;
    log_init(&x->log, LOG_QUIET);
    job_open(&x->j, &x->o, &x->log);
    must(frame_run(&x->j, input, output, &x->r, &e), &e);
    remove(output);
}

static void free_whole(whole *x)
{
    frame_free(&x->r);
    job_close(&x->j);
    log_free(&x->log);
}

static void depthmask_scales_the_composite(void **state)
{
    (void)state;
    static whole plain, masked;
    run_whole(&plain, "samples/still.exr", 0.0, MULTIPLY_DIFFUSE);
    run_whole(&masked, "samples/still.exr", 3.0, MULTIPLY_DIFFUSE);
    int n = plain.r.gb.width * plain.r.gb.height, changed = 0;
    for (int i = 0; i < n; i++) {
        float factor = fmaxf(0.0f, 1.0f + 3.0f * masked.r.layers[LAYER_DEPTHMASK][i]);
        for (int k = 0; k < 3; k++) {
            float was = plain.r.layers[LAYER_COMPOSITE][3 * i + k], is = masked.r.layers[LAYER_COMPOSITE][3 * i + k];
            assert_true(fabsf(is - factor * was) <= 1e-6f * fabsf(was));
            changed += is != was;
        }
    }
    assert_true(changed > 1000);
    free_whole(&plain);
    free_whole(&masked);
}

// The sample has Blender's own direct diffuse pass: by default only that is occluded.
static void occlusion_is_multiplied_onto_all(void **state)
{
    (void)state;
    static whole diffuse, all;
    run_whole(&diffuse, "samples/still.exr", 0.0, MULTIPLY_DIFFUSE);
    run_whole(&all, "samples/still.exr", 0.0, MULTIPLY_ALL);
    int n = all.r.gb.width * all.r.gb.height, differ = 0;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) {
            float is = all.r.layers[LAYER_COMPOSITE][3 * i + k], beauty = all.r.gb.beauty[4 * i + k];
            assert_true(fabsf(is - beauty * all.r.layers[LAYER_OCCLUSION][i]) <= 1e-5f * fabsf(beauty));
            differ += fabsf(is - diffuse.r.layers[LAYER_COMPOSITE][3 * i + k]) > 0.01f;
        }
    assert_true(differ > 1000);
    free_whole(&diffuse);
    free_whole(&all);
}

static void relit_composite(rig *r, gbuffer *gb, bool all, double amount, float *occlusion, float *specular, float *composite)
{
    error e = {0};
    pass_settings set = rig_settings(method_find("hemisphere"), 0.5);
    set.samples = 16;
    set.multiply_all = all;
    set.amount = amount;
    set.world_from_camera = m3_identity();
    pass_context c = {
        .g = &r->job.g, .log = &r->log, .set = set, .gb = gb, .env = &r->job.light.env, .environment = r->job.light.image};
    must(pass_begin(&c, &e), &e);
    must(method_find("hemisphere")->run(&c, &e) && pass_irradiance(&c, &e) && pass_specular(&c, &e) && pass_composite(&c, &e),
         &e);
    gpu_image_download(c.g, &c.image[IMAGE_OCCLUSION], occlusion);
    gpu_image_download(c.g, &c.image[IMAGE_SPECULAR], specular);
    gpu_image_download(c.g, &c.image[IMAGE_COMPOSITE], composite);
    pass_end(&c);
}

static void occlusion_reaches_the_specular_light(void **state)
{
    error e = {0};
    gbuffer gb = clutter();
    gb.material = mem_pixels(2 * PIXELS, sizeof(float), &e);
    for (int i = 0; i < PIXELS; i++) gb.material[2 * i] = 0.3f, gb.material[2 * i + 1] = 0.0f;
    float *v = calloc(PIXELS, 6 * 4 * sizeof *v), *occlusion = v, *specular = v + 4 * PIXELS, *is = v + 8 * PIXELS,
          *was = v + 12 * PIXELS;
    relit_composite(*state, &gb, false, 1.0, occlusion, specular, was);
    for (int half = 0; half < 2; half++) {
        float amount = half ? 0.5f : 1.0f, largest = 0.0f;
        relit_composite(*state, &gb, true, (double)amount, occlusion, specular, is);
        for (int i = 0; i < PIXELS; i++)
            for (int k = 0; k < 3; k++) {
                float gone = amount * (1.0f - occlusion[i]) * specular[4 * i + k];
                largest = fmaxf(largest, gone);
                if (!(fabsf(was[4 * i + k] - is[4 * i + k] - gone) < 1e-5f)) fail_msg("pixel %d", i);
            }
        assert_true(largest > 0.01f);
    }
    free(v);
    gbuffer_free(&gb);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(depthmask_is_the_unsharp_mask, open_rig, close_rig),
        cmocka_unit_test_setup_teardown(depthmask_of_a_step, open_rig, close_rig),
        cmocka_unit_test_setup_teardown(depthmask_of_a_tilted_plane, open_rig, close_rig),
        cmocka_unit_test_setup_teardown(look_is_the_formula, open_rig, close_rig),
        cmocka_unit_test(depthmask_scales_the_composite),
        cmocka_unit_test(occlusion_is_multiplied_onto_all),
        cmocka_unit_test_setup_teardown(occlusion_reaches_the_specular_light, open_rig, close_rig),
    };
    return cmocka_run_group_tests_name("looks", tests, NULL, NULL);
}
