// The camera solvers' linear algebra, against matrices whose answers are known and against definitions.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/sort.h"
#include "gbuffer/solve.h"

static double uniform(uint64_t *state) { return (double)(solve_random(state) >> 11) * 0x1p-52 - 1.0; }

// A rotation of n dimensions: the product of plane rotations by random angles. Row i is the i-th axis.
static void random_axes(int n, uint64_t *state, double *axes)
{
    for (int i = 0; i < n * n; i++) axes[i] = i % (n + 1) == 0 ? 1.0 : 0.0;
    for (int p = 0; p < n; p++)
        for (int q = p + 1; q < n; q++) {
            double angle = 3.0 * uniform(state), c = cos(angle), s = sin(angle);
            for (int k = 0; k < n; k++) {
                double x = axes[p * n + k], y = axes[q * n + k];
                axes[p * n + k] = c * x - s * y, axes[q * n + k] = s * x + c * y;
            }
        }
}

// The symmetric matrix with these eigenvalues along these axes.
static void compose(int n, const double *values, const double *axes, double *a)
{
    for (int r = 0; r < n; r++)
        for (int c = 0; c < n; c++) {
            a[r * n + c] = 0.0;
            for (int k = 0; k < n; k++) a[r * n + c] += values[k] * axes[k * n + r] * axes[k * n + c];
        }
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0.0;
    for (int k = 0; k < n; k++) sum += a[k] * b[k];
    return sum;
}

static void eigenvectors_are_those_it_is_made_of(void **state)
{
    (void)state;
    uint64_t random = 7;
    for (int n = 1; n <= SOLVE_MAX; n++) {
        double axes[SOLVE_MAX * SOLVE_MAX], wanted[SOLVE_MAX], a[SOLVE_MAX * SOLVE_MAX], values[SOLVE_MAX],
            vectors[SOLVE_MAX * SOLVE_MAX];
        random_axes(n, &random, axes);
        for (int k = 0; k < n; k++) wanted[k] = (double)k - 2.5; // negative ones too, rising
        compose(n, wanted, axes, a);
        solve_eigen(n, a, values, vectors);
        for (int k = 0; k < n; k++) {
            assert_true(fabs(values[k] - wanted[k]) < 1e-12);
            assert_true(fabs(fabs(dot(n, vectors + k * n, axes + k * n)) - 1.0) < 1e-12); // the same line
            for (int i = 0; i < k; i++) assert_true(fabs(dot(n, vectors + k * n, vectors + i * n)) < 1e-12);
        }
    }
}

static void the_smallest_is_found_alone(void **state)
{
    (void)state;
    uint64_t random = 11;
    for (int n = 2; n <= SOLVE_MAX; n++)
        for (int nearly = 0; nearly < 2; nearly++) {
            double axes[SOLVE_MAX * SOLVE_MAX], values[SOLVE_MAX], a[SOLVE_MAX * SOLVE_MAX], vector[SOLVE_MAX];
            random_axes(n, &random, axes);
            for (int k = 0; k < n; k++) values[k] = 1.0 + 4.0 * k;
            values[0] = nearly ? 0.5 : 0.0; // a large residual, or none
            compose(n, values, axes, a);
            assert_true(solve_smallest(n, a, vector));
            assert_true(fabs(fabs(dot(n, vector, axes)) - 1.0) < 1e-9);
            assert_true(fabs(dot(n, vector, vector) - 1.0) < 1e-12);
        }
    double nothing[4] = {0}, bad[4] = {1.0, 0.0, 0.0, NAN}, endless[4] = {INFINITY, 0.0, 0.0, 1.0}, vector[2];
    assert_false(solve_smallest(2, nothing, vector) || solve_smallest(2, bad, vector) || solve_smallest(2, endless, vector));
}

static void systems_are_solved(void **state)
{
    (void)state;
    uint64_t random = 3;
    for (int n = 1; n <= SOLVE_MAX; n++)
        for (int trial = 0; trial < 20; trial++) {
            double a[SOLVE_MAX * SOLVE_MAX], x[SOLVE_MAX], b[SOLVE_MAX];
            for (int i = 0; i < n * n; i++) a[i] = uniform(&random);
            for (int i = 0; i < n && n > 1; i++) a[i * n + i] = 0.0; // no pivot stands where it would be used
            for (int i = 0; i < n; i++) x[i] = uniform(&random);
            for (int i = 0; i < n; i++) b[i] = dot(n, a + i * n, x);
            assert_true(solve_linear(n, a, b));
            for (int i = 0; i < n; i++) assert_true(fabs(b[i] - x[i]) < 1e-9);
        }
    double twice[4] = {1.0, 2.0, 2.0, 4.0}, bad[4] = {NAN, 1.0, 1.0, 1.0}, b[2] = {1.0, 1.0}, c[2] = {1.0, 1.0};
    assert_false(solve_linear(2, twice, b));
    assert_false(solve_linear(2, bad, c));
}

static void selection_is_that_of_sorting(void **state)
{
    (void)state;
    enum { MOST = 65 };
    uint64_t random = 5;
    double values[MOST], sorted[MOST], work[MOST];
    for (size_t n = 1; n <= MOST; n++) {
        for (size_t i = 0; i < n; i++) values[i] = sorted[i] = n % 3 ? uniform(&random) : (double)(solve_random(&random) % 4);
        sort_doubles(sorted, n);
        for (size_t k = 0; k < n; k++) {
            memcpy(work, values, n * sizeof *work);
            assert_true(solve_select(work, n, k) == sorted[k]);
            sort_doubles(work, n); // reordered, and still the same ones
            assert_memory_equal(work, sorted, n * sizeof *work);
        }
        memcpy(work, values, n * sizeof *work);
        assert_true(solve_median(work, n) == sorted[n / 2]);
    }
    assert_true(solve_median(values, 0) == 0.0);
}

// splitmix64's own first numbers (Steele, Lea and Flood 2014): what is chosen by chance is the same everywhere.
static void random_numbers_are_splitmix64s(void **state)
{
    (void)state;
    uint64_t zero = 0, other = 1234567;
    assert_true(solve_random(&zero) == 0xe220a8397b1dcdafu && solve_random(&zero) == 0x6e789e6aa1b965f4u);
    assert_true(solve_random(&other) == 6457827717110365317u && solve_random(&other) == 3203168211198807973u);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eigenvectors_are_those_it_is_made_of),
        cmocka_unit_test(the_smallest_is_found_alone),
        cmocka_unit_test(systems_are_solved),
        cmocka_unit_test(selection_is_that_of_sorting),
        cmocka_unit_test(random_numbers_are_splitmix64s),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
