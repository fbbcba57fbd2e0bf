// The OpenImageIO module: PNG out, other image formats in, and a clear remedy when it is missing.

#include "exrio_support.h"
#include "modules.h"
#include "plugin/images.h"

static int set_up(void **state)
{
    use_built_modules();
    return make_scratch(state);
}

static bool have_module(void)
{
    char path[4300];
    snprintf(path, sizeof path, "%s/ssdo-images.so", getenv("SSDO_PLUGIN_DIR"));
    if (access(path, R_OK) == 0) return true;
    print_message("note: %s is not built, so this is not checked\n", path);
    return false;
}

// A whole picture of floats.
typedef struct picture {
    int width, height, channels;
    float *pixels;
} picture;

static int take_rows(void *context, int width, int height, int channels, int y, int rows, const float *pixels)
{
    picture *p = context;
    size_t row = (size_t)width * (size_t)channels;
    if (rows == 0)
        *p = (picture){width, height, channels, malloc(row * (size_t)height * sizeof(float))};
    else
        memcpy(p->pixels + (size_t)y * row, pixels, (size_t)rows * row * sizeof(float));
    return 1;
}

static void test_png_there_and_back(void **state)
{
    (void)state;
    if (!have_module()) return;
    enum { W = 5, H = 3 };
    uint8_t rgb[W * H * 3];
    for (int i = 0; i < W * H * 3; i++) rgb[i] = (uint8_t)(i * 5 + 1);
    error e = {0};
    for (int twice = 0; twice < 2; twice++)
        assert_ok(images_write_png(in_scratch("a.png"), W, H, rgb, "Software", "test", &e), e); // replaces
    picture p = {0};
    assert_ok(images_read_rows(in_scratch("a.png"), 0, take_rows, &p, &e), e);
    assert_true(p.width == W && p.height == H && p.channels == 3);
    for (int i = 0; i < W * H * 3; i++) assert_int_equal((int)(p.pixels[i] * 255.0f + 0.5f), rgb[i]);
    free(p.pixels);
    // Nothing but the file is left.
    assert_int_equal(run_command("test \"$(ls -A '%s')\" = a.png", scratch_folder), 0);
}

static void test_failures(void **state)
{
    (void)state;
    if (!have_module()) return;
    const uint8_t rgb[3] = {1, 2, 3};
    error e = {0};
    assert_false(images_write_png(in_scratch("none/a.png"), 1, 1, rgb, "Software", "test", &e));
    assert_int_equal(e.code, ERR_OUTPUT);
    assert_non_null(strstr(e.message, in_scratch("none")));
    picture p = {0};
    e = (error){0};
    spill(in_scratch("text.png"), "This is not a picture.", 22);
    assert_false(images_read_rows(in_scratch("text.png"), 0, take_rows, &p, &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_null(p.pixels);
    e = (error){0};
    assert_false(images_read_rows(in_scratch("missing.png"), 0, take_rows, &p, &e));
    assert_int_equal(e.code, ERR_INPUT);
}

static void test_without_the_module(void **state)
{
    (void)state;
#ifdef SSDO_LIBDIR
    if (access(SSDO_LIBDIR "/ssdo-images.so", R_OK) == 0) return; // an installed one would be found
#endif
    char *folder = strdup(getenv("SSDO_PLUGIN_DIR"));
    setenv("SSDO_PLUGIN_DIR", "/nowhere", 1);
    const uint8_t rgb[3] = {1, 2, 3};
    error in = {0}, out = {0};
    picture p = {0};
    assert_false(images_write_png(in_scratch("b.png"), 1, 1, rgb, "Software", "test", &out));
    assert_false(images_read_rows(in_scratch("b.png"), 0, take_rows, &p, &in));
    setenv("SSDO_PLUGIN_DIR", folder, 1);
    free(folder);
    assert_int_equal(out.code, ERR_OUTPUT);
    assert_int_equal(in.code, ERR_INPUT);
    assert_non_null(strstr(out.message, "SSDO_PLUGIN_DIR"));
    assert_non_null(strstr(in.message, "/nowhere"));
    assert_int_not_equal(access(in_scratch("b.png"), F_OK), 0);
}

static void test_broken_module(void **state)
{
    (void)state;
    char *folder = strdup(getenv("SSDO_PLUGIN_DIR"));
    spill(in_scratch("ssdo-images.so"), "not a library", 13);
    setenv("SSDO_PLUGIN_DIR", scratch_folder, 1);
    const uint8_t rgb[3] = {1, 2, 3};
    error e = {0};
    bool ok = images_write_png(in_scratch("b.png"), 1, 1, rgb, "Software", "test", &e);
    setenv("SSDO_PLUGIN_DIR", folder, 1);
    free(folder);
    unlink(in_scratch("ssdo-images.so"));
    if (ok) return; // another module was found after it
    assert_int_equal(e.code, ERR_OUTPUT);
    assert_non_null(strstr(e.message, "cannot be loaded"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_png_there_and_back),
        cmocka_unit_test(test_failures),
        cmocka_unit_test(test_without_the_module),
        cmocka_unit_test(test_broken_module),
    };
    return cmocka_run_group_tests(tests, set_up, remove_scratch);
}
