#include "passes/variants.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The composite of a beauty, and the composite that is lit by us: its light, its background, the rest.
#define BEHIND(light, background)                                                                                                \
    "RELIGHT ALBEDO " light " " background " [COVERAGE] [INDIRECT] [EMISSION] [DIFFUSE] [DEPTHMASK] | "                          \
    "RELIGHT ALBEDO " light " " background " [COVERAGE] [INDIRECT] [EMISSION] [DIFFUSE] [DEPTHMASK] SPECULAR [MULTIPLY_ALL]"
#define RELIT(light) BEHIND(light, "BACKGROUND=0") " | " BEHIND(light, "BACKGROUND=1 BEAUTY") " | " BEHIND(light, "BACKGROUND=2")

// Of the passes that serve every method; the methods' rows name those of their own shaders.
static const variant_row shared[] = {
    {"blur",
     "SCALARS=0 COLOURS=1 | SCALARS=1 COLOURS=0 | SCALARS=1 COLOURS=1 | SCALARS=2 COLOURS=0 | SCALARS=2 COLOURS=1 | "
     "SCALARS=0 COLOURS=1 FITTED | SCALARS=0 COLOURS=2 FITTED | SCALARS=1 COLOURS=0 FITTED | SCALARS=1 COLOURS=1 FITTED | "
     "SCALARS=1 COLOURS=2 FITTED",
     true, false},
    {"composite",
     RELIT("RADIANCE") " | " RELIT(
         "VISIBILITY") " | "
                       "BEAUTY [DEPTHMASK] | BEAUTY ALBEDO INDIRECT [COVERAGE] [DEPTHMASK] | "
                       "BEAUTY ALBEDO SPLIT RADIANCE [DEPTHMASK] | BEAUTY ALBEDO SPLIT RADIANCE INDIRECT [COVERAGE] [DEPTHMASK]",
     true, true},
    {"confidence", "[FURTHER]", false, false},
    {"denoise", "ACROSS | [ERRORS]", true, false},
    {"downsample", "", true, false},
    {"depthmask", "ACROSS | DOWN", false, false},
    {"edges", "OCCLUSION [BENT] [VISIBILITY] [RADIANCE] [INDIRECT] | SH [BANDS3]", false, false},
    {"irradiance", "", false, false},
    {"lone_blur", "[VISIBILITY] [SCATTER]", false, false},
    {"mix", "[SCATTER] | COLOUR [SCATTER] | COLOUR LIGHT", false, false},
    {"tone", "", false, false},
    {"proxies", "OCCLUSION [VECTOR] [BENT] [VISIBILITY] [RADIANCE] | SH [BANDS3] | BOUNCE", false, false},
    {"root", "", true, false},
    {"specular", "", false, false},
    {"tile_error", "", false, false},
    {"upsample",
     "SCALARS=0 COLOURS=1 [OPEN_LIGHT] | SCALARS=0 COLOURS=2 [OPEN_LIGHT] | SCALARS=1 COLOURS=0 | SCALARS=1 COLOURS=1 "
     "[OPEN_LIGHT] | "
     "SCALARS=1 COLOURS=2 [OPEN_LIGHT] | SCALARS=2 COLOURS=0 | SCALARS=2 COLOURS=1 [OPEN_LIGHT] | SCALARS=2 COLOURS=2 "
     "[OPEN_LIGHT]",
     true, false},
    {0},
};

// The row `*i` of a list; takes the rows it has off `*i` if there is none.
static const variant_row *row_of(const variant_row *list, int *i)
{
    for (; list && list->program; list++)
        if ((*i)-- == 0) return list;
    return NULL;
}

const variant_row *variant_row_at(int i)
{
    const variant_row *row = row_of(shared, &i);
    const variant_row *own;
    for (int maker = 0; !row && variants_of_maker(maker, &own); maker++) row = row_of(own, &i);
    return row;
}

const variant_row *variant_find(const char *program, const char *words)
{
    const variant_row *row;
    for (int i = 0; (row = variant_row_at(i)); i++)
        if (strcmp(row->program, program) == 0 && variant_allowed(row, words)) return row;
    return NULL;
}

void variant_add(variant *v, bool wanted, const char *word)
{
    size_t n = strlen(v->words);
    if (wanted) snprintf(v->words + n, sizeof v->words - n, "%s%s", n ? " " : "", word);
}

void variant_number(variant *v, const char *word, int number)
{
    char text[64];
    snprintf(text, sizeof text, "%s=%d", word, number);
    variant_add(v, true, text);
}

// ---- patterns

enum { MOST_WORDS = 20 };

// One alternative of a pattern, word by word.
typedef struct alternative {
    char word[MOST_WORDS][32];
    bool optional[MOST_WORDS];
    int count;
} alternative;

// Reads up to the next bar; returns where to go on, NULL at the end.
static const char *next_alternative(const char *p, alternative *a)
{
    *a = (alternative){.count = 0};
    while (*p && *p != '|') {
        size_t n = strcspn(p, " |");
        if (n > 0 && a->count < MOST_WORDS) {
            bool optional = *p == '[';
            snprintf(a->word[a->count], sizeof *a->word, "%.*s", (int)n - (optional ? 2 : 0), p + (optional ? 1 : 0));
            a->optional[a->count++] = optional;
        }
        p += n;
        while (*p == ' ') p++;
    }
    return *p ? p + 1 + strspn(p + 1, " ") : NULL;
}

static int place_of(const alternative *a, const char *word, size_t n)
{
    for (int i = 0; i < a->count; i++)
        if (strlen(a->word[i]) == n && strncmp(a->word[i], word, n) == 0) return i;
    return -1;
}

static bool fits(const alternative *a, const char *words)
{
    bool there[MOST_WORDS] = {false};
    for (const char *p = words; *p; p += strspn(p, " ")) {
        size_t n = strcspn(p, " ");
        int place = place_of(a, p, n);
        if (place < 0) return false;
        there[place] = true;
        p += n;
    }
    for (int i = 0; i < a->count; i++)
        if (!a->optional[i] && !there[i]) return false;
    return true;
}

bool variant_allowed(const variant_row *row, const char *words)
{
    alternative a;
    for (const char *p = row->pattern; p;) {
        p = next_alternative(p, &a);
        if (fits(&a, words)) return true;
    }
    return false;
}

bool variant_defines(const char *words, char *out, size_t size)
{
    size_t at = 0;
    out[0] = 0;
    for (const char *p = words; *p; p += strspn(p, " ")) {
        size_t n = strcspn(p, " "), name = strcspn(p, "= ");
        int put = name < n ? snprintf(out + at, size - at, "%.*s %.*s\n", (int)name, p, (int)(n - name - 1), p + name + 1)
                           : snprintf(out + at, size - at, "%.*s 1\n", (int)n, p);
        if (put < 0 || (size_t)put >= size - at) return false;
        at += (size_t)put;
        p += n;
    }
    return true;
}

static bool each_camera(const variant *v, bool (*visit)(void *, const char *), void *context)
{
    variant other = *v;
    variant_add(&other, true, "ORTHOGRAPHIC");
    return visit(context, v->words) && visit(context, other.words);
}

bool variant_each(const variant_row *row, bool (*visit)(void *context, const char *words), void *context)
{
    alternative a;
    for (const char *p = row->pattern; p;) {
        p = next_alternative(p, &a);
        int optional = 0;
        for (int i = 0; i < a.count; i++) optional += a.optional[i];
        for (unsigned set = 0; set < 1u << optional; set++) {
            variant v = {{0}};
            for (int i = 0, k = 0; i < a.count; i++) {
                bool wanted = !a.optional[i] || (set >> k & 1u);
                k += a.optional[i];
                variant_add(&v, wanted, a.word[i]);
            }
            if (!each_camera(&v, visit, context)) return false;
        }
    }
    return true;
}
