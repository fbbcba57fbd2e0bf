// --help and the man page's OPTIONS section.
#include <string.h>

#include "cli/options.h"
#include "cli/options_table.h"

enum { HELP_COLUMN = 30, HELP_WIDTH = 100 };

// Words of `text` from column `at` on, wrapped to HELP_COLUMN .. HELP_WIDTH. Returns the column after them.
static int print_wrapped(FILE *to, int at, const char *text)
{
    while (*text) {
        size_t length = strcspn(text, " ");
        int n = (int)length;
        if (at > HELP_COLUMN && at + 1 + n > HELP_WIDTH) {
            fprintf(to, "\n%*s", HELP_COLUMN, "");
            at = HELP_COLUMN;
        } else if (at > HELP_COLUMN) {
            at += fprintf(to, " ");
        }
        at += fprintf(to, "%.*s", n, text);
        text += length;
        text += strspn(text, " ");
    }
    return at;
}

static void print_help_row(FILE *to, const option_row *row, const option_values *more)
{
    char left[192], fallback[256], buf[OPTION_ARGUMENT];
    char letter[8] = "    ";
    const char *argument = option_argument(row, buf, sizeof buf);
    if (row->letter) snprintf(letter, sizeof letter, "-%c, ", row->letter);
    int n = snprintf(left, sizeof left, "  %s--%s%s%s", letter, row->name, *argument ? " " : "", argument);
    fprintf(to, "%s", left);
    if (n >= HELP_COLUMN) {
        fprintf(to, "\n");
        n = 0;
    }
    fprintf(to, "%*s", HELP_COLUMN - n, "");
    int at = print_wrapped(to, HELP_COLUMN, row->help);
    if (row->fallback) {
        snprintf(fallback, sizeof fallback, "(default: %s)", row->fallback);
        print_wrapped(to, at, fallback);
    }
    fprintf(to, "\n");
    for (const option_value *v = more ? more->values : NULL; v && v->text; v++) {
        if (!v->help) continue;
        at = fprintf(to, "%*s%s:", HELP_COLUMN, "", v->text);
        print_wrapped(to, at, v->help);
        fprintf(to, "\n");
    }
}

void options_print_help(FILE *to, const option_values *values)
{
    fprintf(to, "usage: ssdo-filter [options] INPUT... -o OUTPUT\n"
                "Ambient occlusion, directional light and one diffuse bounce from a G-buffer EXR.\n");
    for (int g = 0; g < GROUP_COUNT; g++) {
        fprintf(to, "\n%s\n", option_group_title((option_group)g));
        for (int i = 0; i < option_row_count; i++)
            if ((int)option_rows[i].group == g && !option_rows[i].hidden)
                print_help_row(to, &option_rows[i], option_values_of(values, option_rows[i].name));
    }
    fprintf(to, "\nExit status: 0 done, 1 some frames failed, 2 usage, 3 input, 4 output, 5 GL or EGL, 6 memory,\n7 doubtful "
                "input under --strict.\n"
                "The manual: man ssdo-filter\n");
}

enum { MDOC_WIDTH = 78 };

// One word for mdoc: minus signs that can be copied, nothing taken for a macro or an escape. Returns the bytes printed.
static int print_mdoc_word(FILE *to, const char *word, size_t length, bool starts_line)
{
    int bytes = starts_line && (*word == '.' || *word == '\'') ? fprintf(to, "\\&") : 0;
    for (size_t i = 0; i < length; i++) {
        if (word[i] == '\\')
            bytes += fprintf(to, "\\e");
        else if (word[i] == '-' && word[0] == '-')
            bytes += fprintf(to, "\\-");
        else
            bytes += fprintf(to, "%c", word[i]);
    }
    return bytes;
}

// Text for mdoc, from column `at` on: sentences begin a line, as mdoc wants it, and long lines are wrapped.
static void print_mdoc(FILE *to, int at, const char *text)
{
    bool sentence_end = false;
    while (*text) {
        size_t length = strcspn(text, " ");
        if (sentence_end || (at > 0 && at + (int)length >= MDOC_WIDTH)) {
            fprintf(to, "\n");
            at = 0;
        } else if (at > 0) {
            at += fprintf(to, " ");
        }
        at += print_mdoc_word(to, text, length, at == 0);
        sentence_end = text[length - 1] == '.';
        text += length;
        text += strspn(text, " ");
    }
    fprintf(to, "\n");
}

static void print_mdoc_name(FILE *to, const char *name)
{
    fprintf(to, "Fl \\-");
    for (const char *p = name; *p; p++) fprintf(to, *p == '-' ? "\\-" : "%c", *p);
}

// Of a long list of words, a line may end after each.
static void print_mdoc_argument(FILE *to, const char *argument)
{
    fprintf(to, " Ar ");
    for (const char *p = argument; *p; p++) fprintf(to, *p == '|' ? "|\\:" : "%c", *p);
}

static void print_man_row(FILE *to, const option_row *row)
{
    char buf[OPTION_ARGUMENT];
    const char *argument = option_argument(row, buf, sizeof buf);
    fprintf(to, ".It ");
    if (row->letter) fprintf(to, "Fl %c , ", row->letter);
    print_mdoc_name(to, row->name);
    if (*argument) print_mdoc_argument(to, argument);
    fprintf(to, "\n");
    print_mdoc(to, 0, row->help);
    if (row->fallback) print_mdoc(to, fprintf(to, "Default:"), row->fallback);
}

void options_print_man(FILE *to)
{
    for (int g = 0; g < GROUP_COUNT; g++) {
        fprintf(to, ".Ss %s\n.Bl -tag -width Ds\n", option_group_title((option_group)g));
        for (int i = 0; i < option_row_count; i++)
            if ((int)option_rows[i].group == g && !option_rows[i].hidden) print_man_row(to, &option_rows[i]);
        fprintf(to, ".El\n");
    }
}
