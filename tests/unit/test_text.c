// Text from outside on its way to a terminal: one line, no commands, UTF-8.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/text.h"

static void one_line(void **state)
{
    (void)state;
    static const struct {
        const char *from, *to;
    } cases[] = {
        {"plain, \xc3\xa9 \xe2\x82\xac \xf0\x9f\x8e\xac", "plain, \xc3\xa9 \xe2\x82\xac \xf0\x9f\x8e\xac"},
        {"a\nb\rc\td", "a?b?c?d"},
        {"\x1b[2J\x07\x7f", "?[2J??"},
        {"\xc2\x9b"
         "2J",
         "??2J"},                          // a control character of two bytes
        {"\xc2\xa0", "\xc2\xa0"},          // the first that is none
        {"\x9b\xff\xc3", "???"},           // no UTF-8
        {"\xed\xa0\x80\xc0\xaf", "?????"}, // a surrogate, a slash in two bytes
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[64];
        snprintf(text, sizeof text, "%s", cases[i].from);
        text_one_line(text);
        assert_string_equal(text, cases[i].to);
    }
}

static void printed(void **state)
{
    (void)state;
    char *out = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&out, &size);
    assert_non_null(f);
    text_print(f, "\nview %s\n", "a\nerror: b\n");
    text_print(f, "%d", 3);
    text_print(f, "\n");
    text_print(f, "%s\n\n", "\x1b[31m");
    fclose(f);
    assert_string_equal(out, "\nview a?error: b?\n3\n?[31m\n\n");
    free(out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(one_line), cmocka_unit_test(printed)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
