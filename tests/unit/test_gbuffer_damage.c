// Warnings: filtered positions, normals and depths, and vectors that DWA took for colours. And none for a sound file.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <openexr_attr.h>

#include "must.h"
#include "scene_picture.h"

enum { W = 200, H = 130, FINE = 3 };

static log_t heard;

static bool warned(const char *a, const char *b)
{
    for (int i = 0; i < heard.warning_count; i++)
        if (strstr(heard.warnings[i], a) && strstr(heard.warnings[i], b)) return true;
    return false;
}

// The still life in plain names, P, N and Z float, FINE times as fine as W x H.
static exrio_file *render_as(int scale, scene_exr_options options)
{
    scene s = {0};
    error e = {0};
    scene_clutter(&s);
    view v = view_perspective(W * scale, H * scale, 45.0, 1.0);
    view_scene(&v, &s);
    options.convention = "plain";
    exrio_file *f = scene_file(&s, &v, &options, &e);
    must(f != NULL, &e);
    return f;
}

static exrio_file *render(int scale) { return render_as(scale, (scene_exr_options){0}); }

static float *data_of(const exrio_file *f, const char *name)
{
    for (int c = 0; c < f->parts[0].channel_count; c++)
        if (strcmp(f->parts[0].channels[c].name, name) == 0) return f->parts[0].channels[c].data;
    fail_msg("no channel %s", name);
    return NULL;
}

// A box filter over the fine picture's pixels.
static void filter_channel(const exrio_file *fine, exrio_file *to, const char *name)
{
    const float *from = data_of(fine, name);
    float *out = data_of(to, name);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            float sum = 0;
            for (int k = 0; k < FINE * FINE; k++) sum += from[(y * FINE + k / FINE) * W * FINE + x * FINE + k % FINE];
            out[y * W + x] = sum / (FINE * FINE);
        }
}

static void listen(const exrio_file *f)
{
    resolution r;
    gbuffer g;
    error e = {0};
    log_free(&heard);
    log_init(&heard, LOG_QUIET);
    must(resolve_channels(f, &(resolve_options){0}, &r, &heard, &e), &e);
    must(gbuffer_build(f, &r, &(gbuffer_options){.threads = 2}, &g, &heard, &e), &e);
    gbuffer_free(&g);
}

static void a_sound_file_is_not_warned_of(void **state)
{
    (void)state;
    exrio_file *f = render(1);
    listen(f);
    assert_int_equal(heard.warning_count, 0);
    scene_file_free(f);
}

static void filtered_passes_are_named(void **state)
{
    static const char *const cases[][5] = {{"position", "P.X", "P.Y", "P.Z"}, {"normal", "N.X", "N.Y", "N.Z"}, {"depth", "Z"}};
    (void)state;
    exrio_file *fine = render(FINE);
    for (int i = 0; i < 3; i++) {
        exrio_file *f = render(1);
        for (int c = 1; cases[i][c]; c++) filter_channel(fine, f, cases[i][c]);
        listen(f);
        for (int k = 0; k < 3; k++) {
            char text[64];
            snprintf(text, sizeof text, "the %s pass is anti-aliased", cases[k][0]);
            assert_int_equal(warned(text, "% of the edges"), k == i);
        }
        scene_file_free(f);
    }
    scene_file_free(fine);
}

// Pixels that are given one surface again have its normal, also where the file has none.
static void mended_pixels_have_normals(void **state)
{
    static const char *const filtered[] = {"P.X", "P.Y", "P.Z", "Z"}, *const dropped[] = {"N.X", "N.Y", "N.Z"};
    (void)state;
    exrio_file *fine = render(FINE), *f = render(1);
    for (int c = 0; c < 4; c++) filter_channel(fine, f, filtered[c]);
    for (int c = 0; c < f->parts[0].channel_count; c++)
        for (int k = 0; k < 3; k++)
            if (strcmp(f->parts[0].channels[c].name, dropped[k]) == 0) f->parts[0].channels[c].name[0] = 'u';
    resolution r;
    gbuffer g;
    error e = {0};
    must(resolve_channels(f, &(resolve_options){0}, &r, NULL, &e), &e);
    must(gbuffer_build(f, &r, &(gbuffer_options){.threads = 2}, &g, NULL, &e), &e);
    assert_true(g.normals_from_depth);
    for (int i = 0; i < W * H; i++) {
        const float *n = g.normal + 4 * i;
        if (g.depth[i] > 0.0f) assert_true(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0f) < 1e-4f);
    }
    gbuffer_free(&g);
    scene_file_free(f);
    scene_file_free(fine);
}

// What level 45 does to a Y (an error of about 0.01), and to nothing else of X Y Z.
static void dwa_is_named_with_its_channel_and_share(void **state)
{
    (void)state;
    exrio_file *f = render(1);
    float *y = data_of(f, "N.Y");
    for (int i = 0; i < W * H; i++) y[i] += 0.01f * (float)sin(0.7 * i);
    f->parts[0].compression = EXR_COMPRESSION_DWAA;
    listen(f);
    assert_true(warned("N.Y: DWA", "normal"));
    assert_true(warned("P.Y: DWA", "0 % of the pixels"));
    assert_false(warned("DWA", "N.X"));
    assert_false(warned("DWA", "depth"));
    const char *share = NULL;
    for (int i = 0; i < heard.warning_count; i++)
        if (strstr(heard.warnings[i], "N.Y")) share = strstr(heard.warnings[i], "; ");
    assert_non_null(share);
    assert_true(atof(share + 2) > 20.0); // per cent
    scene_file_free(f);
}

// B44 takes halves alone, whatever they hold; PXR24 takes floats, and is worth a word only where the pixels show it.
static void b44_and_pxr24_are_named_for_what_they_take(void **state)
{
    (void)state;
    exrio_file *f = render_as(1, (scene_exr_options){.half_position = true});
    const int b44[] = {EXR_COMPRESSION_B44, EXR_COMPRESSION_B44A};
    for (int i = 0; i < 2; i++) {
        f->parts[0].compression = b44[i];
        listen(f);
        assert_true(warned("P.X, P.Y, P.Z: B44", "half floats of the position pass"));
        assert_false(warned("B44", "normal") || warned("B44", "depth"));
    }
    scene_file_free(f);
    f = render(1);
    f->parts[0].compression = EXR_COMPRESSION_PXR24;
    listen(f);
    assert_int_equal(heard.warning_count, 0);
    float *y = data_of(f, "N.Y");
    for (int i = 0; i < W * H; i++) y[i] += 0.01f * (float)sin(0.7 * i);
    listen(f);
    assert_true(warned("N.X, N.Y, N.Z: PXR24", "floats of the normal pass to 24 bits"));
    assert_false(warned("PXR24", "position") || warned("PXR24", "depth"));
    scene_file_free(f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sound_file_is_not_warned_of),
        cmocka_unit_test(filtered_passes_are_named),
        cmocka_unit_test(mended_pixels_have_normals),
        cmocka_unit_test(dwa_is_named_with_its_channel_and_share),
        cmocka_unit_test(b44_and_pxr24_are_named_for_what_they_take),
    };
    log_init(&heard, LOG_QUIET);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    log_free(&heard);
    return failed;
}
