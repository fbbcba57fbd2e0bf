// Spherical harmonics against quadrature and against the brute-force irradiance.
#include <stdlib.h>
#include <unistd.h>

#include "light/sh.h"
#include "test_light.h"

static vec3 direction_at(double u, double v)
{
    double theta = M_PI * v, phi = 2 * M_PI * (0.5 - u);
    return v3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

// The constants printed in the paper, and for l = 3, which it has not, those of its sign convention.
static void basis_is_the_papers(void **state)
{
    (void)state;
    double y[SH_MAX];
    vec3 d = v3(0.36, 0.48, 0.8);
    sh_basis(d, 4, y);
    const double paper[SH_MAX] = {0.282095,
                                  0.488603 * d.y,
                                  0.488603 * d.z,
                                  0.488603 * d.x,
                                  1.092548 * d.x * d.y,
                                  1.092548 * d.y * d.z,
                                  0.315392 * (3 * d.z * d.z - 1),
                                  1.092548 * d.x * d.z,
                                  0.546274 * (d.x * d.x - d.y * d.y),
                                  0.590044 * d.y * (3 * d.x * d.x - d.y * d.y),
                                  2.890611 * d.x * d.y * d.z,
                                  0.457046 * d.y * (5 * d.z * d.z - 1),
                                  0.373176 * d.z * (5 * d.z * d.z - 3),
                                  0.457046 * d.x * (5 * d.z * d.z - 1),
                                  1.445306 * d.z * (d.x * d.x - d.y * d.y),
                                  0.590044 * d.x * (d.x * d.x - 3 * d.y * d.y)};
    for (int i = 0; i < SH_MAX; i++) assert_near(y[i], paper[i], 1e-6);
}

static void basis_is_orthonormal(void **state)
{
    (void)state;
    double gram[SH_MAX][SH_MAX] = {{0}};
    enum { W = 128, H = 64 };
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            double y[SH_MAX];
            sh_basis(direction_at((i + 0.5) / W, (j + 0.5) / H), 4, y);
            for (int a = 0; a < SH_MAX; a++)
                for (int b = 0; b < SH_MAX; b++) gram[a][b] += env_texel_solid_angle(W, H, j) * y[a] * y[b];
        }
    for (int a = 0; a < SH_MAX; a++)
        for (int b = 0; b < SH_MAX; b++) assert_near(gram[a][b], a == b, 2e-3);
}

// Projection of single texels against a fine sum of the basis over the texel, for every coefficient, in small and large maps.
static void projection_integrates_the_basis(void **state)
{
    (void)state;
    const int cases[][4] = {{1, 1, 0, 0}, {2, 1, 1, 0}, {3, 2, 1, 1}, {8, 4, 6, 0}, {80, 40, 13, 31}};
    for (size_t t = 0; t < 5; t++) {
        int w = cases[t][0], h = cases[t][1], x = cases[t][2], y = cases[t][3];
        float *rgba = calloc((size_t)(w * h) * 4, sizeof *rgba);
        assert_non_null(rgba);
        rgba[4 * (y * w + x) + 1] = 2;
        double sh[SH_MAX][3], sum[SH_MAX] = {0};
        error e = {0};
        assert_true(sh_project(rgba, w, h, 1, sh, &e));
        enum { N = 400 };
        for (int j = 0; j < N; j++)
            for (int i = 0; i < N; i++) {
                double b[SH_MAX];
                sh_basis(direction_at((x + (i + 0.5) / N) / w, (y + (j + 0.5) / N) / h), 4, b);
                for (int k = 0; k < SH_MAX; k++) sum[k] += 2 * env_texel_solid_angle(w * N, h * N, y * N + j) * b[k];
            }
        for (int k = 0; k < SH_MAX; k++) {
            assert_near(sh[k][1], sum[k], 1e-4);
            assert_near(sh[k][0], 0, 0);
        }
        free(rgba);
    }
}

static void constant_maps_give_a_constant(void **state)
{
    (void)state;
    const int sizes[][2] = {{1, 1}, {2, 1}, {4, 2}, {5, 3}, {64, 32}};
    uint64_t seed = 3;
    for (size_t s = 0; s < 5; s++) {
        int w = sizes[s][0], h = sizes[s][1];
        float *rgb = malloc((size_t)(w * h) * 3 * sizeof *rgb);
        assert_non_null(rgb);
        for (int i = 0; i < 3 * w * h; i++) rgb[i] = 1;
        environment env = prepare(rgb, w, h, true, 0);
        for (int k = 1; k < SH_MAX; k++) assert_near(env.sh[k][2], 0, 1e-12);
        for (int t = 0; t < 6; t++) {
            vec3 n = t ? random_direction(&seed) : v3(0, 0, 1);
            assert_near(sh_irradiance_over_pi((const double(*)[3])env.sh, n).z, 1, 1e-12);
            assert_near(environment_irradiance_over_pi(&env, n).z, 1, 1e-5);
        }
        environment_free(&env);
        free(rgb);
    }
}

// A map that holds only l <= 2: nine coefficients tell its irradiance.
static void band_limited_maps_agree(void **state)
{
    (void)state;
    enum { W = 256, H = 128 };
    uint64_t seed = 11;
    float *rgb = malloc(W * H * 3 * sizeof *rgb);
    assert_non_null(rgb);
    double c[3][9];
    for (int k = 0; k < 27; k++) c[k / 9][k % 9] = k % 9 ? 0.4 * (2 * noise(&seed) - 1) : 9; // bright enough to stay positive
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            double y[SH_MAX];
            sh_basis(direction_at((i + 0.5) / W, (j + 0.5) / H), 3, y);
            for (int channel = 0; channel < 3; channel++) {
                double sum = 0;
                for (int k = 0; k < 9; k++) sum += c[channel][k] * y[k];
                assert_true(sum > 0);
                rgb[3 * (j * W + i) + channel] = (float)sum;
            }
        }
    environment env = prepare(rgb, W, H, true, 0);
    for (int k = 0; k < 9; k++) assert_near(env.sh[k][0], c[0][k], 1e-3);
    for (int t = 0; t < 12; t++) {
        vec3 n = random_direction(&seed);
        vec3 fast = sh_irradiance_over_pi((const double(*)[3])env.sh, n), slow = environment_irradiance_over_pi(&env, n);
        assert_near(fast.x, slow.x, 1e-4);
        assert_near(fast.y, slow.y, 1e-4);
        assert_near(fast.z, slow.z, 1e-4);
    }
    environment_free(&env);
    free(rgb);
}

// One small bright texel: the brute force is L max(0, n.w) dw / pi.
static void brute_force_is_lambert(void **state)
{
    (void)state;
    float *rgb = calloc(128 * 64 * 3, sizeof *rgb);
    assert_non_null(rgb);
    rgb[3 * (20 * 128 + 37)] = 1000;
    environment env = prepare(rgb, 128, 64, true, 0);
    vec3 w = direction_at(37.5 / 128, 20.5 / 64);
    uint64_t seed = 21;
    for (int t = 0; t < 10; t++) {
        vec3 n = random_direction(&seed);
        if (fabs(v3_dot(n, w)) < 0.05) continue;
        double expected = 1000 * env_texel_solid_angle(128, 64, 20) * fmax(0, v3_dot(n, w)) / M_PI;
        assert_near(environment_irradiance_over_pi(&env, n).x, expected, 1e-3 * expected + 1e-12);
    }
    environment_free(&env);
    free(rgb);
}

// The paper's bound: nine coefficients are within 9 % (of the largest irradiance) for real light.
static void sample_sky_is_within_nine_percent(void **state)
{
    (void)state;
    const char *paths[] = {"samples/sky_sun.exr", "samples/sky_soft.exr"};
    int seen = 0;
    for (int f = 0; f < 2; f++) {
        if (access(paths[f], R_OK) != 0) continue;
        seen++;
        environment env;
        error e = {0};
        env_options options = {.path = paths[f], .up_z = true, .scale = 1, .threads = 2};
        if (!environment_load(&options, &env, NULL, &e)) fail_msg("%s: %s", paths[f], e.message);
        uint64_t seed = 31;
        double most = 0, worst = 0;
        for (int t = 0; t < 40; t++) {
            vec3 n = random_direction(&seed);
            vec3 fast = sh_irradiance_over_pi((const double(*)[3])env.sh, n), slow = environment_irradiance_over_pi(&env, n);
            most = fmax(most, fmax(slow.x, fmax(slow.y, slow.z)));
            worst = fmax(worst, fmax(fabs(fast.x - slow.x), fmax(fabs(fast.y - slow.y), fabs(fast.z - slow.z))));
        }
        print_message("%s: worst error %.2f %% of the largest irradiance %.3f\n", paths[f], 100 * worst / most, most);
        assert_true(worst > 0 && worst < 0.09 * most);
        environment_free(&env);
    }
    if (!seen) skip();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(basis_is_the_papers),
        cmocka_unit_test(basis_is_orthonormal),
        cmocka_unit_test(projection_integrates_the_basis),
        cmocka_unit_test(constant_maps_give_a_constant),
        cmocka_unit_test(band_limited_maps_agree),
        cmocka_unit_test(brute_force_is_lambert),
        cmocka_unit_test(sample_sky_is_within_nine_percent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
