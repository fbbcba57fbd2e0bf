#include "gbuffer/layers.h"

#include <ctype.h>
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
    char plain[16];
    size_t n = strlen(text);
    if (n > 2 && n < sizeof plain && text[0] == '[' && text[n - 1] == ']') { // "[red]"
        snprintf(plain, sizeof plain, "%.*s", (int)(n - 2), text + 1);
        text = plain;
    }
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

// What writers put between the words of one name.
static bool is_joint(char c) { return c == '_' || c == '-' || c == ' '; }

static bool starts_with_name(const char *layer, const char *name)
{
    size_t n = strlen(name);
    return strncasecmp(layer, name, n) == 0 && (layer[n] == 0 || layer[n] == '.');
}

// Cuts the view's word off the end of a part's name, or off its beginning: "depth_left", "depth.left", "left.depth".
static bool cut_view(char *name, const char *view)
{
    size_t n = strlen(name), v = strlen(view);
    if (v == 0 || n < v) return false;
    char *tail = name + n - v;
    if (strcasecmp(tail, view) == 0 && (n == v || tail[-1] == '.' || is_joint(tail[-1]))) {
        *(n == v ? name : tail - 1) = 0;
        return true;
    }
    if (n == v || strncasecmp(name, view, v) != 0 || !(name[v] == '.' || is_joint(name[v]))) return false;
    memmove(name, name + v + 1, n - v);
    return true;
}

static bool has_part(const exrio_file *file, const char *name)
{
    for (int p = 0; p < file->part_count; p++)
        if (file->parts[p].name && strcasecmp(file->parts[p].name, name) == 0) return true;
    return false;
}

// The layer that a part is, without the view that multi-part stereo files append to keep names distinct. view receives the one
// that a name alone tells: of two parts of one layer, "depth_left" and "depth_right".
static void part_layer(const exrio_file *file, const exrio_part *part, char *name, char *view, size_t view_size)
{
    static const char *const sides[] = {"left", "right"};
    snprintf(name, 256, "%s", part->name ? part->name : "");
    view[0] = 0;
    if (part->view && part->view[0]) {
        cut_view(name, part->view);
        return;
    }
    cut_view(name, "main"); // Nuke's only view
    for (int i = 0; i < 2; i++) {
        char cut[256], twin[300];
        snprintf(cut, sizeof cut, "%s", name);
        if (!cut_view(cut, sides[i])) continue;
        size_t n = strlen(cut);
        bool behind = strncasecmp(name, cut, n) == 0 && n > 0;
        if (behind)
            snprintf(twin, sizeof twin, "%s%c%s", cut, name[n], sides[1 - i]);
        else if (n > 0)
            snprintf(twin, sizeof twin, "%s%c%s", sides[1 - i], name[strlen(sides[i])], cut);
        else
            snprintf(twin, sizeof twin, "%s", sides[1 - i]);
        if (!has_part(file, twin)) continue;
        snprintf(name, 256, "%s", cut);
        snprintf(view, view_size, "%s", sides[i]);
        return;
    }
}

static void fill(const exrio_file *file, int p, int c, layer_entry *out)
{
    const exrio_part *part = &file->parts[p];
    char name[256];
    exrio_name_without_view(&part->channels[c], name, sizeof name);
    const char *dot = strrchr(name, '.');
    const char *component = component_of(dot ? dot + 1 : name);
    char own[256], prefix[256] = "", part_view[32] = "";
    size_t length = component[0] ? (dot ? (size_t)(dot - name) : 0) : strlen(name);
    snprintf(own, sizeof own, "%.*s", (int)length, name);
    *out = (layer_entry){.ref = {p, c}};
    snprintf(out->component, sizeof out->component, "%s", component);
    if (part->view_count)
        snprintf(out->view, sizeof out->view, "%s", part->channels[c].view ? part->channels[c].view : "");
    else
        take_view(own, out->view, sizeof out->view);
    if (file->part_count > 1) part_layer(file, part, prefix, part_view, sizeof part_view);
    if (part->view && part->view[0])
        snprintf(out->view, sizeof out->view, "%.31s", part->view);
    else if (part_view[0])
        snprintf(out->view, sizeof out->view, "%s", part_view);
    out->bare = !own[0];
    bool joined = prefix[0] && own[0] && !starts_with_name(own, prefix);
    if (joined)
        snprintf(out->layer, sizeof out->layer, "%s.%s", prefix, own);
    else
        snprintf(out->layer, sizeof out->layer, "%s", own[0] ? own : prefix);
}

// Drops a channel of no view where the chosen view has that channel itself. Then clears all views.
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

bool layers_index(const exrio_file *file, const char *view, layer_index *out, error *e)
{
    int total = 0;
    for (int p = 0; p < file->part_count; p++) total += file->parts[p].channel_count;
    *out = (layer_index){.file = file, .entries = mem_zero((size_t)total, sizeof *out->entries, e)};
    if (!out->entries) return false;
    for (int p = 0; p < file->part_count; p++)
        for (int c = 0; c < file->parts[p].channel_count && !file->parts[p].deep; c++) {
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

// Whether the layer is `name` or ends in ".name" (or ":name"), whatever its case and whatever joins its words; *before receives
// the length of what stands before it.
static bool ends_in(const char *layer, const char *name, size_t *before, bool *exact)
{
    const char *l = layer + strlen(layer), *n = name + strlen(name);
    *before = 0, *exact = true;
    if (n == name) return l == layer;
    for (;; l--, n--) {
        while (l > layer && is_joint(l[-1])) l--;
        while (n > name && is_joint(n[-1])) n--;
        if (n == name) break;
        if (l == layer || tolower((unsigned char)l[-1]) != tolower((unsigned char)n[-1])) return false;
    }
    if (l > layer && l[-1] != '.' && l[-1] != ':') return false;
    *exact = strcmp(l, name) == 0;
    *before = l > layer ? (size_t)(l - layer) - 1 : 0;
    return true;
}

bool layers_name_is(const char *text, const char *name)
{
    size_t before;
    bool exact;
    return ends_in(text, name, &before, &exact) && before == 0;
}

static bool matches(const layer_entry *entry, const char *name, size_t *before, bool *exact)
{
    *before = 0, *exact = true;
    if (strcmp(name, "*") == 0) return true;
    if (name[0] || entry->picture == PICTURE_NO) return ends_in(entry->layer, name, before, exact);
    if (entry->picture == PICTURE_OF_SEVERAL) *before = strlen(entry->layer);
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

bool layers_has(const layer_index *index, const layer_entry *like, const char *components)
{
    for (const char *c = components; *c; c++)
        if (find_component(index, like, (const char[]){*c, 0}).part < 0) return false;
    return true;
}

static bool collect_three(const layer_index *index, const layer_entry *like, layer_kind kind, layer_group *out)
{
    // The nameless X, Y and Z are no R, G and B: positions, or a picture in CIE's colour space.
    const char *sets[2] = {kind == LAYER_COLOUR ? "RGB" : "XYZ", kind == LAYER_VECTOR ? "RGB" : like->layer[0] ? "XYZ" : NULL};
    for (int s = 0; s < 2 && sets[s]; s++) {
        if (!layers_has(index, like, sets[s])) continue;
        for (int c = 0; c < 3; c++) out->channels[c] = find_component(index, like, (const char[]){sets[s][c], 0});
        return true;
    }
    return false;
}

// The channels of the entry's layer: a full set of three, or the likeliest scalar. only: this component, or "".
static bool collect(const layer_index *index, const layer_entry *like, layer_kind kind, const char *only, layer_group *out)
{
    static const char *const scalars[] = {"V", "Z", "X", "R", "", "Y", "T"};
    out->components = kind == LAYER_SCALAR ? 1 : 3;
    if (kind != LAYER_SCALAR) return collect_three(index, like, kind, out);
    if (only[0]) {
        // Beside X and Y, Z is a vector's, and no depth.
        if (like->bare && strcasecmp(only, "Z") == 0 && layers_has(index, like, "XY")) return false;
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

int layers_match(const layer_index *index, const char *pattern, layer_kind kind, layer_group *out, int most)
{
    char name[LAYER_KEY];
    const char *slash = strchr(pattern, '/');
    snprintf(name, sizeof name, "%.*s", (int)(slash ? slash - pattern : (long)strlen(pattern)), pattern);
    int found = 0;
    for (int i = 0; i < index->count && found < most; i++) {
        const layer_entry *entry = &index->entries[i];
        layer_group group = {0};
        size_t before = 0;
        if (!matches(entry, name, &before, &group.exact) || !first_of_layer(index, i)) continue;
        if (!collect(index, entry, kind, slash ? slash + 1 : "", &group)) continue;
        make_key(entry, before, group.key);
        out[found++] = group;
    }
    return found;
}

// The entry's layer as the command line may call it: by its name, with its view, by the part's name as the file has it.
static bool is_called(const layer_index *index, const layer_entry *entry, const char *layer, bool any_case)
{
    int (*compare)(const char *, const char *) = any_case ? strcasecmp : strcmp;
    char full[LAYER_NAME + 48];
    snprintf(full, sizeof full, "%s%s%s", entry->layer, entry->view[0] ? "." : "", entry->view);
    if (compare(entry->layer, layer) == 0 || compare(full, layer) == 0) return true;
    const char *part = index->file->parts[entry->ref.part].name;
    return entry->bare && part && part[0] && compare(part, layer) == 0;
}

bool layers_exact(const layer_index *index, const char *layer, layer_kind kind, layer_group *out)
{
    for (int any_case = 0; any_case < 2; any_case++)
        for (int i = 0; i < index->count; i++) {
            const layer_entry *entry = &index->entries[i];
            if (!is_called(index, entry, layer, any_case)) continue;
            *out = (layer_group){0};
            make_key(entry, 0, out->key);
            if (collect(index, entry, kind, "", out)) return true;
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

void layers_channel_name(const exrio_file *file, channel_ref ref, char *buf, size_t size)
{
    const exrio_part *part = &file->parts[ref.part];
    const char *name = part->channels[ref.channel].name, *own = part->name ? part->name : "";
    bool with_part = file->part_count > 1 && own[0] && !starts_with_name(name, own);
    snprintf(buf, size, "%s%s%s", with_part ? own : "", with_part ? "." : "", name);
}

// The channel's name is `name`: as the file has it, without the view, or behind the part's name.
static bool is_channel(const layer_index *index, channel_ref ref, const char *name, bool any_case)
{
    int (*compare)(const char *, const char *) = any_case ? strcasecmp : strcmp;
    const exrio_channel *c = &index->file->parts[ref.part].channels[ref.channel];
    const char *part = index->file->parts[ref.part].name;
    char other[EXRIO_NAME_ROOM * 2];
    if (compare(c->name, name) == 0 || (c->stored && compare(c->stored, name) == 0)) return true;
    exrio_name_without_view(c, other, sizeof other);
    if (compare(other, name) == 0) return true;
    snprintf(other, sizeof other, "%s.%s", part ? part : "", c->name);
    return part && part[0] && compare(other, name) == 0;
}

int layers_channels(const layer_index *index, const char *name, layer_group *out, int most)
{
    int found = 0;
    for (int any_case = 0; any_case < 2 && found == 0; any_case++)
        for (int i = 0; i < index->count && found < most; i++) {
            const layer_entry *entry = &index->entries[i];
            if (!is_channel(index, entry->ref, name, any_case)) continue;
            out[found] = (layer_group){.channels = {entry->ref}, .components = 1};
            make_key(entry, strlen(entry->layer), out[found].key);
            found++;
        }
    return found;
}

// Appends ", text" to a list of `used` bytes; *more counts what no longer fits.
static void append(char *buf, size_t size, size_t *used, int *more, const char *text)
{
    enum { TAIL = 24 }; // " and 1234 more"
    if (*more || *used + strlen(text) + TAIL >= size)
        ++*more;
    else
        *used += (size_t)snprintf(buf + *used, size - *used, "%s%s", *used ? ", " : "", text);
}

// "R G B A", of those components that the layer has.
static void list_components(const layer_index *index, const layer_entry *like, const char *components, char out[16])
{
    size_t used = 0;
    out[0] = 0;
    for (const char *c = components; *c; c++)
        if (find_component(index, like, (const char[]){*c, 0}).part >= 0)
            used += (size_t)snprintf(out + used, 16 - used, "%s%c", used ? " " : "", *c);
}

static void list_nameless(const layer_index *index, char *buf, size_t size, size_t *used, int *more)
{
    for (int i = 0; i < index->count; i++) {
        const layer_entry *entry = &index->entries[i];
        char colours[16];
        if (entry->layer[0]) continue;
        list_components(index, entry, "RGBA", colours);
        if (!entry->component[0] || !strchr("RGBA", entry->component[0]))
            append(buf, size, used, more, entry->component);
        else if (entry->component[0] == colours[strlen(colours) - 1])
            append(buf, size, used, more, colours);
    }
}

void layers_list(const layer_index *index, char *buf, size_t size)
{
    size_t used = 0;
    int more = 0;
    buf[0] = 0;
    list_nameless(index, buf, size, &used, &more);
    for (int i = 0; i < index->count; i++) {
        const layer_entry *entry = &index->entries[i];
        char name[LAYER_NAME + 16], colours[16];
        if (!entry->layer[0]) continue;
        if (first_of_layer(index, i)) append(buf, size, &used, &more, entry->layer);
        // A layer's name stands for its colour or its vector; what a colour has beside it is named too.
        list_components(index, entry, "RGBA", colours);
        if (!colours[0] || !entry->component[0] || strchr("RGBA", entry->component[0])) continue;
        snprintf(name, sizeof name, "%s.%s", entry->layer, entry->component);
        append(buf, size, &used, &more, name);
    }
    if (more) snprintf(buf + used, size - used, " and %d more", more);
}
