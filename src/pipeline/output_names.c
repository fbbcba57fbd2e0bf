#include "pipeline/output_names.h"

#include <stdio.h>
#include <string.h>

#include "pipeline/views.h"

naming naming_of(const job *j, const frame_result *r) { return (naming){j->o, r->file, r->view}; }

void layer_channel(const naming *n, const char *layer, char component, char *name)
{
    char plain[NAME_SIZE];
    snprintf(plain, sizeof plain, "%s%s.%c", n->o->prefix ? n->o->prefix : "", layer, component);
    view_name(n->file, n->view, plain, name, NAME_SIZE);
}

bool name_is_ours(const naming *n, const plan *p, const char *channel)
{
    char name[NAME_SIZE];
    for (int l = 0; l < LAYER_COUNT; l++)
        for (int k = 0; p->layers & 1u << l && layer_table[l]->channels[k]; k++) {
            layer_channel(n, layer_table[l]->name, layer_table[l]->channels[k], name);
            if (strcmp(name, channel) == 0) return true;
        }
    layer_channel(n, "composite", 'A', name);
    return p->layers & 1u << LAYER_COMPOSITE && strcmp(name, channel) == 0;
}

bool name_is_main(const naming *n, const char *channel)
{
    char name[NAME_SIZE];
    for (const char *c = "RGBA"; *c; c++) {
        view_name(n->file, n->view, (const char[]){*c, 0}, name, sizeof name);
        if (strcmp(name, channel) == 0) return true;
    }
    return false;
}

bool output_check_names(const options *o, const exrio_file *file, const char *view, const plan *p, error *e)
{
    const naming n = {o, file, view};
    if (o->main_composite && !(p->layers & 1u << LAYER_COMPOSITE))
        return err_set(
            e, ERR_INPUT, file->path, NULL,
            "--main composite needs the composite layer, which is not made here; add it to --layers, or leave out --main");
    for (int i = 0; !o->keep_none && i < file->part_count; i++)
        for (int c = 0; c < file->parts[i].channel_count && !file->parts[i].deep; c++)
            if (name_is_ours(&n, p, file->parts[i].channels[c].name) && !exrio_attr_exists(file, i, "ssdo/version"))
                return err_set(e, ERR_INPUT, file->path, file->parts[i].channels[c].name,
                               "the input already has a channel that we would write, and it is not ours; use --prefix to name "
                               "ours otherwise");
    return true;
}

// Nothing of the part is dropped or changed, so its chunks can be copied unseen.
bool output_keeps_chunks(const options *o, const exrio_file *file, int part, const plan *p)
{
    const exrio_part *in = &file->parts[part];
    if (in->deep) return true;
    if (!o->multipart || o->keep_none || o->compression != COMPRESS_AS_INPUT || !exrio_part_is_verbatim(in) || file->members)
        return false;
    for (int v = -1; v < in->view_count; v++) { // of any view, so that the answer is the same for each
        const naming n = {o, file, v < 0 ? NULL : in->views[v]};
        for (int c = 0; c < in->channel_count; c++)
            if (name_is_ours(&n, p, in->channels[c].name)) return false;
    }
    return true;
}

bool name_is_replaced(const job *j, const frame_result *r, const char *channel, bool merged)
{
    for (bool in_names = view_in_names(r->file, r->view); r; r = in_names ? r->next_view : NULL) {
        const naming n = naming_of(j, r);
        if (name_is_ours(&n, &r->plan, channel) || (merged && j->o->main_composite && name_is_main(&n, channel))) return true;
    }
    return false;
}

bool part_is_of_view(const exrio_part *part, const char *view) { return !part->deep && view_has(part, view); }

void part_name(const frame_result *r, char *name, size_t size)
{
    const char *view = view_in_names(r->file, r->view) ? NULL : r->view;
    snprintf(name, size, "ssdo%s%s", view ? "." : "", view ? view : "");
}

bool part_is_ours(const frame_result *r, int part)
{
    char name[64];
    part_name(r, name, sizeof name);
    return strcmp(r->file->parts[part].name, name) == 0 && exrio_attr_exists(r->file, part, "ssdo/version");
}

bool output_replaces(const job *j, const frame_result *r, int part, const char *channel)
{
    for (; r; r = r->next_view) {
        if (!part_is_of_view(&r->file->parts[part], r->view)) continue;
        if (name_is_replaced(j, r, channel, !r->second_part) || (r->second_part && part_is_ours(r, part))) return true;
    }
    return false;
}
