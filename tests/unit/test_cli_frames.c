// Frame ranges and file patterns.
#include <limits.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "cli/frames.h"

static const char *expand(const char *text)
{
    static char out[512];
    frame_list l;
    error e = {0};
    if (!frames_parse(text, &l, &e)) return e.code == ERR_USAGE ? "error" : "wrong code";
    out[0] = 0;
    for (int i = 0; i < l.count; i++) snprintf(out + strlen(out), sizeof out - strlen(out), "%s%d", i ? " " : "", l.frames[i]);
    frames_free(&l);
    return out;
}

static void ranges(void **state)
{
    (void)state;
    static const char *cases[][2] = {
        {"7", "7"},
        {"1-4", "1 2 3 4"},
        {"1-10x3", "1 4 7 10"},
        {"1-10:4,12", "1 5 9 12"},
        {"3, 5-7", "3 5 6 7"},
        {"-2-1", "-2 -1 0 1"},
        {"-3--1", "-3 -2 -1"},
        {"5-1x2", "5 3 1"},
        {"5-1x-2", "5 3 1"},
        {"1-3,2-4", "1 2 3 4"},
        {"4,4,2,4", "4 2"},
        {"0-15:4%4", "0 4 8 12"},
        {"", "error"},
        {"a", "error"},
        {"1-", "error"},
        {"1-5x0", "error"},
        {"1,,2", "error"},
        {"1-5y2", "error"},
        {"1 2", "error"},
        {"99999999999", "error"},
        {"1-99999999", "error"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if (strcmp(expand(cases[i][0]), cases[i][1]) != 0)
            fail_msg("'%s' gave '%s', not '%s'", cases[i][0], expand(cases[i][0]), cases[i][1]);
}

static void patterns(void **state)
{
    (void)state;
    char path[64];
    static const struct {
        const char *pattern;
        int frame;
        const char *path;
    } cases[] = {
        {"a.####.exr", 7, "a.0007.exr"},       {"a.####.exr", 12345, "a.12345.exr"},
        {"a.%04d.exr", 7, "a.0007.exr"},       {"a.%d.exr", 7, "a.7.exr"},
        {"s/a_$F4.exr", 7, "s/a_0007.exr"},    {"s#1/a.##.exr", -7, "s#1/a.-07.exr"},
        {"x_#_y_###.exr", 2, "x_#_y_002.exr"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_true(pattern_path(cases[i].pattern, cases[i].frame, path, sizeof path));
        assert_string_equal(path, cases[i].path);
    }
    assert_false(pattern_is("shot#3/a.exr")); // a folder's # is no frame place
    assert_false(pattern_is("100%.exr"));
    assert_false(pattern_path("a.####.exr", 1, path, 5));
    assert_true(pattern_path("a.####.exr", INT_MIN, path, sizeof path));
    assert_string_equal(path, "a.-2147483648.exr");
}

static void scanning(void **state)
{
    (void)state;
    char folder[] = "/tmp/ssdo-frames-XXXXXX", command[256], pattern[128];
    frame_list l;
    error e = {0};
    assert_non_null(mkdtemp(folder));
    snprintf(command, sizeof command,
             "cd %s && touch a.0009.exr a.0002.exr a.10000.exr a.3.exr a.00007.exr a.000x.exr b.0001.exr a.0004.exr.tmp", folder);
    assert_int_equal(system(command), 0);
    snprintf(pattern, sizeof pattern, "%s/a.####.exr", folder);
    assert_true(pattern_scan(pattern, &l, &e));
    assert_int_equal(l.count, 3);
    assert_int_equal(l.frames[0], 2);
    assert_int_equal(l.frames[1], 9);
    assert_int_equal(l.frames[2], 10000);
    frames_free(&l);
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
}

static void a_list_reads_back(void **state)
{
    (void)state;
    int frames[] = {3, 7, 10, 11, 12, 13, 20, 21, -2};
    frame_list l = {frames, 9}, back;
    error e = {0};
    char text[64], tight[25];
    frames_format(&l, text, sizeof text);
    assert_string_equal(text, "3, 7, 10-13, 20, 21, -2");
    assert_true(frames_parse(text, &back, &e));
    assert_int_equal(back.count, 9);
    assert_memory_equal(back.frames, frames, sizeof frames);
    frames_free(&back);
    frames_format(&l, tight, sizeof tight); // room for ", ..." until the last is reached
    assert_string_equal(tight, text);
    frames_format(&l, tight, sizeof tight - 1);
    assert_string_equal(tight, "3, 7, 10-13, 20, ...");
    l.count = 0;
    frames_format(&l, text, sizeof text);
    assert_string_equal(text, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(ranges), cmocka_unit_test(patterns), cmocka_unit_test(scanning),
                                       cmocka_unit_test(a_list_reads_back)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
