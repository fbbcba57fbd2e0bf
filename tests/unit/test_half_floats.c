// Halves, all 65536 of them, as floats: the processor's way and ours, and back.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/half.h"

enum { ALL = 65536 };

static void test_all(void **state)
{
    static uint16_t halves[ALL];
    static float floats[ALL];
    (void)state;
    for (int i = 0; i < ALL; i++) halves[i] = (uint16_t)i;
    half_to_floats(halves, ALL, floats);
    for (int i = 0; i < ALL; i++) {
        float f = half_to_float(halves[i]);
        if (isnan(f)) {
            assert_true(isnan(floats[i]));
        } else {
            assert_memory_equal(&f, &floats[i], sizeof f);
            assert_int_equal(float_to_half(f), halves[i]);
        }
    }
    // Any length from any place, and nothing beyond it.
    for (size_t n = 0; n < 20; n++) {
        float some[24];
        memset(some, 0x55, sizeof some);
        half_to_floats(halves + 0x3c01, n, some);
        assert_memory_equal(some, floats + 0x3c01, n * sizeof *some);
        for (size_t i = n; i < 24; i++) assert_memory_equal(&some[i], "\x55\x55\x55\x55", 4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_all)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
