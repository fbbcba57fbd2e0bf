// Stored depths and the distances they mean, both ways, by formulas written here.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "gbuffer/depth_code.h"

static const double nearest = 0.25, farthest = 40.0;

static double stored(depth_kind k, double z)
{
    double linear = (z - nearest) / (farthest - nearest), hyperbolic = farthest * (z - nearest) / (z * (farthest - nearest));
    switch (k) {
    case DEPTH_INVERSE:
        return 1.0 / z;
    case DEPTH_LINEAR:
        return linear;
    case DEPTH_INVERTED:
        return 1.0 - linear;
    case DEPTH_ZBUFFER:
        return hyperbolic;
    case DEPTH_REVERSED:
        return 1.0 - hyperbolic;
    case DEPTH_NDC:
        return 2.0 * hyperbolic - 1.0;
    default:
        return z;
    }
}

static void every_kind_is_undone(void **state)
{
    (void)state;
    for (int k = DEPTH_PLANAR; k < DEPTH_KINDS; k++) {
        depth_code c = {(depth_kind)k, 1.0, nearest, farthest};
        for (double z = 0.3; z < farthest; z *= 1.3) assert_true(fabs(depth_decode(&c, stored(c.kind, z)) / z - 1.0) < 1e-12);
        c.sign = -1.0;
        if (k <= DEPTH_INVERSE) assert_true(fabs(depth_decode(&c, -stored(c.kind, 3.0)) / 3.0 - 1.0) < 1e-12);
        assert_non_null(word_of(depth_kind_words, k));
    }
    assert_null(word_of(depth_kind_words, DEPTH_AUTO)); // what is not given has no word
}

// What lies behind everything is no distance, and neither is what lies beyond 0..1.
static void background_is_none(void **state)
{
    (void)state;
    const struct {
        depth_kind kind;
        double value;
    } none[] = {{DEPTH_INVERSE, 0},  {DEPTH_INVERSE, -1},   {DEPTH_LINEAR, 1},  {DEPTH_LINEAR, 1.5}, {DEPTH_LINEAR, -0.1},
                {DEPTH_INVERTED, 0}, {DEPTH_INVERTED, 1.5}, {DEPTH_ZBUFFER, 1}, {DEPTH_REVERSED, 0}, {DEPTH_REVERSED, -1},
                {DEPTH_LINEAR, NAN}, {DEPTH_REVERSED, NAN}, {DEPTH_NDC, 1},     {DEPTH_NDC, -1.5},   {DEPTH_NDC, NAN}};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        depth_code c = {none[i].kind, 1.0, nearest, farthest};
        assert_true(isnan(depth_decode(&c, none[i].value)));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_kind_is_undone), cmocka_unit_test(background_is_none)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
