// For tests: a step that must succeed, or the test fails with the error's own sentence.
#ifndef SSDO_TESTS_MUST_H
#define SSDO_TESTS_MUST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/error.h"

static inline void must(bool ok, const error *e)
{
    char text[1600];
    if (ok) return;
    err_format(e, text, sizeof text);
    fail_msg("%s", text);
}

#endif
