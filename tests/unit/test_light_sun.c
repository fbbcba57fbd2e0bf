// Taking the suns out of an environment.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "../lib/near.h"
#include "light/sun.h"

enum { W = 128, H = 64 };

static environment prepare(const float *rgb)
{
    environment env;
    error e = {0};
    log_t log;
    log_init(&log, LOG_QUIET);
    if (!environment_prepare(rgb, W, H, &(env_options){.path = "test", .up_z = true, .scale = 1.0, .threads = 1}, &env, &log, &e))
        fail_msg("%s", e.message);
    log_free(&log);
    return env;
}

static sun_set split(const environment *env, environment *rest)
{
    sun_set suns;
    error e = {0};
    log_t log;
    log_init(&log, LOG_QUIET);
    if (!sun_split(env, 1, &suns, rest, &log, &e)) fail_msg("%s", e.message);
    log_free(&log);
    return suns;
}

static void fill(float *rgb, float value)
{
    for (int i = 0; i < 3 * W * H; i++) rgb[i] = value;
}

static void put(float *rgb, int x, int y, float r, float g, float b)
{
    float *p = rgb + 3 * (y * W + x);
    p[0] = r, p[1] = g, p[2] = b;
}

static vec3 direction(double x, double y)
{
    double phi = (0.5 - x / W) * 2.0 * M_PI, theta = y / H * M_PI;
    return v3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

// Two suns, one across the map's seam: found, placed, brightest first, and no light is lost or made.
static void the_split_sums_to_the_map(void **state)
{
    (void)state;
    static float rgb[3 * W * H];
    fill(rgb, 0.5f);
    for (int x = -1; x < 1; x++)
        for (int y = 20; y < 22; y++) put(rgb, (x + W) % W, y, 9000, 8000, 5000);
    put(rgb, 40, 30, 500, 2000, 4000);
    environment env = prepare(rgb), rest;
    sun_set suns = split(&env, &rest);
    assert_int_equal(suns.count, 2);
    assert_true(v3_dot(suns.suns[0].direction, direction(0, 21)) > 0.99999);
    assert_true(v3_dot(suns.suns[1].direction, direction(40.5, 30.5)) > 0.99999);
    for (int c = 0; c < 3; c++) {
        double sum = rest.mean[c] * 4.0 * M_PI + suns.suns[0].flux[c] + suns.suns[1].flux[c];
        assert_near(sum / (env.mean[c] * 4.0 * M_PI), 1.0, 1e-5);
    }
    assert_true(rest.mean[0] < 1.5); // most of it was in the suns
    environment_free(&rest);
    environment_free(&env);
}

static void overcast_skies_and_large_windows_stay_whole(void **state)
{
    (void)state;
    static float rgb[3 * W * H];
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) put(rgb, x, y, 1.0f + (float)(H - y), 2.0f, 3.0f);
    environment env = prepare(rgb), rest;
    assert_int_equal(split(&env, &rest).count, 0);
    assert_int_equal(rest.level_count, 0);
    environment_free(&env);
    fill(rgb, 0.01f);
    for (int y = 28; y < 34; y++)
        for (int x = 10; x < 16; x++) put(rgb, x, y, 50, 50, 50);
    env = prepare(rgb);
    assert_int_equal(split(&env, &rest).count, 0);
    environment_free(&env);
}

// More candidates than there is room for: the brightest are kept, and the rest stays in the map.
static void the_brightest_are_kept(void **state)
{
    (void)state;
    static float rgb[3 * W * H];
    fill(rgb, 0.1f);
    for (int i = 0; i < 7; i++) put(rgb, 10 + 12 * i, 32, (float)(1000 * (1 + i)), 0, 0);
    environment env = prepare(rgb), rest;
    sun_set suns = split(&env, &rest);
    assert_int_equal(suns.count, SUNS_MAX);
    double sum = rest.mean[0] * 4.0 * M_PI;
    for (int i = 0; i < suns.count; i++) {
        assert_true(v3_dot(suns.suns[i].direction, direction(10.5 + 12 * (6 - i), 32.5)) > 0.99999);
        sum += suns.suns[i].flux[0];
    }
    assert_near(sum / (env.mean[0] * 4.0 * M_PI), 1.0, 1e-5);
    environment_free(&rest);
    environment_free(&env);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_split_sums_to_the_map),
        cmocka_unit_test(overcast_skies_and_large_windows_stay_whole),
        cmocka_unit_test(the_brightest_are_kept),
    };
    return cmocka_run_group_tests_name("suns", tests, NULL, NULL);
}
