// Rotations estimated from two sets of directions: recovered, told from reflections, refused where they are open.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "gbuffer/rotation.h"
#include "gbuffer/solve.h"

static uint64_t random_state = 11;

static double uniform(void) { return (double)(solve_random(&random_state) >> 11) * 0x1p-53 * 2.0 - 1.0; }

static vec3 direction(void)
{
    for (;;) {
        vec3 v = v3(uniform(), uniform(), uniform());
        if (v3_length(v) > 0.1 && v3_length(v) < 1.0) return v3_normalize(v);
    }
}

static mat3 orthogonal(double determinant)
{
    vec3 a = direction(), b = v3_normalize(v3_cross(a, direction())), c = v3_scale(v3_cross(a, b), determinant);
    return (mat3){{{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}}};
}

static mat3 correlation(mat3 r, const vec3 *from, int count)
{
    mat3 m = {{{0}}};
    for (int i = 0; i < count; i++) {
        vec3 to = m3_apply(r, from[i]);
        const double t[3] = {to.x, to.y, to.z}, f[3] = {from[i].x, from[i].y, from[i].z};
        for (int k = 0; k < 9; k++) m.m[k / 3][k % 3] += t[k / 3] * f[k % 3] / count;
    }
    return m;
}

static double apart(mat3 a, mat3 b)
{
    double most = 0.0;
    for (int i = 0; i < 9; i++) most = fmax(most, fabs(a.m[i / 3][i % 3] - b.m[i / 3][i % 3]));
    return most;
}

static void recovered(void **state)
{
    (void)state;
    for (int trial = 0; trial < 200; trial++) {
        double hand = trial % 2 ? -1.0 : 1.0, second;
        vec3 from[20];
        mat3 truth = orthogonal(hand), found, other;
        for (int i = 0; i < 20; i++) from[i] = direction();
        assert_true(rotation_between(correlation(truth, from, 20), hand, &found, &second));
        assert_true(apart(found, truth) < 1e-9 && second > 0.2);
        assert_true(rotation_between(correlation(truth, from, 20), -hand, &other, &second));
        assert_true(fabs(m3_det(other) + hand) < 1e-9 && apart(other, truth) > 0.5);
    }
}

// Two planes leave the third axis to the determinant; one plane leaves the turn about its normal open.
static void open_ones(void **state)
{
    (void)state;
    const vec3 two[2] = {{1, 0, 0}, {0.6, 0.8, 0}}, one[2] = {{0, 0, 1}, {0, 0, 1}};
    mat3 truth = orthogonal(1.0), found;
    double second;
    assert_true(rotation_between(correlation(truth, two, 2), 1.0, &found, &second));
    assert_true(apart(found, truth) < 1e-9 && second > 0.2);
    if (rotation_between(correlation(truth, one, 2), 1.0, &found, &second)) assert_true(second < 1e-6);
    assert_false(rotation_between((mat3){{{0}}}, 1.0, &found, &second));
}

static void angles(void **state)
{
    (void)state;
    double degrees, a = 0.1;
    const mat3 swap = {{{0, -1, 0}, {0, 0, 1}, {1, 0, 0}}}, turn = {{{cos(a), -sin(a), 0}, {sin(a), cos(a), 0}, {0, 0, 1}}};
    assert_true(fabs(rotation_angle(turn) - a * 57.29577951308232) < 1e-9);
    assert_true(apart(rotation_nearest_axes(m3_mul(turn, swap), &degrees), swap) == 0.0);
    assert_true(fabs(degrees - a * 57.29577951308232) < 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(recovered), cmocka_unit_test(open_ones), cmocka_unit_test(angles)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
