#include "gpu/diagnose.h"

#include <ctype.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"

static bool read_number(const char **p, int *number)
{
    char *end;
    if (!isdigit((unsigned char)**p)) return false;
    long n = strtol(*p, &end, 10);
    if (n > INT_MAX) return false;
    *number = (int)n;
    *p = end;
    return true;
}

static void skip_spaces(const char **p)
{
    while (**p == ' ' || **p == '\t') ++*p;
}

// What may follow the numbers: "(5):" or ":" after a colon, ") :" after a bracket.
static bool read_end(const char **p, char opening)
{
    int column;
    if (opening == '(' && *(*p)++ != ')') return false;
    if (opening == ':' && **p == '(') {
        ++*p;
        if (!read_number(p, &column) || *(*p)++ != ')') return false;
    }
    skip_spaces(p);
    if (*(*p)++ != ':') return false;
    skip_spaces(p);
    return true;
}

static bool begins(const char *text, const char *word) { return strncmp(text, word, strlen(word)) == 0; }

bool diagnose_line(const char *line, diagnose_place *place)
{
    static const char *const before[] = {"ERROR: ", "WARNING: ", "NOTE: "};
    const char *p = line;
    *place = (diagnose_place){0};
    for (size_t i = 0; i < sizeof before / sizeof *before; i++)
        if (begins(line, before[i])) {
            p += strlen(before[i]);
            place->is_error = i == 0;
        }
    bool marked = p != line;
    if (!read_number(&p, &place->file) || (*p != ':' && *p != '(')) return false;
    char opening = *p++;
    if (!read_number(&p, &place->line) || !read_end(&p, opening)) return false;
    place->text = p;
    if (!marked) place->is_error = begins(p, "error") || begins(p, "preprocessor error") || begins(p, "fatal error");
    return true;
}

static const char *next_line(const char *p)
{
    p += strcspn(p, "\n");
    return *p ? p + 1 : p;
}

bool diagnose_first(const char *log, diagnose_place *place)
{
    for (const char *p = log; *p; p = next_line(p))
        if (diagnose_line(p, place) && place->is_error) return true;
    return false;
}

char *diagnose_translate(const char *log, const char *const files[], int count, error *e)
{
    size_t longest = 0, lines = 1;
    for (int i = 0; i < count; i++)
        if (strlen(files[i]) > longest) longest = strlen(files[i]);
    for (const char *p = log; *p; p++) lines += *p == '\n';
    size_t capacity = strlen(log) + lines * (longest + 24) + 1, used = 0;
    char *out = mem_zero(capacity, 1, e);
    for (const char *p = log; out && *p; p = next_line(p)) {
        diagnose_place place;
        const char *text = p;
        if (diagnose_line(p, &place) && place.file < count) {
            used += (size_t)snprintf(out + used, capacity - used, "%s:%d: ", files[place.file], place.line);
            text = place.text;
        }
        size_t n = (size_t)(next_line(p) - text);
        memcpy(out + used, text, n);
        used += n;
    }
    return out;
}
