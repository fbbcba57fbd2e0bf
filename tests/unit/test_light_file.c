// Reading environment maps from files.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/half.h"
#include "exr/write.h"
#include "modules.h"
#include "plugin/colour.h"
#include "test_light.h"

static const char *temporary(void)
{
    static char path[64];
    snprintf(path, sizeof path, "/tmp/ssdo-test-light-%ld.exr", (long)getpid());
    return path;
}

typedef struct channel_spec {
    const char *name;
    sample_type type;
    double base; // sample i holds base + i
} channel_spec;

// A file of one part, its channels filled with base + index.
static void write_map(box2 data, box2 display, const channel_spec *specs, int count)
{
    int texels = box2_width(data) * box2_height(data);
    exrio_out_channel channels[8];
    for (int c = 0; c < count; c++) {
        void *samples = calloc((size_t)texels, sample_size(specs[c].type));
        assert_non_null(samples);
        for (int i = 0; i < texels; i++) {
            if (specs[c].type == SAMPLE_HALF)
                ((uint16_t *)samples)[i] = float_to_half((float)(specs[c].base + i));
            else if (specs[c].type == SAMPLE_FLOAT)
                ((float *)samples)[i] = (float)(specs[c].base + i);
            else
                ((uint32_t *)samples)[i] = (uint32_t)(specs[c].base + i);
        }
        channels[c] = (exrio_out_channel){specs[c].name, specs[c].type, samples};
    }
    exrio_out_part part = {.data_window = data,
                           .display_window = display,
                           .pixel_aspect = 1,
                           .compression = 3, // zip
                           .channels = channels,
                           .channel_count = count};
    error e = {0};
    if (!exrio_write(temporary(), &part, 1, 1, &e)) fail_msg("%s", e.message);
    for (int c = 0; c < count; c++) free((void *)(uintptr_t)channels[c].data);
}

static bool load(environment *env, log_t *log, error *e)
{
    env_options options = {.path = temporary(), .up_z = true, .scale = 1, .threads = 1};
    *e = (error){0};
    bool ok = environment_load(&options, env, log, e);
    unlink(temporary());
    return ok;
}

// Channel c of texel i must be base[c] + i.
static void expect(const channel_spec *specs, int count, double r, double g, double b)
{
    const box2 window = {0, 0, 7, 3};
    environment env;
    error e;
    write_map(window, window, specs, count);
    if (!load(&env, NULL, &e)) fail_msg("%s", e.message);
    assert_int_equal(env.levels[0].width, 8);
    assert_int_equal(env.levels[0].height, 4);
    assert_false(env.white);
    const double base[3] = {r, g, b};
    for (int i = 0; i < 32; i++)
        for (int c = 0; c < 3; c++) assert_near(env.levels[0].rgba[4 * i + c], base[c] + i, 0);
    environment_free(&env);
}

static void channels_are_found(void **state)
{
    (void)state;
    const channel_spec plain[] = {
        {"A", SAMPLE_FLOAT, 900}, {"R", SAMPLE_FLOAT, 100}, {"G", SAMPLE_FLOAT, 200}, {"B", SAMPLE_FLOAT, 300}};
    expect(plain, 4, 100, 200, 300);
    const channel_spec half[] = {{"R", SAMPLE_HALF, 100}, {"G", SAMPLE_HALF, 200}, {"B", SAMPLE_FLOAT, 300}};
    expect(half, 3, 100, 200, 300);
    const channel_spec layered[] = {
        {"sky.B", SAMPLE_HALF, 3}, {"sky.G", SAMPLE_HALF, 2}, {"sky.R", SAMPLE_HALF, 1}, {"Z", SAMPLE_FLOAT, 9}};
    expect(layered, 4, 1, 2, 3);
    const channel_spec both[] = {{"a.R", SAMPLE_HALF, 1}, {"a.G", SAMPLE_HALF, 1}, {"a.B", SAMPLE_HALF, 1},
                                 {"R", SAMPLE_HALF, 4},   {"G", SAMPLE_HALF, 5},   {"B", SAMPLE_HALF, 6}};
    expect(both, 6, 4, 5, 6); // the unnamed layer comes first
    const channel_spec grey[] = {{"Y", SAMPLE_HALF, 7}};
    expect(grey, 1, 7, 7, 7);
}

static void a_file_without_colours_is_refused(void **state)
{
    (void)state;
    const box2 window = {0, 0, 7, 3};
    const channel_spec wrong[] = {{"R", SAMPLE_UINT, 1}, {"G", SAMPLE_HALF, 2}, {"B", SAMPLE_HALF, 2}};
    environment env;
    error e;
    write_map(window, window, wrong, 3);
    assert_false(load(&env, NULL, &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_string_equal(e.file, temporary());
    assert_non_null(strstr(e.message, "R, G and B"));
    environment_free(&env); // allowed after a failure
}

// A renderer that cropped the black border: the display window is the sphere.
static void a_cropped_map_is_completed(void **state)
{
    (void)state;
    const box2 display = {0, 0, 15, 7}, data = {4, 2, 7, 4}, inner = {4, 2, 11, 5};
    const channel_spec grey[] = {{"Y", SAMPLE_FLOAT, 1}};
    environment env;
    error e;
    write_map(data, display, grey, 1);
    assert_true(load(&env, NULL, &e));
    assert_int_equal(env.levels[0].width, 16);
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 16; x++) {
            bool in = x >= 4 && x <= 7 && y >= 2 && y <= 4;
            assert_near(env.levels[0].rgba[4 * (16 * y + x)], in ? 1 + 4 * (y - 2) + (x - 4) : 0, 0);
        }
    environment_free(&env);
    // A data window that is itself 2:1 is the sphere, as OpenEXR has it.
    write_map(inner, display, grey, 1);
    assert_true(load(&env, NULL, &e));
    assert_int_equal(env.levels[0].width, 8);
    assert_near(env.levels[0].rgba[0], 1, 0);
    environment_free(&env);
}

static void an_odd_shape_is_warned_about(void **state)
{
    (void)state;
    const box2 window = {0, 0, 7, 7};
    const channel_spec grey[] = {{"Y", SAMPLE_FLOAT, 1}};
    environment env;
    error e;
    log_t log;
    log_init(&log, LOG_QUIET);
    write_map(window, window, grey, 1);
    assert_true(load(&env, &log, &e));
    assert_int_equal(log.warning_count, 1);
    assert_non_null(strstr(log.warnings[0], "8 x 8"));
    environment_free(&env);
    log_free(&log);
}

// Radiance HDR goes through the OpenImageIO module, which the build leaves in build/.
static void other_formats_go_through_the_module(void **state)
{
    (void)state;
    use_built_modules();
    char module[512];
    snprintf(module, sizeof module, "%s/ssdo-images.so", getenv("SSDO_PLUGIN_DIR"));
    if (access(module, R_OK) != 0) skip();
    char path[64];
    snprintf(path, sizeof path, "/tmp/ssdo-test-light-%ld.hdr", (long)getpid());
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fprintf(f, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n");
    for (int i = 0; i < 8; i++) fwrite(i == 1 ? "\x80\x80\x80\x85" : "\x80\x40\x20\x81", 1, 4, f); // 16, or 1 1/2 1/4
    fclose(f);
    environment env;
    error e = {0};
    env_options options = {.path = path, .up_z = true, .scale = 1, .threads = 1};
    if (!environment_load(&options, &env, NULL, &e)) fail_msg("%s", e.message);
    unlink(path);
    assert_int_equal(env.levels[0].width, 4);
    assert_int_equal(env.levels[0].height, 2);
    assert_near(env.levels[0].rgba[4], 16, 0.1); // linear, and the top row comes first
    assert_near(env.levels[0].rgba[0], 1, 0.01);
    assert_near(env.levels[0].rgba[1], 0.5, 0.01);
    assert_near(env.levels[0].rgba[2], 0.25, 0.01);
    environment_free(&env);
}

static void refuse(const char *path)
{
    environment env;
    error e = {0};
    env_options options = {.path = path, .up_z = true, .scale = 1, .threads = 1};
    assert_false(environment_load(&options, &env, NULL, &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_string_equal(e.file, path);
    assert_true(e.message[0] != '\0');
    environment_free(&env);
}

static void what_is_no_map_is_refused(void **state)
{
    (void)state;
    refuse("/nonexistent/sky.exr");
    refuse("/tmp");
    FILE *f = fopen(temporary(), "wb"); // the magic number and nothing else
    assert_non_null(f);
    fwrite("\x76\x2f\x31\x01\x02", 1, 5, f);
    fclose(f);
    refuse(temporary());
    f = fopen(temporary(), "wb");
    assert_non_null(f);
    fclose(f);
    refuse(temporary());
    unlink(temporary());
}

// A map in another colour space is converted by OpenColorIO; here the space's curve is a square.
static void another_colour_space_is_converted(void **state)
{
    (void)state;
    use_built_modules();
    static const char config[] = "ocio_profile_version: 1\n"
                                 "roles:\n"
                                 "  default: lin\n"
                                 "  scene_linear: lin\n"
                                 "colorspaces:\n"
                                 "  - !<ColorSpace>\n"
                                 "    name: lin\n"
                                 "  - !<ColorSpace>\n"
                                 "    name: squared\n"
                                 "    to_reference: !<ExponentTransform> {value: [2, 2, 2, 1]}\n";
    char path[80];
    snprintf(path, sizeof path, "/tmp/ssdo-test-light-%ld.ocio", (long)getpid());
    FILE *to = fopen(path, "w");
    assert_non_null(to);
    fputs(config, to);
    fclose(to);
    error e = {0};
    float rgb[6] = {0.5f, 0.25f, 1.0f, 0.1f, 0.0f, 2.0f};
    if (!colour_to_scene_linear(path, "squared", rgb, 2, &e)) fail_msg("%s", e.message);
    static const double expected[6] = {0.25, 0.0625, 1.0, 0.01, 0.0, 4.0};
    for (int i = 0; i < 6; i++) assert_true(fabs((double)rgb[i] - expected[i]) < 1e-3 * (1.0 + expected[i]));
    assert_false(colour_to_scene_linear(path, "cubed", rgb, 2, &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_non_null(strstr(e.message, "squared")); // the spaces there are
    remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(channels_are_found),
        cmocka_unit_test(a_file_without_colours_is_refused),
        cmocka_unit_test(a_cropped_map_is_completed),
        cmocka_unit_test(an_odd_shape_is_warned_about),
        cmocka_unit_test(other_formats_go_through_the_module),
        cmocka_unit_test(what_is_no_map_is_refused),
        cmocka_unit_test(another_colour_space_is_converted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
