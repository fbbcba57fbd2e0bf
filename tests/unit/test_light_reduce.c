// Maps that are made smaller while they are read: the light stays.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/mem.h"
#include "light/environment.h"
#include "light/reduce.h"
#include "must.h"
#include "near.h"

enum { W = 8201, H = 4099 }; // no multiple of anything

static float value(int x, int y, int c)
{
    if (c == 0) return 1.0f;
    if (c == 1) return 2.0f + cosf(2.0f * (float)M_PI * ((float)x + 0.5f) / W);
    return x == 5000 && y == 900 ? 1e6f : (float)y / H; // a sun of one texel over a slope
}

static double light_of(int width, int height, const float *rgb, int c)
{
    double sum = 0.0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            sum += (double)rgb[3 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)c] * env_texel_solid_angle(width, height, y);
    return sum;
}

static void light_stays(void **state)
{
    (void)state;
    reduced_map m;
    error e = {0};
    float *row = test_malloc(3 * W * sizeof *row);
    double wanted[3] = {0};
    must(reduce_begin(&m, W, H, 0.0, "test", &e), &e);
    assert_true(m.width == (W + 1) / 2 && m.height == (H + 1) / 2);
    for (int y = 0; y < H; y++) {
        for (int x = 0; x < W; x++)
            for (int c = 0; c < 3; c++) {
                row[3 * x + c] = value(x, y, c);
                wanted[c] += (double)row[3 * x + c] * env_texel_solid_angle(W, H, y);
            }
        reduce_row(&m, y, row);
    }
    reduce_end(&m);
    for (int c = 0; c < 3; c++) assert_near(light_of(m.width, m.height, m.rgb, c) / wanted[c], 1.0, 2e-5);
    for (size_t i = 0; i < (size_t)m.width * (size_t)m.height; i++) assert_near((double)m.rgb[3 * i], 1.0, 1e-5);
    // Nothing moves: the cosine has its top where it had it.
    size_t middle = 3 * (size_t)(m.height / 2) * (size_t)m.width;
    for (int x = 0; x < m.width; x++)
        assert_near((double)m.rgb[middle + 3 * (size_t)x + 1], 2.0 + cos(2.0 * M_PI * (x + 0.5) / m.width), 1e-5);
    reduce_free(&m);
    test_free(row);
}

static void small_maps_stay(void **state)
{
    (void)state;
    const float rgb[12] = {1, 2, 3, NAN, -5, 6, INFINITY, 8, 9, 10, 11, 12};
    reduced_map m;
    error e = {0};
    must(reduce_begin(&m, 2, 2, 0.0, "test", &e), &e);
    for (int y = 0; y < 2; y++) reduce_row(&m, y, rgb + 6 * y);
    reduce_end(&m);
    assert_memory_equal(m.rgb, rgb, sizeof rgb);
    reduce_free(&m);
}

static void what_does_not_fit_is_refused(void **state)
{
    (void)state;
    reduced_map m;
    error e = {0};
    assert_false(reduce_begin(&m, 16384, 16384, 1e9, "big.exr", &e));
    assert_int_equal(e.code, ERR_MEMORY);
    assert_string_equal(e.file, "big.exr");
    e = (error){0};
    assert_false(reduce_begin(&m, ENV_MAX_SIZE + 1, 2, 0.0, "long.exr", &e));
    assert_int_equal(e.code, ERR_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(light_stays), cmocka_unit_test(small_maps_stay),
                                       cmocka_unit_test(what_does_not_fit_is_refused)};
    return cmocka_run_group_tests_name("reduce", tests, NULL, NULL);
}
