// Model only what a scene needs, seen through the report: passes, uploads and tiles of frames that lack this or that.
#include <json-c/json.h>
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

#include "exr/write.h"
#include "must.h"
#include "pipeline/frame.h"
#include "pipeline/report.h"
#include "scene_picture.h"

enum { WIDTH = 150, HEIGHT = 70 }; // 3 x 2 tiles

static const char *SKY = "samples/sky_soft.exr";

static void path_of(const char *name, char path[96]) { snprintf(path, 96, "/tmp/ssdo_report_%d_%s", (int)getpid(), name); }

// Filters a file as the program does and returns its report.
static json_object *report_by(const char *method_name, const char *input, const char *layers, const char *env)
{
    error e = {0};
    options o;
    log_t log;
    job j;
    frame_result r;
    char output[96], path[96];
    path_of("out.exr", output);
    path_of("report.json", path);
    options_defaults(&o);
    o.method = method_name;
    o.layers = layers;
    o.env = env;
    o.report = path;
    log_init(&log, LOG_QUIET);
    job_open(&j, &o, &log);
    j.no_floats = true; // as without a preview
    must(frame_run(&j, input, output, &r, &e), &e);
    must(report_write(&j, &r, output, path, &e), &e);
    json_object *report = json_object_from_file(path);
    assert_non_null(report);
    frame_free(&r);
    job_close(&j);
    log_free(&log);
    remove(output);
    remove(path);
    return report;
}

static json_object *report_for(const char *input, const char *layers, const char *env)
{
    return report_by("ssdo", input, layers, env); // has a bounce
}

// A picture of the clutter, without what the options leave out.
static void write_scene(scene_exr_options how, const char *path)
{
    static scene s;
    error e = {0};
    how.convention = "plain";
    scene_clutter(&s);
    view v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&v, &s);
    must(scene_write(&s, &v, &how, path, &e), &e);
}

static json_object *report_of_scene(scene_exr_options how, const char *layers, const char *env)
{
    char path[96];
    path_of("in.exr", path);
    write_scene(how, path);
    json_object *report = report_for(path, layers, env);
    remove(path);
    return report;
}

static json_object *field(json_object *o, const char *key)
{
    json_object *v = NULL;
    if (!json_object_object_get_ex(o, key, &v)) fail_msg("the report has no '%s'", key);
    return v;
}

// The entry of a list whose `key` is `name`; NULL without one.
static json_object *entry(json_object *report, const char *list, const char *key, const char *name)
{
    json_object *l = field(report, list);
    for (size_t i = 0; i < json_object_array_length(l); i++) {
        json_object *o = json_object_array_get_idx(l, i);
        if (strcmp(json_object_get_string(field(o, key)), name) == 0) return o;
    }
    return NULL;
}

static bool runs(json_object *report, const char *pass)
{
    json_object *o = entry(report, "passes", "pass", pass);
    if (!o) fail_msg("the report does not list pass '%s'", pass);
    return json_object_get_boolean(field(o, "runs"));
}

static const char *why(json_object *report, const char *pass)
{
    return json_object_get_string(field(entry(report, "passes", "pass", pass), "why"));
}

static bool uploads(json_object *report, const char *name) { return entry(report, "uploads", "name", name) != NULL; }
static bool timed(json_object *report, const char *name) { return entry(report, "times", "stage", name) != NULL; }
static int64_t bytes_of(json_object *report, const char *name)
{
    return json_object_get_int64(field(entry(report, "uploads", "name", name), "bytes"));
}

static int64_t gl(json_object *report, const char *what) { return json_object_get_int64(field(field(report, "gl"), what)); }

static void no_roughness_no_specular(void **state)
{
    (void)state;
    json_object *r = report_of_scene((scene_exr_options){0}, NULL, SKY);
    assert_false(runs(r, "specular"));
    assert_string_equal(why(r, "specular"), "no roughness");
    assert_false(timed(r, "specular"));
    assert_false(uploads(r, "material"));
    assert_true(uploads(r, "environment"));
    assert_true(runs(r, "bounce"));
    assert_true(timed(r, "ssdo_bounce"));
    json_object_put(r);
}

// The same file with a constant roughness: the pass is there when it is needed.
static void roughness_brings_specular(void **state)
{
    (void)state;
    static scene s;
    error e = {0};
    char path[96];
    scene_clutter(&s);
    view v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&v, &s);
    exrio_file *f = scene_file(&s, &v, &(scene_exr_options){.convention = "plain"}, &e);
    must(f != NULL, &e);
    const exrio_part *from = &f->parts[0];
    static float roughness[WIDTH * HEIGHT];
    for (int i = 0; i < WIDTH * HEIGHT; i++) roughness[i] = 0.4f;
    exrio_out_channel channels[32];
    int n = 0;
    for (; n < from->channel_count; n++)
        channels[n] = (exrio_out_channel){from->channels[n].name, from->channels[n].type, from->channels[n].data};
    channels[n++] = (exrio_out_channel){"roughness", SAMPLE_FLOAT, roughness};
    exrio_out_part part = {.data_window = from->data_window,
                           .display_window = from->display_window,
                           .pixel_aspect = from->pixel_aspect,
                           .channels = channels,
                           .channel_count = n};
    path_of("rough.exr", path);
    must(exrio_write(path, &part, 1, 1, &e), &e);
    scene_file_free(f);
    json_object *r = report_for(path, NULL, SKY);
    assert_true(runs(r, "specular"));
    assert_true(timed(r, "specular"));
    assert_true(uploads(r, "material"));
    remove(path);
    json_object_put(r);
}

static void no_albedo_no_bounce(void **state)
{
    (void)state;
    json_object *r = report_of_scene((scene_exr_options){.no_albedo = true}, NULL, SKY);
    assert_false(runs(r, "bounce"));
    assert_string_equal(why(r, "bounce"), "no albedo");
    assert_false(timed(r, "ssdo_bounce"));
    assert_false(uploads(r, "albedo"));
    json_object_put(r);
}

static void no_environment_no_map(void **state)
{
    (void)state;
    json_object *r = report_of_scene((scene_exr_options){0}, NULL, NULL);
    assert_false(uploads(r, "environment"));
    assert_false(runs(r, "specular"));
    json_object_put(r);
    r = report_of_scene((scene_exr_options){0}, "occlusion", SKY); // given, but nothing needs it
    assert_false(runs(r, "irradiance"));
    assert_false(uploads(r, "environment"));
    json_object_put(r);
}

static void occlusion_uploads_depth_and_normals(void **state)
{
    (void)state;
    json_object *r = report_of_scene((scene_exr_options){0}, "occlusion", NULL);
    assert_int_equal(json_object_array_length(field(r, "uploads")), 2);
    assert_int_equal(bytes_of(r, "depth"), 4 * WIDTH * HEIGHT);
    assert_int_equal(bytes_of(r, "normal"), 16 * WIDTH * HEIGHT);
    assert_int_equal(json_object_array_length(field(r, "layers")), 1);
    assert_string_equal(json_object_get_string(json_object_array_get_idx(field(r, "layers"), 0)), "occlusion");
    assert_int_equal(gl(r, "uploads"), 2);
    assert_int_equal(gl(r, "bytes_up"), 20 * WIDTH * HEIGHT);
    assert_int_equal(gl(r, "bytes_down"), 4 * WIDTH * HEIGHT);
    assert_false(runs(r, "composite"));
    assert_false(runs(r, "edges"));
    json_object_put(r);
}

// A small sphere in the middle tile of the upper row, nothing anywhere else.
static void write_sphere(char *path)
{
    static scene s;
    error e = {0};
    s = (scene){.eye = v3(0, -5, 0), .target = v3(0, 0, 0), .radius = 0.2};
    scene_add_sphere(&s, v3(0.4, 0, 0.25), 0.2, v3(0.5, 0.5, 0.5));
    view v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&v, &s);
    path_of("empty.exr", path);
    must(scene_write(&s, &v, &(scene_exr_options){.convention = "plain", .edge_samples = 3}, path, &e), &e);
}

// The beauty is what is seen behind surfaces that are relit: where they cover all, nobody looks at it.
static void beauty_is_uploaded_where_it_is_seen(void **state)
{
    char path[96];
    (void)state;
    json_object *r = report_of_scene((scene_exr_options){0}, NULL, SKY);
    assert_true(json_object_get_double(field(r, "valid_share")) == 1.0);
    assert_true(uploads(r, "albedo"));
    assert_false(uploads(r, "beauty"));
    assert_false(uploads(r, "coverage"));
    json_object_put(r);
    write_sphere(path);
    r = report_for(path, NULL, SKY);
    assert_int_equal(bytes_of(r, "beauty"), 16 * WIDTH * HEIGHT);
    assert_int_equal(bytes_of(r, "coverage"), 4 * WIDTH * HEIGHT);
    json_object_put(r);
    remove(path);
}

static void empty_tiles_are_not_dispatched(void **state)
{
    (void)state;
    char path[96];
    write_sphere(path);
    json_object *r = report_for(path, "occlusion", NULL);
    json_object *tiles = field(r, "tiles");
    assert_int_equal(json_object_get_int(field(tiles, "dispatched")), 1);
    assert_int_equal(json_object_get_int(field(tiles, "skipped")), 5);
    assert_int_equal(json_object_get_int(field(entry(r, "times", "stage", "ssdo"), "tiles")), 1);
    int64_t sparse = gl(r, "dispatches") + gl(r, "draws");
    assert_true(gl(r, "dispatches") > 0 && gl(r, "barriers") > 0);
    json_object_put(r);
    remove(path);
    r = report_of_scene((scene_exr_options){0}, "occlusion", NULL);
    assert_true(gl(r, "dispatches") + gl(r, "draws") > sparse);
    json_object_put(r);
}

// arc marches for what is asked for, and once for what one march can serve.
static void marches_are_those_needed(void **state)
{
    static const char *const marches[] = {"arc", "arc light", "arc bounce", "arc light+bounce"};
    static const struct {
        const char *layers, *env;
        bool runs[4];
    } cases[] = {
        {"occlusion", NULL, {true}},
        {"occlusion", "samples/sky_soft.exr", {true}},
        {"radiance", "samples/sky_soft.exr", {true, true}},
        {"indirect", NULL, {true, false, true}},
        {"indirect", "samples/sky_soft.exr", {true, true, false, true}}, // the first light, then both at once
        {NULL, "samples/sky_soft.exr", {true, true, false, true}},
        {NULL, NULL, {true, false, false, true}}, // the beauty bounces
    };
    (void)state;
    char path[96];
    path_of("marches.exr", path);
    write_scene((scene_exr_options){0}, path);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        json_object *r = report_by("arc", path, cases[i].layers, cases[i].env);
        for (int k = 0; k < 4; k++)
            if (timed(r, marches[k]) != cases[i].runs[k])
                fail_msg("--layers %s, %s: march '%s' %s", cases[i].layers ? cases[i].layers : "(default)",
                         cases[i].env ? cases[i].env : "no environment", marches[k],
                         cases[i].runs[k] ? "is missing" : "runs and nobody needs it");
        json_object_put(r);
    }
    remove(path);
}

static void the_rest_is_there(void **state)
{
    static const char *stages[] = {"read", "resolve", "passes", "upload", "ssdo", "blur", "read back", "convert", "write"};
    (void)state;
    json_object *r = report_of_scene((scene_exr_options){0}, NULL, SKY);
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++) {
        json_object *o = entry(r, "times", "stage", stages[i]);
        if (!o) fail_msg("stage '%s' is not timed", stages[i]);
        assert_true(json_object_get_double(field(o, "wall_ms")) >= 0.0);
    }
    double left = json_object_get_double(field(r, "off_frame_share")), valid = json_object_get_double(field(r, "valid_share"));
    assert_true(left > 0.0 && left < 0.5);
    assert_true(valid > 0.5 && valid <= 1.0);
    assert_true(json_object_get_int(field(r, "samples")) == 64);
    assert_true(json_object_get_double(field(field(r, "camera"), "residual_px")) < 0.1);
    json_object_put(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_roughness_no_specular),
        cmocka_unit_test(roughness_brings_specular),
        cmocka_unit_test(no_albedo_no_bounce),
        cmocka_unit_test(no_environment_no_map),
        cmocka_unit_test(occlusion_uploads_depth_and_normals),
        cmocka_unit_test(beauty_is_uploaded_where_it_is_seen),
        cmocka_unit_test(empty_tiles_are_not_dispatched),
        cmocka_unit_test(marches_are_those_needed),
        cmocka_unit_test(the_rest_is_there),
    };
    return cmocka_run_group_tests_name("report", tests, NULL, NULL);
}
