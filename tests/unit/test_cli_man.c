// --help and the manual page. Run from the root of the project.
// SSDO_UPDATE_MAN=1 build/tests/test_cli_man rewrites the OPTIONS section from the table.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/options.h"
#include "cli/options_table.h"

static const char *const page = "man/ssdo-filter.1";
static const char *const begin_mark = ".\\\" BEGIN OPTIONS";
static const char *const end_mark = ".\\\" END OPTIONS";

static char *read_text(FILE *f)
{
    size_t used = 0, size = 1 << 20;
    char *text = malloc(size + 1);
    assert_non_null(text);
    used = fread(text, 1, size, f);
    text[used] = '\0';
    return text;
}

static char *printed(void (*print)(FILE *))
{
    FILE *f = tmpfile();
    assert_non_null(f);
    print(f);
    rewind(f);
    char *text = read_text(f);
    fclose(f);
    return text;
}

static char *read_page(void)
{
    FILE *f = fopen(page, "r");
    if (!f) fail_msg("%s cannot be read; run the tests from the root of the project", page);
    char *text = read_text(f);
    fclose(f);
    return text;
}

// The part between the lines that hold the markers.
static void find_section(char *text, char **begin, char **end)
{
    *begin = strstr(text, begin_mark);
    *end = strstr(text, end_mark);
    assert_true(*begin && *end);
    *begin = strchr(*begin, '\n') + 1;
}

// A copy with one space for each run of white space.
static char *on_one_line(const char *text)
{
    char *flat = malloc(strlen(text) + 1), *to = flat;
    assert_non_null(flat);
    for (; *text; text++)
        if (!strchr(" \n", *text))
            *to++ = *text;
        else if (to > flat && to[-1] != ' ')
            *to++ = ' ';
    *to = '\0';
    return flat;
}

// Name, argument, text and default, whole.
static void help_lists_every_row(void **state)
{
    (void)state;
    char *help = printed(options_print_help), *flat = on_one_line(help);
    for (int i = 0; i < option_row_count; i++) {
        const option_row *row = &option_rows[i];
        char left[128];
        if (row->hidden) continue;
        if (row->letter)
            snprintf(left, sizeof left, "\n  -%c, --%s%s%s", row->letter, row->name, row->argument ? " " : "",
                     row->argument ? row->argument : "");
        else
            snprintf(left, sizeof left, "\n      --%s%s%s", row->name, row->argument ? " " : "",
                     row->argument ? row->argument : "");
        char *at = strstr(help, left);
        if (!at || !strchr(" \n", at[strlen(left)])) fail_msg("no line '%s'", left + 1);
        char text[2048];
        snprintf(text, sizeof text, "--%s%s%s %s%s%s%s", row->name, row->argument ? " " : "", row->argument ? row->argument : "",
                 row->help, row->fallback ? " (default: " : "", row->fallback ? row->fallback : "", row->fallback ? ")" : "");
        if (!strstr(flat, text)) fail_msg("--help does not say '%s'", text);
    }
    free(flat);
    for (char *line = help; *line; line = strchr(line, '\n') + 1) assert_true(strcspn(line, "\n") <= 100);
    free(help);
}

// What the rows need so that parser, help and record can rely on them.
static void the_table_is_sound(void **state)
{
    (void)state;
    for (int i = 0; i < option_row_count; i++) {
        const option_row *row = &option_rows[i];
        bool words = row->kind == OPT_SWITCH || row->kind == OPT_ENUM || row->kind == OPT_CHOICE;
        assert_true(row->name && row->help && row->help[strlen(row->help) - 1] == '.');
        assert_int_equal(row->kind == OPT_FLAG, row->argument == NULL);
        assert_true(!words || row->words);
        assert_true(row->offset < sizeof(options));
        if (row->kind == OPT_INT || row->kind == OPT_REAL) assert_true(row->max > row->min);
        for (int j = 0; j < i; j++) {
            assert_string_not_equal(row->name, option_rows[j].name);
            assert_int_not_equal(row->offset, option_rows[j].offset);
            assert_true(!row->letter || row->letter != option_rows[j].letter);
        }
    }
}

static void the_page_holds_the_table(void **state)
{
    (void)state;
    char *text = read_page(), *wanted = printed(options_print_man), *begin, *end;
    find_section(text, &begin, &end);
    if (getenv("SSDO_UPDATE_MAN")) {
        FILE *f = fopen(page, "w");
        assert_non_null(f);
        fprintf(f, "%.*s%s%s", (int)(begin - text), text, wanted, end);
        fclose(f);
    } else if ((size_t)(end - begin) != strlen(wanted) || strncmp(begin, wanted, strlen(wanted)) != 0) {
        fail_msg("%s is not what the option table says; run SSDO_UPDATE_MAN=1 build/tests/test_cli_man", page);
    }
    free(text);
    free(wanted);
}

static void the_page_has_its_sections(void **state)
{
    (void)state;
    const char *const sections[] = {"NAME",        "SYNOPSIS",    "DESCRIPTION", "LAYERS", "METHODS", "OPTIONS",
                                    "ENVIRONMENT", "EXIT STATUS", "EXAMPLES",    "LIMITS", "SEE ALSO"};
    char *text = read_page();
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++) {
        char heading[64];
        snprintf(heading, sizeof heading, "\n.Sh %s\n", sections[i]);
        if (!strstr(text, heading)) fail_msg("no section %s", sections[i]);
    }
    assert_non_null(strstr(text, "SSDO_SHADER_DIR"));
    assert_non_null(strstr(text, "SSDO_PLUGIN_DIR"));
    free(text);
}

// What a formatter says about the page; "" is what we want. NULL if the formatter is not there.
static char *complaints(const char *program, const char *command)
{
    char probe[128];
    snprintf(probe, sizeof probe, "command -v %s >/dev/null", program);
    if (system(probe) != 0) return NULL;
    FILE *f = popen(command, "r");
    assert_non_null(f);
    char *text = read_text(f);
    pclose(f);
    return text;
}

static void formatters_have_no_complaint(void **state)
{
    (void)state;
    char *groff = complaints(
        "man", "LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings=all -E UTF-8 -Tutf8 -Z -l man/ssdo-filter.1 2>&1 >/dev/null");
    char *mandoc = complaints("mandoc", "mandoc -T lint -W style man/ssdo-filter.1 2>&1 | grep -v mandoc.db");
    if (groff && *groff) fail_msg("man: %s", groff);
    if (mandoc && *mandoc) fail_msg("mandoc: %s", mandoc);
    if (!groff && !mandoc) skip();
    free(groff);
    free(mandoc);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(help_lists_every_row),         cmocka_unit_test(the_table_is_sound),
        cmocka_unit_test(the_page_holds_the_table),     cmocka_unit_test(the_page_has_its_sections),
        cmocka_unit_test(formatters_have_no_complaint),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
