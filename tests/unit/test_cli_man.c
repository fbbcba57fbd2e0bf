// --help, the manual page and the tables of methods. Run from the root of the project. SSDO_UPDATE_MAN=1 build/tests/test_cli_man
// rewrites the manual's OPTIONS section and the methods of src/passes/README.md from their tables.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/options.h"
#include "cli/options_table.h"
#include "passes/method.h"
#include "pipeline/complete.h"

static const char *const page = "man/ssdo-filter.1";

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

static char *read_file(const char *path)
{
    FILE *f = fopen(path, "r");
    if (!f) fail_msg("%s cannot be read; run the tests from the root of the project", path);
    char *text = read_text(f);
    fclose(f);
    return text;
}

// The part between the lines that hold "BEGIN `name`" and `end_mark`.
static void find_section(char *text, const char *name, const char *end_mark, char **begin, char **end)
{
    char begin_mark[64];
    snprintf(begin_mark, sizeof begin_mark, "BEGIN %s", name);
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
    char *help = printed(help_write), *flat = on_one_line(help);
    for (int i = 0; i < option_row_count; i++) {
        const option_row *row = &option_rows[i];
        char left[192], buf[OPTION_ARGUMENT];
        if (row->hidden) continue;
        const char *argument = option_argument(row, buf, sizeof buf), *gap = *argument ? " " : "";
        if (row->letter)
            snprintf(left, sizeof left, "\n  -%c, --%s%s%s", row->letter, row->name, gap, argument);
        else
            snprintf(left, sizeof left, "\n      --%s%s%s", row->name, gap, argument);
        char *at = strstr(help, left);
        if (!at || !strchr(" \n", at[strlen(left)])) fail_msg("no line '%s'", left + 1);
        char text[2048];
        snprintf(text, sizeof text, "--%s%s%s %s%s%s%s", row->name, gap, argument, row->help, row->fallback ? " (default: " : "",
                 row->fallback ? row->fallback : "", row->fallback ? ")" : "");
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
        bool words = row->kind == OPT_SWITCH || row->kind == OPT_ENUM;
        assert_true(row->name && row->help && row->help[strlen(row->help) - 1] == '.');
        assert_int_equal(row->kind == OPT_FLAG || words, row->argument == NULL); // words are their own argument
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

static void holds(const char *path, const char *name, const char *end_mark, void (*print)(FILE *))
{
    char *text = read_file(path), *wanted = printed(print), *begin, *end;
    find_section(text, name, end_mark, &begin, &end);
    if (getenv("SSDO_UPDATE_MAN")) {
        FILE *f = fopen(path, "w");
        assert_non_null(f);
        fprintf(f, "%.*s%s%s", (int)(begin - text), text, wanted, end);
        fclose(f);
    } else if ((size_t)(end - begin) != strlen(wanted) || strncmp(begin, wanted, strlen(wanted)) != 0) {
        fail_msg("%s is not what the table of its %s says; run SSDO_UPDATE_MAN=1 build/tests/test_cli_man", path, name);
    }
    free(text);
    free(wanted);
}

static void the_pages_hold_the_tables(void **state)
{
    (void)state;
    holds(page, "OPTIONS", ".\\\" END OPTIONS", options_print_man);
    holds("src/passes/README.md", "METHODS", "<!-- END METHODS", methods_print_markdown);
}

// A word of a text of names that commas, blanks and "and" divide.
static bool names_hold(const char *names, size_t length, const char *word)
{
    size_t n = strlen(word);
    for (const char *p = names; p < names + length; p += strspn(p, " ,")) {
        size_t w = strcspn(p, " ,:");
        if (w == n && strncmp(p, word, n) == 0) return true;
        p += w;
        if (*p == ':' || *p == '\0') break;
    }
    return false;
}

// Every method has its line in --help, its row in the manual, and says of every option whether it takes it, as the option's own
// text does where that begins "For METHODS:".
static void every_method_is_told(void **state)
{
    (void)state;
    char *help = printed(help_write), *flat = on_one_line(help), *table = printed(methods_print_man);
    for (const method *m = method_next(NULL, SEES_ANY); m; m = method_next(m, SEES_ANY)) {
        char line[1024];
        snprintf(line, sizeof line, " %s: %s ", m->name, m->summary);
        if (!strstr(flat, line)) fail_msg("--help does not say '%s'", line);
        snprintf(line, sizeof line, "\n%s\tT{\n", m->name);
        if (!strstr(table, line)) fail_msg("the manual's table lacks %s", m->name);
        assert_true(*m->weighting && *m->reaches && *m->blind && *m->light && *m->choose && m->samples > 0);
        for (int i = 0; i < option_row_count; i++) {
            const option_row *row = &option_rows[i];
            const char *colon = strchr(row->help, ':');
            if (strncmp(row->help, "For ", 4) != 0 || !colon) continue;
            bool told = names_hold(row->help + 4, (size_t)(colon - row->help) - 4, m->name);
            if (told != names_hold(m->options, strlen(m->options), row->name))
                fail_msg("--%s and the row of %s do not agree on whether %s takes it", row->name, m->name, m->name);
        }
        for (const char *p = m->options; *p; p += strspn(p, " ")) { // names of options
            int known = 0;
            size_t n = strcspn(p, " ");
            for (int i = 0; i < option_row_count; i++)
                known += strlen(option_rows[i].name) == n && strncmp(p, option_rows[i].name, n) == 0;
            if (known != 1) fail_msg("%s takes '%.*s', which is no option", m->name, (int)n, p);
            p += n;
        }
    }
    options o;
    options_defaults(&o);
    assert_string_equal(o.method, method_default()->name);
    free(help);
    free(flat);
    free(table);
}

static void the_page_has_its_sections(void **state)
{
    (void)state;
    const char *const sections[] = {"NAME",        "SYNOPSIS",    "DESCRIPTION", "LAYERS", "METHODS", "OPTIONS",
                                    "ENVIRONMENT", "EXIT STATUS", "EXAMPLES",    "LIMITS", "SEE ALSO"};
    char *text = read_file(page);
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

// Of the page as `make` completes it.
static void formatters_have_no_complaint(void **state)
{
    (void)state;
    char path[] = "/tmp/ssdo-manXXXXXX", command[512];
    char *text = read_file(page), *table = printed(methods_print_man), *at = strstr(text, "BEGIN METHODS");
    assert_non_null(at);
    at = strchr(at, '\n') + 1;
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    FILE *f = fdopen(fd, "w");
    assert_non_null(f);
    fprintf(f, "%.*s%s%s", (int)(at - text), text, table, at);
    assert_int_equal(fclose(f), 0);
    free(text);
    free(table);
    snprintf(command, sizeof command, "LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings=all -E UTF-8 -Tutf8 -Z -l %s 2>&1 >/dev/null",
             path);
    char *groff = complaints("man", command);
    snprintf(command, sizeof command, "mandoc -T lint -W style %s 2>&1 | grep -v mandoc.db", path);
    char *mandoc = complaints("mandoc", command);
    unlink(path);
    if (groff && *groff) fail_msg("man: %s", groff);
    if (mandoc && *mandoc) fail_msg("mandoc: %s", mandoc);
    if (!groff && !mandoc) skip();
    free(groff);
    free(mandoc);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(help_lists_every_row),      cmocka_unit_test(the_table_is_sound),
        cmocka_unit_test(the_pages_hold_the_tables), cmocka_unit_test(every_method_is_told),
        cmocka_unit_test(the_page_has_its_sections), cmocka_unit_test(formatters_have_no_complaint),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
