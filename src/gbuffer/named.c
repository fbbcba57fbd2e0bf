#include "gbuffer/named.h"

#include <stdio.h>
#include <string.h>

enum { MOST_GROUPS = 64 };

// The view's own channels before those of no view, and the view layer's own before the others'.
static int prefer(const named_search *s, layer_group *found, int count)
{
    const exrio_file *file = s->index->file;
    for (int rule = 0; rule < 2 && count > 1; rule++) {
        layer_group kept[MOST_GROUPS];
        int n = 0;
        for (int i = 0; i < count; i++) {
            channel_ref ref = found[i].channels[0];
            const exrio_part *part = &file->parts[ref.part];
            bool own = rule ? strcmp(found[i].key, s->key) == 0
                            : s->options->view && ((part->view && part->view[0]) || part->channels[ref.channel].view);
            if (own) kept[n++] = found[i];
        }
        if (n > 0) memcpy(found, kept, (size_t)n * sizeof *kept), count = n;
    }
    return count;
}

typedef enum outcome { FOUND, NOT_FOUND, FAILED } outcome;

static outcome ambiguous(const named_search *s, const char *name, const char *flag, const layer_group *found, int count)
{
    char list[LAYERS_TEXT] = "", whole[600];
    size_t used = 0;
    for (int i = 0; i < count; i++) {
        layers_channel_name(s->index->file, found[i].channels[0], whole, sizeof whole);
        if (used + strlen(whole) + 3 < sizeof list)
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", used ? ", " : "", whole);
    }
    err_set(s->e, ERR_INPUT, s->index->file->path, name, "%s names several channels: %s; give one of these names", flag, list);
    return FAILED;
}

static outcome one_channel(const named_search *s, const char *name, const char *flag, channel_ref *out)
{
    layer_group found[MOST_GROUPS];
    int count = prefer(s, found, layers_channels(s->index, name, found, MOST_GROUPS));
    if (count > 1) return ambiguous(s, name, flag, found, count);
    if (count == 1) *out = found[0].channels[0];
    return count == 1 ? FOUND : NOT_FOUND;
}

// "a.X,b.Y,c.Z": channels by their names.
static outcome listed_channels(const named_search *s, const char *name, layer_kind kind, const char *flag, layer_group *out)
{
    char copy[LAYER_NAME], *rest = copy;
    snprintf(copy, sizeof copy, "%s", name);
    out->components = kind == LAYER_SCALAR ? 1 : 3;
    for (int c = 0; c < out->components; c++) {
        const char *token = strsep(&rest, ",");
        outcome o = token ? one_channel(s, token, flag, &out->channels[c]) : NOT_FOUND;
        if (o != FOUND) return o;
    }
    return rest == NULL ? FOUND : NOT_FOUND;
}

// The group of the view layer among those the name finds as a pattern does, or the only one there is.
static bool by_pattern(const named_search *s, const char *name, layer_kind kind, layer_group *out)
{
    layer_group groups[MOST_GROUPS];
    int n = layers_match(s->index, name, kind, groups, MOST_GROUPS);
    for (int g = 0; g < n; g++)
        if (strcmp(groups[g].key, s->key) == 0 || n == 1) {
            *out = groups[g];
            return true;
        }
    return false;
}

static bool fail_kind(const named_search *s, const char *name, const char *flag)
{
    return err_set(s->e, ERR_INPUT, s->index->file->path, name,
                   "%s needs a layer with the channels X Y Z or R G B (or three channel names with commas between)", flag);
}

// A name of another view's: which one.
static const char *other_view(const named_search *s, const char *name)
{
    layer_index all;
    layer_group found[1];
    error ignored = {0};
    const char *view = NULL;
    if (!s->options->view || !layers_index(s->index->file, NULL, &all, &ignored)) return NULL;
    if (layers_channels(&all, name, found, 1) || layers_exact(&all, name, LAYER_SCALAR, found)) {
        channel_ref ref = found[0].channels[0];
        const exrio_part *part = &s->index->file->parts[ref.part];
        view = part->view && part->view[0] ? part->view : part->channels[ref.channel].view;
    }
    layers_free(&all);
    return view;
}

bool named_find(const named_search *s, const char *name, layer_kind kind, const char *flag, layer_group *out)
{
    *out = (layer_group){0};
    outcome o = listed_channels(s, name, kind, flag, out);
    if (o != NOT_FOUND) return o == FOUND;
    if (layers_exact(s->index, name, kind, out) || by_pattern(s, name, kind, out)) return true;
    layer_group scalar;
    if (kind != LAYER_SCALAR &&
        (layers_channels(s->index, name, &scalar, 1) || layers_exact(s->index, name, LAYER_SCALAR, &scalar)))
        return fail_kind(s, name, flag);
    const char *path = s->index->file->path, *view = other_view(s, name);
    if (view)
        return err_set(s->e, ERR_INPUT, path, name,
                       "%s names a channel of the view '%s', and the view '%s' is filtered too; give the name that both have, or "
                       "filter one with --view-layer %s",
                       flag, view, s->options->view, view);
    char list[LAYERS_TEXT];
    layers_list(s->index, list, sizeof list);
    return err_set(s->e, ERR_INPUT, path, name, "%s names no layer or channel of the file, which has %s", flag, list);
}
