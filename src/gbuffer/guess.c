#include "gbuffer/guess.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "gbuffer/conventions.h"

bool guess_lone_depth(const layer_index *index, layer_group *out)
{
    int found = 0;
    for (int i = 0; i < index->count; i++) {
        const layer_entry *entry = &index->entries[i];
        if (strcmp(entry->component, "Z") != 0 || layers_has(index, entry, "X") || layers_has(index, entry, "Y")) continue;
        *out = (layer_group){.channels = {entry->ref}, .components = 1};
        found++;
    }
    return found == 1;
}

static bool is_separator(char c) { return strchr("._- ()[]", c) != NULL; }

// Any word of the file's name, or two words that follow each other ("world_position").
static bool file_says(role r, const char *path)
{
    const char *slash = strrchr(path, '/');
    char name[256];
    snprintf(name, sizeof name, "%s", slash ? slash + 1 : path);
    for (char *first = name; *first;) {
        while (*first && is_separator(*first)) first++;
        char *end = first;
        while (*end && !is_separator(*end)) end++;
        char *second = end + (*end != 0), *last = second;
        while (*last && !is_separator(*last)) last++;
        char word[256], joined[512];
        snprintf(word, sizeof word, "%.*s", (int)(end - first), first);
        snprintf(joined, sizeof joined, "%s%.*s", word, (int)(last - second), second);
        if (word[0] && (convention_knows(r, word) || convention_knows(r, joined))) return true;
        first = end;
    }
    return false;
}

bool guess_by_file_name(const layer_index *index, role r, layer_kind kind, layer_group *out)
{
    const exrio_file *file = index->file;
    if (file->part_count != 1 || file->member_count > 0 || index->count == 0 || !file_says(r, file->path)) return false;
    for (int i = 0; i < index->count; i++)
        if (!index->entries[i].bare && (index->count > 1 || index->entries[i].component[0])) return false; // it has layers
    const layer_entry *only = &index->entries[0];
    if (kind == LAYER_SCALAR && index->count == 1) {
        *out = (layer_group){.channels = {only->ref}, .components = 1};
        return true;
    }
    return layers_has(index, only, kind == LAYER_SCALAR ? "RGB" : "") && layers_exact(index, "", kind, out);
}
