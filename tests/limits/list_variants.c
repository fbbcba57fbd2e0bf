// Every shader program that a pass can ask for (passes/variants.h), for tools that read GLSL without a device.
//
//   list_variants files DIR image|texture   each variant's whole source in a file of its own, DIR/<program>.<n>.comp or .frag
//   list_variants stream                    all of them, as a device with GL's minimum limits gets them, in one text for a C
//                                           preprocessor: a line "@variant NAME" before each, its own macros undefined after it
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu/gpu.h"
#include "passes/variants.h"

typedef struct listing {
    const variant_row *row;
    const char *folder; // NULL: the stream
    gpu_habits habits;
    bool drawn;
    int count;
} listing;

// The names that the text defines, each with an #undef.
static void undefine(const char *text)
{
    for (const char *p = text; (p = strstr(p, "#define ")); p++) printf("#undef %.*s\n", (int)strcspn(p + 8, " (\n"), p + 8);
}

static bool put(listing *l, const char *words, const char *text)
{
    if (!l->folder) {
        const char *body = strchr(text, '\n'); // the first line is #version
        printf("@variant %s%s %s\n%s\n", l->row->program, l->drawn ? " drawn" : "", words, body ? body : "");
        undefine(text);
        return true;
    }
    char path[1024];
    snprintf(path, sizeof path, "%s/%s.%d.%s", l->folder, l->row->program, l->count, l->drawn ? "frag" : "comp");
    FILE *f = fopen(path, "w");
    bool ok = f && fprintf(f, "%s\n// %s\n", text, words) > 0;
    if (f) ok = fclose(f) == 0 && ok;
    return ok;
}

static bool visit(void *context, const char *words)
{
    listing *l = context;
    char file[64], defines[2 * VARIANT_TEXT];
    error e = {0};
    snprintf(file, sizeof file, "%s.comp", l->row->program);
    if (!variant_defines(words, defines, sizeof defines)) return false;
    char *text = gpu_program_source(l->habits, file, defines, l->drawn, &e);
    bool ok = text && put(l, words, text);
    if (!ok) fprintf(stderr, "list_variants: %s %s: %s\n", file, words, e.message);
    free(text);
    l->count++;
    return ok;
}

int main(int argc, char **argv)
{
    listing l = {.folder = argc == 4 && strcmp(argv[1], "files") == 0 ? argv[2] : NULL};
    if (!l.folder && !(argc == 2 && strcmp(argv[1], "stream") == 0)) return 2;
    l.habits.read_images = l.folder && strcmp(argv[3], "image") == 0;
    for (int i = 0; (l.row = variant_row_at(i)); i++) {
        for (int drawn = 0; drawn <= l.row->drawable; drawn++) {
            l.drawn = drawn;
            if (!variant_each(l.row, visit, &l)) return 1;
        }
    }
    fprintf(stderr, "%d\n", l.count);
    return 0;
}
