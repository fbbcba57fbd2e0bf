// Colour: the albedo's space, displays and views of a real OpenColorIO config (Blender's), primaries of environment and picture.
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

#include "light/primaries.h"
#include "modules.h"
#include "must.h"
#include "pipeline/frame.h"
#include "plugin/colour.h"
#include "renderer_file.h"

static const char config[] = "/usr/share/blender/datafiles/colormanagement/config.ocio"; // Debian's blender-data
static char folder[] = "/tmp/ssdo-colour-XXXXXX";
static const double acescg[8] = {0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767};

static int set_up(void **state)
{
    (void)state;
    use_built_modules();
    unsetenv("OCIO");
    return mkdtemp(folder) ? 0 : -1;
}

static int tear_down(void **state)
{
    char command[64];
    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

static bool have_config(void)
{
    if (access(config, R_OK) == 0) return true;
    print_message("note: %s is not there (package blender-data), so this is not checked\n", config);
    return false;
}

static double srgb(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055; }

static void the_standard_view_is_srgb_and_filmic_is_not(void **state)
{
    (void)state;
    error e = {0};
    float a[6] = {0.18f, 0.5f, 1.0f, 0.0f, 0.02f, 0.8f}, b[3] = {0.18f, 0.5f, 1.0f}, c[3] = {0.18f, 0.5f, 1.0f};
    const double linear[6] = {0.18, 0.5, 1.0, 0.0, 0.02, 0.8};
    if (!have_config()) skip();
    must(colour_to_display(config, "sRGB", "Standard", a, 2, &e), &e);
    for (int i = 0; i < 6; i++) assert_true(fabs((double)a[i] - srgb(linear[i])) < 2e-3);
    must(colour_to_display(config, NULL, "Filmic", b, 1, &e), &e);
    assert_true((double)b[2] < 0.9); // white is kept below the display's
    setenv("OCIO", config, 1);
    must(colour_to_display(NULL, NULL, NULL, c, 1, &e), &e);
    unsetenv("OCIO");
    for (int i = 0; i < 3; i++) assert_true(fabs((double)c[i] - srgb(linear[i])) < 2e-3);
}

static void unknown_names_list_those_there_are(void **state)
{
    (void)state;
    float v[3] = {0};
    error e = {0};
    if (!have_config()) skip();
    assert_false(colour_to_display(config, "sRGB", "Nice", v, 1, &e));
    assert_non_null(strstr(e.message, "Filmic"));
    e = (error){0};
    assert_false(colour_to_display(config, "Wall", NULL, v, 1, &e));
    assert_non_null(strstr(e.message, "sRGB"));
    e = (error){0};
    assert_false(colour_to_display(NULL, NULL, NULL, v, 1, &e));
    assert_int_equal(e.code, ERR_USAGE);
    assert_non_null(strstr(e.message, "--ocio"));
}

// Bradford-adapted Rec. 709 to ACEScg, as published with ACES (four digits).
static void primaries_are_adapted(void **state)
{
    static const double known[3][3] = {{0.6131, 0.3395, 0.0474}, {0.0702, 0.9164, 0.0135}, {0.0206, 0.1096, 0.8698}};
    static const double line[8] = {0.1, 0.1, 0.2, 0.2, 0.3, 0.3, 0.3127, 0.329};
    (void)state;
    mat3 m;
    assert_true(primaries_between(primaries_rec709, acescg, &m));
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) assert_true(fabs(m.m[r][c] - known[r][c]) < 2e-4);
    assert_false(primaries_between(line, acescg, &m));
}

// The scene with its albedo as it is or encoded with sRGB's curve; the path of the file.
static const char *write_scene(bool encoded)
{
    static const renderer_fact plain = {
        .expected = "plain", .position = "P:XYZ", .normal = "N:XYZ", .depth = "Z", .albedo = "albedo:RGB"};
    static char path[256];
    char paths[FACT_FILES][256];
    int count;
    scene s = {0};
    error e = {0};
    scene_clutter(&s);
    for (int i = 0; encoded && i < s.shape_count; i++) {
        vec3 *a = &s.shapes[i].albedo;
        *a = v3(srgb(a->x), srgb(a->y), srgb(a->z));
    }
    view v = view_perspective(96, 64, 45.0, 1.0);
    view_scene(&v, &s);
    must(renderer_write(&plain, &s, &v, folder, paths, &count, &e), &e);
    snprintf(path, sizeof path, "%s", paths[0]);
    return path;
}

static void filter(const char *path, const char *space, frame_result *r)
{
    error e = {0};
    options o;
    log_t log;
    job j;
    options_defaults(&o);
    o.samples = 16, o.albedo_colorspace = space, o.ocio = space ? config : NULL;
    log_init(&log, LOG_QUIET);
    job_open(&j, &o, &log);
    must(frame_read(&j, path, r, &e), &e);
    must(frame_filter(&j, r, &e), &e);
    job_close(&j);
    log_free(&log);
}

static void an_encoded_albedo_gives_the_linear_ones_bounce(void **state)
{
    (void)state;
    frame_result linear, encoded;
    if (!have_config()) skip();
    filter(write_scene(false), NULL, &linear);
    filter(write_scene(true), "sRGB", &encoded);
    size_t n = 3 * (size_t)linear.gb.width * (size_t)linear.gb.height;
    double worst = 0, light = 0;
    for (size_t i = 0; i < n; i++) {
        worst = fmax(worst, fabs((double)linear.layers[LAYER_INDIRECT][i] - (double)encoded.layers[LAYER_INDIRECT][i]));
        light = fmax(light, (double)linear.layers[LAYER_INDIRECT][i]);
    }
    print_message("    largest difference %.2g of at most %.2g\n", worst, light);
    assert_true(light > 0.1 && worst < 2e-3 * light);
    // The file's own channels and the geometry are never touched.
    size_t pixels = n / 3;
    assert_memory_equal(linear.gb.depth, encoded.gb.depth, pixels * sizeof(float));
    assert_memory_equal(linear.layers[LAYER_OCCLUSION], encoded.layers[LAYER_OCCLUSION], pixels * sizeof(float));
    frame_free(&linear);
    frame_free(&encoded);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_standard_view_is_srgb_and_filmic_is_not),
        cmocka_unit_test(unknown_names_list_those_there_are),
        cmocka_unit_test(primaries_are_adapted),
        cmocka_unit_test(an_encoded_albedo_gives_the_linear_ones_bounce),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
