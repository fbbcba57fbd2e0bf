// The environment's map: values, orientation, solid angles, mips and lookup.
#include <stdlib.h>
#include <string.h>

#include "test_light.h"

static float *new_map(int width, int height)
{
    float *rgb = calloc((size_t)(width * height) * 3, sizeof *rgb);
    assert_non_null(rgb);
    return rgb;
}

static void solid_angles_sum_to_the_sphere(void **state)
{
    (void)state;
    const int sizes[][2] = {{1, 1}, {2, 1}, {7, 3}, {64, 32}, {4096, 2048}};
    for (size_t s = 0; s < 5; s++) {
        double sum = 0;
        for (int j = 0; j < sizes[s][1]; j++) sum += sizes[s][0] * env_texel_solid_angle(sizes[s][0], sizes[s][1], j);
        assert_near(sum, 4 * M_PI, 1e-11);
    }
    // One texel by the header's formula, in a row where cos differs plainly.
    assert_near(env_texel_solid_angle(16, 8, 2), 2 * M_PI / 16 * (cos(M_PI * 2 / 8) - cos(M_PI * 3 / 8)), 1e-15);
}

static void white_without_a_map(void **state)
{
    (void)state;
    environment env;
    error e = {0};
    env_options options = {.up_z = true, .scale = 1, .threads = 1};
    assert_true(environment_load(&options, &env, NULL, &e));
    assert_true(env.white);
    assert_int_equal(env.level_count, 1);
    vec3 n = v3_normalize(v3(0.3, -0.5, 0.2));
    assert_near(environment_lookup(&env, n, 0).x, 1, 1e-12);
    assert_near(environment_irradiance_over_pi(&env, n).y, 1, 1e-5);
    for (int c = 0; c < 3; c++) assert_near(env.mean[c], 1, 1e-12);
    environment_free(&env);
}

static double integral(const env_level *l, int channel)
{
    double sum = 0;
    for (int j = 0; j < l->height; j++)
        for (int i = 0; i < l->width; i++)
            sum += env_texel_solid_angle(l->width, l->height, j) * (double)l->rgba[4 * (j * l->width + i) + channel];
    return sum;
}

// Every level holds the same light, for even, odd and prime sizes, with values over six decades.
static void mips_keep_the_light(void **state)
{
    (void)state;
    const int sizes[][2] = {{128, 64}, {101, 53}, {3, 2}, {63, 31}, {1, 7}, {9, 1}};
    uint64_t seed = 5;
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        int w = sizes[s][0], h = sizes[s][1];
        float *rgb = new_map(w, h);
        for (int i = 0; i < 3 * w * h; i++) rgb[i] = (float)pow(10, 6 * noise(&seed) - 3);
        environment env = prepare(rgb, w, h, true, 0);
        const env_level *last = &env.levels[env.level_count - 1];
        assert_int_equal(last->width, 1);
        assert_int_equal(last->height, 1);
        for (int c = 0; c < 3; c++) {
            double whole = integral(&env.levels[0], c);
            assert_near(env.mean[c], whole / (4 * M_PI), 1e-9 * env.mean[c]);
            for (int k = 1; k < env.level_count; k++) {
                int expected = env.levels[k - 1].width / 2;
                assert_int_equal(env.levels[k].width, expected ? expected : 1);
                assert_near(integral(&env.levels[k], c) / whole, 1, 1e-6);
            }
        }
        environment_free(&env);
        free(rgb);
    }
}

// A texel of a level is the mean over exactly what it covers: 3 columns into 1, and 5 rows into 2 sharing the middle one.
static void mips_of_odd_sizes_share_texels(void **state)
{
    (void)state;
    float *rgb = new_map(2, 5);
    for (int i = 0; i < 2; i++) rgb[3 * (2 * 2 + i)] = 1; // the middle row
    environment env = prepare(rgb, 2, 5, true, 0);
    assert_int_equal(env.levels[1].width, 1);
    assert_int_equal(env.levels[1].height, 2);
    double share = cos(2 * M_PI / 5); // the half row below the pole's two, over the hemisphere's 1
    assert_near((double)env.levels[1].rgba[0], share, 1e-7);
    assert_near((double)env.levels[1].rgba[4], share, 1e-7);
    environment_free(&env);
    free(rgb);
}

// One hot texel, and the world direction in which it must be seen.
static void expect_hot(int x, int y, bool up_z, double rotate, vec3 world)
{
    float *rgb = new_map(64, 32);
    rgb[3 * (y * 64 + x)] = 100;
    environment env = prepare(rgb, 64, 32, up_z, rotate);
    vec3 seen = environment_lookup(&env, m3_apply(env.map_from_world, v3_normalize(world)), 0);
    vec3 opposite = environment_lookup(&env, m3_apply(env.map_from_world, v3_scale(v3_normalize(world), -1)), 0);
    assert_near(m3_det(env.map_from_world), 1, 1e-12);
    assert_near(seen.x, 100, 1e-6);
    assert_near(opposite.x, 0, 1e-6);
    environment_free(&env);
    free(rgb);
}

// World direction of texel centre (x, y) of a 64 x 32 map by Blender 3.4's equirectangular mapping, u = 0.5 - atan2(y, x) / 2pi
// and v = 0.5 + atan2(z, hypot(x, y)) / pi from the bottom, turned about z afterwards.
static vec3 blender_direction(int x, int y, double turn_degrees)
{
    double longitude = 2 * M_PI * (0.5 - (x + 0.5) / 64) + turn_degrees * M_PI / 180;
    double latitude = M_PI * ((1 - (y + 0.5) / 32) - 0.5);
    return v3(cos(latitude) * cos(longitude), cos(latitude) * sin(longitude), sin(latitude));
}

// The same by ImfEnvmap.h: longitude +pi at the left and -pi at the right, 0 towards +z and pi / 2 towards +x; latitude towards
// y.
static vec3 openexr_direction(int x, int y, double turn_degrees)
{
    double longitude = M_PI - 2 * M_PI * (x + 0.5) / 64 + turn_degrees * M_PI / 180;
    double latitude = M_PI / 2 - M_PI * (y + 0.5) / 32;
    return v3(cos(latitude) * sin(longitude), sin(latitude), cos(latitude) * cos(longitude));
}

static void hot_texels_are_where_they_belong(void **state)
{
    (void)state;
    const int texels[][2] = {{0, 3}, {16, 16}, {31, 8}, {40, 20}, {63, 28}};
    const double turns[] = {0, 90, -30, 200};
    for (size_t t = 0; t < 5; t++)
        for (size_t r = 0; r < 4; r++) {
            int x = texels[t][0], y = texels[t][1];
            expect_hot(x, y, true, turns[r], blender_direction(x, y, turns[r]));
            expect_hot(x, y, false, turns[r], openexr_direction(x, y, turns[r]));
        }
}

// The four compass points in words, against a slip that both formulas above could share. Columns 16 and 48 have their centres
// half a texel right of a quarter and three quarters of the map.
static void compass(void **state)
{
    (void)state;
    float *rgb = new_map(64, 32);
    for (int y = 14; y < 18; y++)
        for (int x = 12; x < 20; x++) rgb[3 * (y * 64 + x)] = 1; // a patch about u = 1/4 on the horizon
    environment z = prepare(rgb, 64, 32, true, 0), y = prepare(rgb, 64, 32, false, 0), turned = prepare(rgb, 64, 32, true, 90);
    assert_near(environment_lookup(&z, m3_apply(z.map_from_world, v3(0, 1, 0)), 0).x, 1, 1e-12);            // Blender: +y
    assert_near(environment_lookup(&y, m3_apply(y.map_from_world, v3(1, 0, 0)), 0).x, 1, 1e-12);            // OpenEXR: +x
    assert_near(environment_lookup(&turned, m3_apply(turned.map_from_world, v3(-1, 0, 0)), 0).x, 1, 1e-12); // +y to -x
    assert_near(environment_lookup(&turned, m3_apply(turned.map_from_world, v3(0, 1, 0)), 0).x, 0, 1e-12);
    environment_free(&z);
    environment_free(&y);
    environment_free(&turned);
    free(rgb);
}

static void broken_values_are_repaired_and_counted(void **state)
{
    (void)state;
    float *rgb = new_map(4, 2);
    for (int i = 0; i < 24; i++) rgb[i] = 0.5f;
    rgb[0] = NAN;
    rgb[1] = -1; // the same texel: counted once
    rgb[3] = INFINITY;
    rgb[6] = -INFINITY;
    rgb[9] = 7;
    log_t log;
    log_init(&log, LOG_QUIET);
    environment env;
    error e = {0};
    env_options options = {.up_z = true, .scale = 2, .threads = 1};
    assert_true(environment_prepare(rgb, 4, 2, &options, &env, &log, &e));
    const float *t = env.levels[0].rgba;
    assert_float_equal(t[0], 0, 0);
    assert_float_equal(t[1], 0, 0);
    assert_float_equal(t[2], 1, 0);
    assert_float_equal(t[4], 14, 0); // the largest finite value, then the scale
    assert_float_equal(t[8], 0, 0);
    assert_float_equal(t[12], 14, 0);
    assert_int_equal(env.repaired, 3);
    assert_int_equal(log.warning_count, 1);
    assert_non_null(strstr(log.warnings[0], "3 of 8"));
    environment_free(&env);
    log_free(&log);
    free(rgb);
}

static void huge_values_stay_finite_everywhere(void **state)
{
    (void)state;
    float *rgb = new_map(8, 4);
    for (int i = 0; i < 96; i++) rgb[i] = 3e38f;
    environment env = prepare(rgb, 8, 4, true, 0);
    for (int k = 0; k < env.level_count; k++)
        for (int i = 0; i < env.levels[k].width * env.levels[k].height; i++) assert_true(env.levels[k].rgba[4 * i] <= 1.0001e30f);
    assert_true(isfinite(env.sh[0][0]));
    environment_free(&env);
    free(rgb);
}

static void lookup_interpolates_and_wraps(void **state)
{
    (void)state;
    float *rgb = new_map(8, 4);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 8; i++) rgb[3 * (8 * j + i)] = (float)(i + 10 * j);
    environment env = prepare(rgb, 8, 4, true, 0);
    double theta = M_PI * 1.5 / 4; // centre of row 1
    double seam = environment_lookup(&env, v3(-sin(theta), 0, cos(theta)), 0).x;
    assert_near(seam, 10 + 3.5, 1e-6);        // u = 0 or 1: half of column 7, half of column 0
    double phi = 2 * M_PI * (0.5 - 3.25 / 8); // centres are at i + 0.5: column 2.75
    double between = environment_lookup(&env, v3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)), 0).x;
    assert_near(between, 10 + 2.75, 1e-6);
    assert_near(environment_lookup(&env, v3(0, 0, 1), 0).x, 3.5, 1e-6); // the pole: row 0, not row -1; u = 0.5
    vec3 d = v3_normalize(v3(0.2, 0.9, 0.3));
    double sharp = environment_lookup(&env, d, 1).x, soft = environment_lookup(&env, d, 2).x;
    assert_near(environment_lookup(&env, d, 1.25).x, 0.75 * sharp + 0.25 * soft, 1e-9);
    assert_true(fabs(sharp - soft) > 0.1);
    assert_near(environment_lookup(&env, v3(0, 1, 0), 99).x, env.mean[0], 1e-5);
    environment_free(&env);
    free(rgb);
}

// The same bits for every number of threads.
static void threads_do_not_matter(void **state)
{
    (void)state;
    uint64_t seed = 9;
    float *rgb = new_map(90, 45);
    for (int i = 0; i < 3 * 90 * 45; i++) rgb[i] = (float)noise(&seed);
    environment a, b;
    error e = {0};
    env_options one = {.up_z = true, .scale = 1, .threads = 1}, four = {.up_z = true, .scale = 1, .threads = 4};
    assert_true(environment_prepare(rgb, 90, 45, &one, &a, NULL, &e));
    assert_true(environment_prepare(rgb, 90, 45, &four, &b, NULL, &e));
    assert_memory_equal(a.sh, b.sh, sizeof a.sh);
    for (int k = 0; k < a.level_count; k++)
        assert_memory_equal(a.levels[k].rgba, b.levels[k].rgba, (size_t)(a.levels[k].width * a.levels[k].height) * 16);
    environment_free(&a);
    environment_free(&b);
    free(rgb);
}

static void refuse(int width, int height, const char *says)
{
    float rgb[3 * 6] = {0};
    environment env;
    error e = {0};
    env_options options = {.path = "map.exr", .up_z = true, .scale = 1, .threads = 1};
    assert_false(environment_prepare(rgb, width, height, &options, &env, NULL, &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_non_null(strstr(e.message, says));
    assert_string_equal(e.file, "map.exr");
    environment_free(&env);
}

static void shapes_that_cannot_be_are_refused(void **state)
{
    (void)state;
    refuse(0, 4, "texels");
    refuse(40000, 20000, "32768");
    refuse(1, 6, "cube map");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solid_angles_sum_to_the_sphere),
        cmocka_unit_test(white_without_a_map),
        cmocka_unit_test(mips_keep_the_light),
        cmocka_unit_test(mips_of_odd_sizes_share_texels),
        cmocka_unit_test(hot_texels_are_where_they_belong),
        cmocka_unit_test(compass),
        cmocka_unit_test(broken_values_are_repaired_and_counted),
        cmocka_unit_test(huge_values_stay_finite_everywhere),
        cmocka_unit_test(lookup_interpolates_and_wraps),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(shapes_that_cannot_be_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
