// What drivers say of shaders is read, in the forms of those that we do not have here too.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "gpu/diagnose.h"
#include "must.h"

static void expect(const char *line, int file, int number, bool is_error, const char *text)
{
    diagnose_place p;
    if (!diagnose_line(line, &p)) fail_msg("no place is found in '%s'", line);
    assert_int_equal(p.file, file);
    assert_int_equal(p.line, number);
    assert_int_equal(p.is_error, is_error);
    assert_string_equal(p.text, text);
}

static void every_drivers_form_is_read(void **state)
{
    (void)state;
    expect("0:144(5): error: syntax error", 0, 144, true, "error: syntax error");
    expect("12:3(17): preprocessor error: #endif without #if", 12, 3, true, "preprocessor error: #endif without #if");
    expect("2:9(1): warning: `x' used uninitialized", 2, 9, false, "warning: `x' used uninitialized");
    expect("0(144) : error C0000: syntax error, unexpected '}'", 0, 144, true, "error C0000: syntax error, unexpected '}'");
    expect("3(7) : warning C7050: \"x\" might be used before being initialized", 3, 7, false,
           "warning C7050: \"x\" might be used before being initialized");
    expect("ERROR: 1:22: 'foo' : undeclared identifier", 1, 22, true, "'foo' : undeclared identifier");
    expect("WARNING: 0:3: extension not supported", 0, 3, false, "extension not supported");
}

static void what_is_no_place_is_left_alone(void **state)
{
    (void)state;
    static const char *const lines[] = {"",
                                        "error: linking",
                                        "Compute info",
                                        "------------",
                                        "0",
                                        "0:",
                                        "0:5",
                                        "0:5(",
                                        "0:5(1) error",
                                        "0(5",
                                        "0(5) error",
                                        "0(5(",
                                        "-1:5(1): error",
                                        "ERROR: ",
                                        "ERROR: 1 compilation errors. No code generated.",
                                        "99999999999:1(1): error",
                                        "0:99999999999(1): error"};
    diagnose_place p;
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
        if (diagnose_line(lines[i], &p)) fail_msg("a place is found in '%s'", lines[i]);
}

static void the_first_error_is_found_behind_warnings(void **state)
{
    (void)state;
    diagnose_place p;
    assert_true(diagnose_first(
        "Compute info\n------------\n1(4) : warning C7050: x\n2(8) : error C1503: y\n3(1) : error C0000: z\n", &p));
    assert_int_equal(p.file, 2);
    assert_int_equal(p.line, 8);
    assert_false(diagnose_first("1:4(1): warning: x\nerror: too many images\n", &p));
    assert_false(diagnose_first("", &p));
}

static void numbers_of_files_become_names(void **state)
{
    static const char *const files[] = {"arc_light.comp", "include/frame.glsl"};
    error e = {0};
    (void)state;
    char *text = diagnose_translate("0:144(5): error: a\n1(20) : error C0000: b\n2:1(1): error: no such file\nlinked with error",
                                    files, 2, &e);
    must(text != NULL, &e);
    assert_string_equal(
        text,
        "arc_light.comp:144: error: a\ninclude/frame.glsl:20: error C0000: b\n2:1(1): error: no such file\nlinked with error");
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_drivers_form_is_read),
        cmocka_unit_test(what_is_no_place_is_left_alone),
        cmocka_unit_test(the_first_error_is_found_behind_warnings),
        cmocka_unit_test(numbers_of_files_become_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
