#include "cli/completion.h"

#include <string.h>

// The words of a row or of `more`, separated by spaces; false if there are none.
static bool print_words(FILE *to, const option_row *row, const option_values *more)
{
    for (const option_value *v = more ? more->values : NULL; v && v->text; v++)
        fprintf(to, "%s%s", v == more->values ? "" : " ", v->text);
    for (const option_word *w = more ? NULL : row->words; w && w->text; w++)
        fprintf(to, "%s%s", w == row->words ? "" : " ", w->text);
    return more || row->words;
}

// "*.json" for FILE.json, "*" for other files.
static void print_glob(FILE *to, const option_row *row)
{
    const char *dot = strrchr(row->argument, '.');
    fprintf(to, "*%s", dot ? dot : "");
}

// ---- bash

static void print_bash_case(FILE *to, const option_row *row, const option_values *more)
{
    fprintf(to, "    --%s", row->name);
    if (row->letter) fprintf(to, " | -%c", row->letter);
    fprintf(to, ")\n        ");
    if (row->kind == OPT_PATH || row->kind == OPT_PATHS) {
        fprintf(to, "COMPREPLY=($(compgen -d -- \"$cur\") $(compgen -f -X '!");
        print_glob(to, row);
        fprintf(to, "' -- \"$cur\"))\n        compopt -o filenames\n        return ;;\n");
        return;
    }
    bool list = more && more->list;
    if (!more && !row->words) {
        fprintf(to, "return ;;\n");
        return;
    }
    fprintf(to, list ? "COMPREPLY=($(compgen -P \"${cur%%\"${cur##*,}\"}\" -W '" : "COMPREPLY=($(compgen -W '");
    print_words(to, row, more);
    fprintf(to, list ? "' -- \"${cur##*,}\"))\n        compopt -o nospace\n        return ;;\n"
                     : "' -- \"$cur\"))\n        return ;;\n");
}

static void print_bash(FILE *to, const option_values *values)
{
    fprintf(to, "# bash completion of ssdo-filter, written by ssdo-filter --completion bash\n"
                "_ssdo_filter()\n{\n"
                "    local cur=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}\n"
                "    COMPREPLY=()\n"
                "    # --option=value comes as three words\n"
                "    [[ $cur == = ]] && cur=\n"
                "    [[ $before == = ]] && before=${COMP_WORDS[COMP_CWORD - 2]}\n"
                "    case $before in\n");
    for (int i = 0; i < option_row_count; i++)
        if (!option_rows[i].hidden && option_rows[i].kind != OPT_FLAG)
            print_bash_case(to, &option_rows[i], option_values_of(values, option_rows[i].name));
    fprintf(to, "    esac\n    if [[ $cur == -* ]]; then\n        COMPREPLY=($(compgen -W '");
    for (int i = 0; i < option_row_count; i++)
        if (!option_rows[i].hidden) fprintf(to, "%s--%s", i ? " " : "", option_rows[i].name);
    fprintf(to, "' -- \"$cur\"))\n        return\n    fi\n"
                "    COMPREPLY=($(compgen -d -- \"$cur\") $(compgen -f -X '!*.exr' -- \"$cur\"))\n"
                "    compopt -o filenames\n}\ncomplete -F _ssdo_filter ssdo-filter\n");
}

// ---- zsh

// The first sentence without its full stop, with what _arguments takes for its own escaped, inside single quotes.
static void print_zsh_help(FILE *to, const char *help)
{
    const char *end = strstr(help, ". ");
    size_t n = end ? (size_t)(end - help) : strlen(help) - 1;
    for (size_t i = 0; i < n; i++) {
        if (help[i] == '\'')
            fputs("'\\''", to);
        else
            fprintf(to, strchr("[]:\\", help[i]) ? "\\%c" : "%c", help[i]);
    }
}

static void print_zsh_row(FILE *to, const option_row *row, const option_values *more)
{
    const char *value = row->kind == OPT_FLAG ? "" : "=";
    fprintf(to, "    ");
    if (row->letter)
        fprintf(to, "'(-%c --%s)'{-%c%s,--%s%s}'[", row->letter, row->name, row->letter, *value ? "+" : "", row->name, value);
    else
        fprintf(to, "'--%s%s[", row->name, value);
    print_zsh_help(to, row->help);
    fprintf(to, "]");
    if (row->kind == OPT_FLAG) {
        fprintf(to, "' \\\n");
        return;
    }
    fprintf(to, ":%s:", row->name);
    if (row->kind == OPT_PATH || row->kind == OPT_PATHS) {
        fprintf(to, "_files -g \"");
        print_glob(to, row);
        fprintf(to, "\"");
    } else if (more || row->words) {
        fprintf(to, more && more->list ? "_values -s , %s " : "(", row->name);
        print_words(to, row, more);
        if (!more || !more->list) fprintf(to, ")");
    } else {
        fprintf(to, " ");
    }
    fprintf(to, "' \\\n");
}

static void print_zsh(FILE *to, const option_values *values)
{
    fprintf(
        to,
        "#compdef ssdo-filter\n# zsh completion of ssdo-filter, written by ssdo-filter --completion zsh\n_arguments -s -S \\\n");
    for (int i = 0; i < option_row_count; i++)
        if (!option_rows[i].hidden) print_zsh_row(to, &option_rows[i], option_values_of(values, option_rows[i].name));
    fprintf(to, "    '*:input:_files -g \"*.exr\"'\n");
}

void completion_print(FILE *to, bool zsh, const option_values *values)
{
    if (zsh)
        print_zsh(to, values);
    else
        print_bash(to, values);
}
