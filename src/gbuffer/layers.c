#include "gbuffer/layers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/mem.h"

// The component's letter, or "" when the text is no component's name.
static const char *component_of(const char *text)
{
    static const char *const names[][2] = {{"r", "R"},    {"g", "G"},     {"b", "B"}, {"a", "A"},   {"x", "X"},
                                           {"y", "Y"},    {"z", "Z"},     {"v", "V"}, {"red", "R"}, {"green", "G"},
                                           {"blue", "B"}, {"alpha", "A"}, {"t", "T"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcasecmp(text, names[i][0]) == 0) return names[i][1];
    return "";
}

// Cuts "left" or "right" off the layer's end: the view of a single-part stereo file comes second to last.
static void take_view(char *layer, char *view, size_t size)
{
    static const char *const views[] = {"left", "right"};
    char *dot = strrchr(layer, '.');
    for (size_t i = 0; i < 2; i++)
        if (strcasecmp(dot ? dot + 1 : layer, views[i]) == 0) {
            snprintf(view, size, "%s", views[i]);
            *(dot ? dot : layer) = 0;
            return;
        }
}

static bool starts_with_name(const char *layer, const char *name)
{
    size_t n = strlen(name);
    return strncasecmp(layer, name, n) == 0 && (layer[n] == 0 || layer[n] == '.');
}

// A part's name without the view that multi-part stereo files append to keep names distinct.
static void part_layer(const exr_part *part, char *buf, size_t size)
{
    snprintf(buf, size, "%s", part->name ? part->name : "");
    size_t n = strlen(buf), v = part->view ? strlen(part->view) : 0;
    if (v > 0 && n >= v && strcasecmp(buf + n - v, part->view) == 0 && (n == v || buf[n - v - 1] == '.'))
        buf[n == v ? 0 : n - v - 1] = 0;
}

static void fill(const exr_file *file, int p, int c, layer_entry *out)
{
    const exr_part *part = &file->parts[p];
    char name[256];
    exr_name_without_view(&part->channels[c], name, sizeof name);
    const char *dot = strrchr(name, '.');
    const char *component = component_of(dot ? dot + 1 : name);
    char own[256], prefix[256] = "";
    size_t length = component[0] ? (dot ? (size_t)(dot - name) : 0) : strlen(name);
    snprintf(own, sizeof own, "%.*s", (int)length, name);
    *out = (layer_entry){.ref = {p, c}};
    snprintf(out->component, sizeof out->component, "%s", component);
    if (part->view_count)
        snprintf(out->view, sizeof out->view, "%s", part->channels[c].view ? part->channels[c].view : "");
    else
        take_view(own, out->view, sizeof out->view);
    if (part->view && part->view[0]) snprintf(out->view, sizeof out->view, "%.31s", part->view);
    if (file->part_count > 1) part_layer(part, prefix, sizeof prefix);
    bool joined = prefix[0] && own[0] && !starts_with_name(own, prefix);
    if (joined)
        snprintf(out->layer, sizeof out->layer, "%s.%s", prefix, own);
    else
        snprintf(out->layer, sizeof out->layer, "%s", own[0] ? own : prefix);
}

// What the chosen view has itself stands before what is of no view; what is left is of none.
static void prefer_own(layer_index *index)
{
    int kept = 0;
    for (int i = 0; i < index->count; i++) {
        const layer_entry *entry = &index->entries[i];
        bool hidden = false;
        for (int k = 0; k < index->count && !entry->view[0] && !hidden; k++) {
            const layer_entry *other = &index->entries[k];
            hidden = other->view[0] && other->ref.part == entry->ref.part && strcmp(other->component, entry->component) == 0 &&
                     strcmp(other->layer, entry->layer) == 0;
        }
        if (!hidden) index->entries[kept++] = *entry;
    }
    index->count = kept;
    for (int i = 0; i < kept; i++) index->entries[i].view[0] = 0;
}

bool layers_index(const exr_file *file, const char *view, layer_index *out, error *e)
{
    int total = 0;
    for (int p = 0; p < file->part_count; p++) total += file->parts[p].channel_count;
    *out = (layer_index){.entries = mem_zero((size_t)total, sizeof *out->entries, e)};
    if (!out->entries) return false;
    for (int p = 0; p < file->part_count; p++)
        for (int c = 0; c < file->parts[p].channel_count; c++) {
            layer_entry *entry = &out->entries[out->count];
            fill(file, p, c, entry);
            if (view && entry->view[0] && strcmp(entry->view, view) != 0) continue;
            out->count++;
        }
    if (view) prefer_own(out);
    return true;
}

void layers_free(layer_index *index)
{
    free(index->entries);
    *index = (layer_index){0};
}

// Whether the entry's layer is `name` or ends in ".name"; *before receives the length of what stands before it.
static bool ends_in(const char *layer, const char *name, size_t *before, bool *exact)
{
    size_t n = strlen(name), l = strlen(layer);
    if (n > l || (n == 0 && l > 0)) return false;
    const char *tail = layer + l - n;
    if (strcasecmp(tail, name) != 0 || (l > n && tail[-1] != '.')) return false;
    *exact = strcmp(tail, name) == 0;
    *before = l > n ? l - n - 1 : 0;
    return true;
}

static void make_key(const layer_entry *entry, size_t before, char key[LAYER_KEY])
{
    const char *joint = before && entry->view[0] ? "." : "";
    snprintf(key, LAYER_KEY, "%.*s%s%s", (int)(before < 90 ? before : 90), entry->layer, joint, entry->view);
}

static bool same_layer(const layer_entry *a, const layer_entry *b)
{
    return a->ref.part == b->ref.part && strcmp(a->layer, b->layer) == 0 && strcmp(a->view, b->view) == 0;
}

static channel_ref find_component(const layer_index *index, const layer_entry *like, const char *component)
{
    for (int i = 0; i < index->count; i++)
        if (same_layer(&index->entries[i], like) && strcmp(index->entries[i].component, component) == 0)
            return index->entries[i].ref;
    return (channel_ref){-1, -1};
}

// The channels of the entry's layer: a full set of three, or the likeliest scalar. only: this component, or "".
static bool collect(const layer_index *index, const layer_entry *like, int components, const char *only, layer_group *out)
{
    static const char *const triples[2][3] = {{"X", "Y", "Z"}, {"R", "G", "B"}};
    static const char *const scalars[] = {"V", "Z", "X", "R", "", "Y", "T"};
    out->components = components;
    if (components == 3) {
        for (int s = 0; s < 2; s++) {
            bool all = true;
            for (int c = 0; c < 3; c++) {
                out->channels[c] = find_component(index, like, triples[s][c]);
                all = all && out->channels[c].part >= 0;
            }
            if (all) return true;
        }
        return false;
    }
    if (only[0]) {
        out->channels[0] = find_component(index, like, component_of(only));
        return out->channels[0].part >= 0;
    }
    for (size_t s = 0; s < sizeof scalars / sizeof *scalars; s++) {
        out->channels[0] = find_component(index, like, scalars[s]);
        if (out->channels[0].part >= 0) return true;
    }
    return false;
}

static bool first_of_layer(const layer_index *index, int i)
{
    for (int j = 0; j < i; j++)
        if (same_layer(&index->entries[j], &index->entries[i])) return false;
    return true;
}

int layers_match(const layer_index *index, const char *pattern, int components, layer_group *out, int most)
{
    char name[LAYER_KEY];
    const char *slash = strchr(pattern, '/');
    snprintf(name, sizeof name, "%.*s", (int)(slash ? slash - pattern : (long)strlen(pattern)), pattern);
    int found = 0;
    for (int i = 0; i < index->count && found < most; i++) {
        const layer_entry *entry = &index->entries[i];
        layer_group group = {0};
        size_t before = 0;
        bool any = strcmp(name, "*") == 0;
        if (any) before = 0, group.exact = true;
        if ((!any && !ends_in(entry->layer, name, &before, &group.exact)) || !first_of_layer(index, i)) continue;
        if (!collect(index, entry, components, slash ? slash + 1 : "", &group)) continue;
        make_key(entry, before, group.key);
        out[found++] = group;
    }
    return found;
}

bool layers_exact(const layer_index *index, const char *layer, int components, layer_group *out)
{
    for (int any_case = 0; any_case < 2; any_case++)
        for (int i = 0; i < index->count; i++) {
            const layer_entry *entry = &index->entries[i];
            char full[LAYER_NAME + 48];
            snprintf(full, sizeof full, "%s%s%s", entry->layer, entry->view[0] ? "." : "", entry->view);
            int (*compare)(const char *, const char *) = any_case ? strcasecmp : strcmp;
            if (compare(entry->layer, layer) != 0 && compare(full, layer) != 0) continue;
            *out = (layer_group){0};
            if (collect(index, entry, components, "", out)) return true;
        }
    return false;
}

channel_ref layers_sibling(const layer_index *index, channel_ref of, const char *component)
{
    for (int i = 0; i < index->count; i++)
        if (index->entries[i].ref.part == of.part && index->entries[i].ref.channel == of.channel)
            return find_component(index, &index->entries[i], component);
    return (channel_ref){-1, -1};
}

void layers_list(const layer_index *index, char *buf, size_t size)
{
    size_t used = 0;
    buf[0] = 0;
    for (int i = 0; i < index->count; i++) {
        if (!first_of_layer(index, i)) continue;
        const layer_entry *entry = &index->entries[i];
        const char *name = entry->layer[0] ? entry->layer : entry->component;
        size_t need = strlen(name) + 2;
        if (used + need + 4 >= size) {
            snprintf(buf + used, size - used, " ...");
            return;
        }
        used += (size_t)snprintf(buf + used, size - used, "%s%s", used ? ", " : "", name);
    }
}
