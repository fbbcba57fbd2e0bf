// Stereo files (OpenEXR's multi-view standard): each view is filtered as its own file would be, and written into its own parts.
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

enum { WIDTH = 96, HEIGHT = 64, EYES = 2, GROUPS = 5 };

static char folder[] = "/tmp/ssdo-stereo-XXXXXX";
static const char *const eyes[EYES] = {"left", "right"};
static char mono[EYES][256]; // each eye's own file
static options settings;
static log_t quiet;
static job work;

static int set_up(void **state)
{
    static const renderer_fact plain = {.expected = "plain",
                                        .position = "P:XYZ",
                                        .normal = "N:XYZ",
                                        .depth = "depth:Z",
                                        .albedo = "albedo:RGB",
                                        .beauty = ":RGBA"};
    error e = {0};
    scene s = {0};
    (void)state;
    if (!mkdtemp(folder)) return -1;
    scene_clutter(&s);
    for (int i = 0; i < EYES; i++) {
        char paths[FACT_FILES][256];
        int count;
        view v = view_perspective(WIDTH, HEIGHT, i ? 48.0 : 45.0, 1.0); // the lenses differ too
        view_look(&v, v3_add(s.eye, v3(0.4 * i, 0, 0)), v3_add(s.target, v3(0.1 * i, 0, 0)), 0);
        must(renderer_write(&plain, &s, &v, folder, paths, &count, &e), &e);
        snprintf(mono[i], sizeof mono[i], "%s/%s.exr", folder, eyes[i]);
        assert_int_equal(rename(paths[0], mono[i]), 0);
    }
    options_defaults(&settings);
    settings.radius_unit = RADIUS_WORLD, settings.radius = 0.8, settings.samples = 16;
    log_init(&quiet, LOG_QUIET);
    job_open(&work, &settings, &quiet);
    return 0;
}

static int tear_down(void **state)
{
    char command[64];
    (void)state;
    job_close(&work);
    log_free(&quiet);
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

// Both eyes as parts of one file: a part per eye, or one per eye and layer.
static void write_stereo(const char *path, bool part_per_layer)
{
    static const char *const layers[GROUPS] = {"", "P.", "N.", "depth.", "albedo."};
    static exrio_out_channel channels[EYES * GROUPS][16];
    static char names[EYES * GROUPS][32];
    exrio_out_part parts[EYES * GROUPS] = {0};
    exrio_file *files[EYES];
    error e = {0};
    int n = 0;
    for (int i = 0; i < EYES; i++) {
        must(exrio_file_open(mono[i], &files[i], &e), &e);
        exrio_part *from = &files[i]->parts[0];
        for (int c = 0; c < from->channel_count; c++) from->channels[c].wanted = true;
        must(exrio_file_load(files[i], 1, &e), &e);
        for (int g = 0; g < (part_per_layer ? GROUPS : 1); g++, n++) {
            snprintf(names[n], sizeof names[n], "%s%s", part_per_layer ? g ? layers[g] : "rgba." : "", eyes[i]);
            parts[n] = (exrio_out_part){.name = names[n],
                                        .view = eyes[i],
                                        .data_window = from->data_window,
                                        .display_window = from->display_window,
                                        .pixel_aspect = 1,
                                        .compression = 3,
                                        .channels = channels[n]};
            for (int c = 0; c < from->channel_count; c++) {
                const exrio_channel *ch = &from->channels[c];
                bool in = g ? strncmp(ch->name, layers[g], strlen(layers[g])) == 0 : !strchr(ch->name, '.');
                if (!in && part_per_layer) continue;
                // Within a part of its own, the layer's name is the part's.
                const char *name = part_per_layer && g ? ch->name + strlen(layers[g]) : ch->name;
                channels[n][parts[n].channel_count++] = (exrio_out_channel){name, ch->type, ch->data};
            }
        }
    }
    must(exrio_write(path, parts, n, 1, &e), &e);
    for (int i = 0; i < EYES; i++) exrio_file_close(files[i]);
}

// How names tell the eyes apart: P.left.X and P.right.X; the left one without its name, P.X; in front, left.P.X and right.P.X. R
// is the left eye's and right.R the other's in any case.
typedef enum naming { BEFORE_COMPONENT, LEFT_BARE, IN_FRONT, NAMINGS } naming;

// Both eyes in one part.
static void write_names(const char *path, naming how)
{
    exrio_out_channel channels[EYES * 16];
    static char names[EYES * 16][64];
    exrio_out_attr multi = {.name = "multiView", .kind = EXRIO_OUT_STRINGS, .strings = {"left", "right"}, .string_count = EYES};
    exrio_out_part part = {.pixel_aspect = 1, .compression = 3, .channels = channels, .attributes = &multi, .attribute_count = 1};
    exrio_file *files[EYES];
    error e = {0};
    for (int i = 0; i < EYES; i++) {
        must(exrio_file_open(mono[i], &files[i], &e), &e);
        exrio_part *from = &files[i]->parts[0];
        part.data_window = from->data_window, part.display_window = from->display_window;
        for (int c = 0; c < from->channel_count; c++) from->channels[c].wanted = true;
        must(exrio_file_load(files[i], 1, &e), &e);
        for (int c = 0; c < from->channel_count; c++) {
            const exrio_channel *ch = &from->channels[c];
            const char *dot = strrchr(ch->name, '.');
            char *name = names[part.channel_count];
            if (i == 0 && (how == LEFT_BARE || !dot))
                snprintf(name, sizeof *names, "%s", ch->name);
            else if (how == IN_FRONT)
                snprintf(name, sizeof *names, "%s.%s", eyes[i], ch->name);
            else
                snprintf(name, sizeof *names, "%.*s%s.%s", dot ? (int)(dot + 1 - ch->name) : 0, ch->name, eyes[i],
                         dot ? dot + 1 : ch->name);
            channels[part.channel_count++] = (exrio_out_channel){name, ch->type, ch->data};
        }
    }
    must(exrio_write(path, &part, 1, 1, &e), &e);
    for (int i = 0; i < EYES; i++) exrio_file_close(files[i]);
}

static void same_layers(const frame_result *a, const frame_result *b)
{
    for (int l = LAYER_OCCLUSION; l <= LAYER_COMPOSITE; l++) {
        size_t n = (size_t)a->gb.width * (size_t)a->gb.height * strlen(layer_table[l]->channels);
        assert_true(a->layers[l] && b->layers[l]);
        assert_memory_equal(a->layers[l], b->layers[l], n * sizeof(float));
    }
}

static int channel_count(const exrio_file *f, const char *eye, const char *name)
{
    int n = 0;
    for (int p = 0; p < f->part_count; p++)
        for (int c = 0; c < f->parts[p].channel_count; c++)
            n += strcmp(f->parts[p].view, eye) == 0 && strcmp(f->parts[p].channels[c].name, name) == 0;
    return n;
}

// Both eyes' layers under way at a time, as in a sequence on hardware.
static void filter_together(const char *in, const frame_result *both)
{
    error e = {0};
    frame_result r;
    work.g.mapped = true;
    must(frame_read(&work, in, &r, &e) && frame_prepare(&work, &r, &e) && frame_begin(&work, &r, &e), &e);
    assert_true(r.bands && r.next_view->bands);
    must(frame_wait(&work, &r, &e) && frame_convert(&work, &r, &e), &e);
    same_layers(&r, both);
    same_layers(r.next_view, both->next_view);
    frame_free(&r);
    work.g.mapped = false;
}

// Each eye's layers are what its own file gives.
static void filter_both(const char *in, const char *out)
{
    error e = {0};
    frame_result both, one;
    must(frame_run(&work, in, out, &both, &e), &e);
    const frame_result *v = &both;
    for (int i = 0; i < EYES; i++, v = v->next_view) {
        assert_non_null(v);
        assert_string_equal(v->view, eyes[i]);
        must(frame_read(&work, mono[i], &one, &e), &e);
        must(frame_filter(&work, &one, &e), &e);
        same_layers(v, &one);
        frame_free(&one);
    }
    assert_null(v);
    filter_together(in, &both);
    assert_true(fabs(both.gb.camera.fx / both.next_view->gb.camera.fx - 1.0) > 0.05); // each has its own lens
    frame_free(&both);
}

static void check(bool part_per_layer, bool multipart, int parts)
{
    char in[300], out[300];
    error e = {0};
    exrio_file *f;
    snprintf(in, sizeof in, "%s/stereo.exr", folder);
    snprintf(out, sizeof out, "%s/out.exr", folder);
    write_stereo(in, part_per_layer);
    settings.multipart = multipart;
    filter_both(in, out);
    must(exrio_file_open(out, &f, &e), &e);
    assert_int_equal(f->part_count, parts);
    for (int i = 0; i < EYES; i++) {
        const char *want[] = {"occlusion.R", "radiance.G", "indirect.B", "composite.R", "composite.A", "R"};
        for (int k = 0; k < 6; k++) assert_int_equal(channel_count(f, eyes[i], want[k]), part_per_layer && k == 5 ? 2 : 1);
    }
    exrio_file_close(f);
}

static void a_part_per_eye(void **state)
{
    (void)state;
    check(false, false, 2);
    check(false, true, 4);
}

static void a_part_per_eye_and_layer(void **state)
{
    (void)state;
    check(true, false, 12);
}

// --view-layer names one eye; the other passes through.
static void one_eye_of_two(void **state)
{
    char in[300], out[300];
    error e = {0};
    frame_result r;
    exrio_file *f;
    (void)state;
    snprintf(in, sizeof in, "%s/stereo.exr", folder);
    snprintf(out, sizeof out, "%s/out.exr", folder);
    write_stereo(in, false);
    settings.multipart = false;
    settings.view_layer = "right";
    must(frame_run(&work, in, out, &r, &e), &e);
    assert_null(r.next_view);
    frame_free(&r);
    must(exrio_file_open(out, &f, &e), &e);
    assert_int_equal(f->part_count, 2);
    assert_string_equal(f->parts[0].view, "left");
    assert_int_equal(channel_count(f, "right", "occlusion.R"), 1);
    assert_int_equal(channel_count(f, "left", "occlusion.R"), 0);
    assert_int_equal(channel_count(f, "left", "P.X"), 1);
    exrio_file_close(f);
    settings.view_layer = NULL;
}

static int has(const exrio_file *f, const char *name) { return channel_count(f, "", name); }

// The views are in the names: so are ours, in the one part, by OpenEXR's rule. A second run replaces them.
static void views_in_names(void **state)
{
    static const char *const want[] = {"occlusion.left.R", "occlusion.right.R", "radiance.left.G", "radiance.right.G",
                                       "composite.left.A", "composite.right.A", "indirect.right.B"};
    char in[300], out[300], again[300];
    const char *text;
    error e = {0};
    exrio_file *f;
    (void)state;
    snprintf(in, sizeof in, "%s/names.exr", folder);
    snprintf(out, sizeof out, "%s/out.exr", folder);
    snprintf(again, sizeof again, "%s/again.exr", folder);
    settings.multipart = false;
    for (naming how = BEFORE_COMPONENT; how < NAMINGS; how++) {
        static const char *const left_x[NAMINGS] = {"P.left.X", "P.X", "left.P.X"};
        write_names(in, how);
        filter_both(in, out);
        filter_both(out, again);
        must(exrio_file_open(again, &f, &e), &e);
        assert_int_equal(f->part_count, 1);
        assert_string_equal(f->parts[0].view, "");
        assert_int_equal(f->parts[0].view_count, EYES);
        assert_int_equal(f->parts[0].channel_count, EYES * (14 + 11));
        for (size_t i = 0; i < sizeof want / sizeof *want; i++) assert_int_equal(has(f, want[i]), 1);
        assert_int_equal(has(f, left_x[how]), 1);
        assert_int_equal(has(f, how == IN_FRONT ? "right.P.X" : "P.right.X"), 1);
        assert_true(exrio_attr_string(f, 0, "ssdo/camera", &text) && exrio_attr_string(f, 0, "ssdo/camera.right", &text));
        exrio_file_close(f);
    }
}

// In a part of their own, too; --main composite gives each eye its picture; --view-layer takes one eye, whose pass goes first.
static void views_in_names_otherwise(void **state)
{
    char in[300], out[300];
    error e = {0};
    frame_result r;
    exrio_file *f;
    (void)state;
    snprintf(in, sizeof in, "%s/names.exr", folder);
    snprintf(out, sizeof out, "%s/out.exr", folder);
    write_names(in, BEFORE_COMPONENT);
    settings.multipart = true;
    filter_both(in, out);
    must(exrio_file_open(out, &f, &e), &e);
    assert_int_equal(f->part_count, 2);
    assert_string_equal(f->parts[1].name, "ssdo");
    assert_int_equal(f->parts[1].view_count, EYES);
    assert_int_equal(has(f, "occlusion.right.R"), 1);
    exrio_file_close(f);
    settings.multipart = false;

    settings.main_composite = settings.keep_none = true;
    filter_both(in, out);
    must(exrio_file_open(out, &f, &e), &e);
    assert_int_equal(f->parts[0].channel_count, EYES * (11 + 4));
    assert_int_equal(has(f, "R") + has(f, "A") + has(f, "right.R") + has(f, "right.A"), 4);
    exrio_file_close(f);
    settings.main_composite = settings.keep_none = false;

    settings.view_layer = "right";
    must(frame_run(&work, in, out, &r, &e), &e);
    assert_null(r.next_view);
    assert_string_equal(r.view, "right");
    frame_free(&r);
    must(exrio_file_open(out, &f, &e), &e);
    assert_int_equal(has(f, "occlusion.right.R"), 1);
    assert_int_equal(has(f, "occlusion.left.R"), 0);
    assert_int_equal(has(f, "P.left.X"), 1);
    exrio_file_close(f);
    settings.view_layer = NULL;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_part_per_eye), cmocka_unit_test(a_part_per_eye_and_layer), cmocka_unit_test(one_eye_of_two),
        cmocka_unit_test(views_in_names), cmocka_unit_test(views_in_names_otherwise),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
