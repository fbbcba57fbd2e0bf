// Comparisons with a tolerance that print what was got; to be included after cmocka.h.
#ifndef SSDO_TESTS_NEAR_H
#define SSDO_TESTS_NEAR_H

#include "base/vec.h"

// NaN is never near.
static inline void assert_near_at(double got, double wanted, double tolerance, const char *file, int line)
{
    if (fabs(got - wanted) <= tolerance) return;
    print_error("got %.9g, wanted %.9g within %g\n", got, wanted, tolerance);
    _fail(file, line);
}

#define assert_near(got, wanted, tolerance) assert_near_at(got, wanted, tolerance, __FILE__, __LINE__)
#define assert_near3(got, wanted, tolerance) assert_near3_at(got, wanted, tolerance, __FILE__, __LINE__)

static inline void assert_near3_at(vec3 got, vec3 wanted, double tolerance, const char *file, int line)
{
    assert_near_at(got.x, wanted.x, tolerance, file, line);
    assert_near_at(got.y, wanted.y, tolerance, file, line);
    assert_near_at(got.z, wanted.z, tolerance, file, line);
}

#endif
