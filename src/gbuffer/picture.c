#include "gbuffer/picture.h"

#include <string.h>
#include <strings.h>

#include "gbuffer/conventions.h"

// Passes that hold four channels and are no picture, besides those that the convention table knows. Beginnings of names.
static const char *const other_passes[] = {"crypto", "ao",     "ambient", "occlusion", "shadow",   "spec",   "refl",
                                           "refr",   "uv",     "motion",  "velocity",  "vector",   "id",     "mask",
                                           "matte",  "object", "light",   "diff",      "indirect", "normal", "sss"};

static bool other_pass(const char *layer)
{
    for (size_t i = 0; i < sizeof other_passes / sizeof *other_passes; i++)
        if (strncasecmp(layer, other_passes[i], strlen(other_passes[i])) == 0) return true;
    for (int r = 0; r < ROLE_COUNT; r++)
        if (r != ROLE_BEAUTY && r != ROLE_ALPHA && convention_knows((role)r, layer)) return true;
    return false;
}

// The first entry of each layer that is a part's bare channels, has these components, and is no other pass by its name.
static bool is_candidate(const layer_index *index, int i, const char *components)
{
    const layer_entry *entry = &index->entries[i];
    if (!entry->bare || !entry->layer[0] || strcmp(entry->component, "R") != 0) return false;
    return layers_has(index, entry, components) && !layers_has(index, entry, "XYZ") && !other_pass(entry->layer);
}

static bool same_view(const layer_index *index, int i, int k)
{
    return strcmp(index->entries[i].view, index->entries[k].view) == 0;
}

// The candidates of one view; *first: the first of them.
static int candidates(const layer_index *index, int view, const char *components, int *first)
{
    int count = 0;
    for (int i = 0; i < index->count; i++)
        if (is_candidate(index, i, components) && same_view(index, i, view) && count++ == 0) *first = i;
    return count;
}

static void mark(layer_index *index, int like, picture_kind kind)
{
    const layer_entry *of = &index->entries[like];
    for (int i = 0; i < index->count; i++) {
        layer_entry *entry = &index->entries[i];
        if (entry->bare && entry->ref.part == of->ref.part && strcmp(entry->layer, of->layer) == 0) entry->picture = kind;
    }
}

static void mark_view(layer_index *index, int view)
{
    int first = -1;
    for (int i = 0; i < index->count; i++)
        if (is_candidate(index, i, "RGB") && same_view(index, i, view) &&
            convention_knows(ROLE_BEAUTY, index->entries[i].layer)) {
            if (layers_has(index, &index->entries[i], "Z")) mark(index, i, PICTURE_ONLY);
            return;
        }
    int depths = candidates(index, view, "RGBZ", &first);
    if (depths == 1 || (depths == 0 && candidates(index, view, "RGBA", &first) > 0)) mark(index, first, PICTURE_ONLY);
    for (int i = 0; depths > 1 && i < index->count; i++)
        if (is_candidate(index, i, "RGBZ") && same_view(index, i, view)) mark(index, i, PICTURE_OF_SEVERAL);
}

void picture_mark(layer_index *index)
{
    for (int i = 0; i < index->count; i++) {
        bool seen = false;
        for (int k = 0; k < i && !seen; k++) seen = same_view(index, i, k);
        if (!seen) mark_view(index, i);
    }
}
