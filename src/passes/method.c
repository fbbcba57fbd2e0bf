#include "passes/method.h"

#include <stdio.h>
#include <string.h>

const method *method_default(void) { return methods[0]; }

const method *method_next(const method *m, unsigned sources)
{
    const method *const *at = methods;
    while (m && *at++ != m) continue;
    while (*at && !((*at)->source & sources)) at++;
    return *at;
}

const method *method_find(const char *name)
{
    for (const method *const *m = methods; *m; m++)
        if (strcmp((*m)->name, name) == 0) return *m;
    return NULL;
}

const bounce_kind *bounce_find(const char *name)
{
    for (const bounce_kind *const *b = bounces; *b; b++)
        if ((*b)->source & SEES_PICTURE && strcmp((*b)->name, name) == 0) return *b;
    return NULL;
}

bool variants_of_maker(int maker, const variant_row **rows)
{
    *rows = NULL;
    for (const method *const *m = methods; *m; m++)
        if (maker-- == 0) return *rows = (*m)->variants, true;
    for (const bounce_kind *const *b = bounces; *b; b++)
        if (maker-- == 0) return *rows = (*b)->variants, true;
    return false;
}

static void append(char *text, size_t size, const char *before, const char *name)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%s", used ? before : "", name);
}

void method_names(char *text, size_t size, unsigned product, const char *between, const char *last)
{
    const method *held = NULL; // its separator depends on what follows
    text[0] = '\0';
    for (const method *m = method_next(NULL, SEES_ANY); m; m = method_next(m, SEES_ANY)) {
        if ((m->makes & product) != product) continue;
        if (held) append(text, size, between, held->name);
        held = m;
    }
    if (held) append(text, size, last, held->name);
}

void bounce_names(char *text, size_t size, const char *between)
{
    text[0] = '\0';
    for (const bounce_kind *const *b = bounces; *b; b++)
        if ((*b)->source & SEES_PICTURE) append(text, size, between, (*b)->name);
}

// ---- tables

// A cell of a table: in mdoc a minus sign between spaces is one that can be copied.
static void print_cell(FILE *to, const char *text, const char *end)
{
    for (const char *p = text; *p; p++) fprintf(to, p > text && p[-1] == ' ' && *p == '-' && p[1] == ' ' ? "\\-" : "%c", *p);
    fputs(end, to);
}

void methods_print_man(FILE *to)
{
    fputs(".TS\nl lx lx lx.\nMethod\tWeighting\tReach\tCannot see\n_\n", to);
    for (const method *m = method_next(NULL, SEES_ANY); m; m = method_next(m, SEES_ANY)) {
        fprintf(to, "%s\tT{\n", m->name);
        print_cell(to, m->weighting, "\nT}\tT{\n");
        print_cell(to, m->reaches, "\nT}\tT{\n");
        print_cell(to, m->blind, "\nT}\n");
    }
    fputs(".TE\n", to);
}

void methods_print_markdown(FILE *to)
{
    fputs("| method | samples | light | choose it |\n| --- | --- | --- | --- |\n", to);
    for (const method *m = method_next(NULL, SEES_ANY); m; m = method_next(m, SEES_ANY))
        fprintf(to, "| `%s`%s | %d | %s | %s |\n", m->name, m == method_default() ? " (default)" : "", m->samples, m->light,
                m->choose);
}
