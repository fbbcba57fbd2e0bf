#include "pipeline/output.h"

#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "pipeline/output_view.h"
#include "pipeline/verify.h"
#include "pipeline/views.h"

// All of it.
typedef struct book {
    assembly *views[VIEWS_MAX]; // owned
    int view_count;
    exrio_out_part *parts;
    int part_count;
    exrio_source *sources; // of attributes, of a merged part; as many as the file has parts for each view
    int source_count;
    char record[RECORD_TEXT + 1]; // "" for none
    exrio_out_attr first_record;  // of the file's first part, where that is not one of ours
    exrio_out_part *shared;       // of views that names tell: the part that has the first one's layers, and so the others'
} book;

static int compression_of(const options *o, const exrio_part *part)
{
    static const exr_compression_t values[] = {[COMPRESS_NONE] = EXR_COMPRESSION_NONE,
                                               [COMPRESS_RLE] = EXR_COMPRESSION_RLE,
                                               [COMPRESS_ZIPS] = EXR_COMPRESSION_ZIPS,
                                               [COMPRESS_ZIP] = EXR_COMPRESSION_ZIP,
                                               [COMPRESS_PIZ] = EXR_COMPRESSION_PIZ};
    if (o->compression != COMPRESS_AS_INPUT) return (int)values[o->compression];
    // Not every OpenEXR can write those that came after PIZ, and what they lose must not be lost twice.
    return part->compression > (int)EXR_COMPRESSION_PIZ ? EXR_COMPRESSION_ZIP : part->compression;
}

// The input's channels of one part that are passed through, appended to out.
static int keep_channels(const job *j, const frame_result *r, const exrio_part *part, bool merged, exrio_out_channel *out)
{
    int n = 0;
    for (int c = 0; c < part->channel_count; c++)
        if (!name_is_replaced(j, r, part->channels[c].name, merged))
            out[n++] = (exrio_out_channel){part->channels[c].name, part->channels[c].type, part->channels[c].data};
    return n;
}

static bool share_a_name(const exrio_part *a, const exrio_part *b)
{
    for (int i = 0; i < a->channel_count; i++)
        for (int k = 0; k < b->channel_count; k++)
            if (strcmp(a->channels[i].name, b->channels[k].name) == 0) return true;
    return false;
}

// A part's name is the layer of its X, Y and Z, which would be lost.
static bool is_bare_vector(const exrio_part *p)
{
    bool bare = false;
    for (int c = 0; c < p->channel_count; c++) bare = bare || strcmp(p->channels[c].name, "X") == 0;
    return bare && p->name[0];
}

// The view's parts have the same windows and distinct channel names.
static bool can_merge(const exrio_file *f, const char *view)
{
    for (int i = 1; i < f->part_count; i++)
        if (part_is_of_view(&f->parts[i], view) && is_bare_vector(&f->parts[i])) return false;
    for (int i = 0; i < f->part_count; i++)
        for (int k = 0; k < i && part_is_of_view(&f->parts[i], view); k++) {
            const exrio_part *a = &f->parts[i], *b = &f->parts[k];
            if (!part_is_of_view(b, view)) continue;
            if (!box2_equal(a->data_window, b->data_window) || !box2_equal(a->display_window, b->display_window) ||
                share_a_name(a, b))
                return false;
        }
    return true;
}

static exrio_out_part part_like(const options *o, const exrio_file *f, int index)
{
    const exrio_part *p = &f->parts[index];
    const exrio_file *from = exrio_part_file(f, &index);
    return (exrio_out_part){.name = p->name,
                            .view = p->view,
                            .data_window = p->data_window,
                            .display_window = p->display_window,
                            .pixel_aspect = p->pixel_aspect,
                            .compression = compression_of(o, p),
                            .attributes_from = from,
                            .attributes_part = index};
}

static bool make_channels(exrio_out_part *part, int count, error *e)
{
    part->channels = mem_zero((size_t)count, sizeof *part->channels, e);
    return part->channels != NULL;
}

static int total_channels(const exrio_file *f)
{
    int n = 0;
    for (int i = 0; i < f->part_count; i++) n += f->parts[i].channel_count;
    return n;
}

static int view_count(const frame_result *r)
{
    int n = 0;
    for (; r; r = r->next_view) n++;
    return n;
}

// Our channels go to the end of the last part.
static void append_ours(assembly *a, exrio_out_part *part)
{
    for (int i = 0; i < a->our_count; i++) part->channels[part->channel_count++] = a->ours[i];
    part->attributes = a->attrs;
    part->attribute_count = a->attr_count;
}

// A further view in the part that has the first one's: only the camera is its own.
static void append_view(book *k, assembly *a, const frame_result *r)
{
    assembly *first = k->views[0];
    for (int i = 0; i < a->our_count; i++) k->shared->channels[k->shared->channel_count++] = a->ours[i];
    snprintf(a->camera_name, sizeof a->camera_name, "ssdo/camera.%s", r->view);
    view_add_attribute(first, a->camera_name, EXRIO_OUT_STRING)->string = a->camera;
    k->shared->attribute_count = first->attr_count;
}

// What the view's other parts say besides: cryptomatte manifests, the camera, filters.
static void add_sources(book *k, exrio_out_part *part, const frame_result *r)
{
    exrio_source *first = k->sources + k->source_count;
    for (int i = 0; i < r->file->part_count; i++) {
        int index = i;
        const exrio_file *from = exrio_part_file(r->file, &index);
        if (i != r->resolution.main_part && part_is_of_view(&r->file->parts[i], r->view))
            k->sources[k->source_count++] = (exrio_source){from, index};
    }
    part->also = first;
    part->also_count = (int)(k->sources + k->source_count - first);
}

static bool has_deep(const exrio_file *f)
{
    for (int i = 0; i < f->part_count; i++)
        if (f->parts[i].deep) return true;
    return false;
}

// The view's parts and our layers as one.
static bool merge_parts(book *k, assembly *a, const job *j, const frame_result *r, error *e)
{
    const exrio_file *f = r->file;
    const char *view = view_in_names(f, r->view) ? NULL : r->view;
    exrio_out_part *only = k->shared = &k->parts[k->part_count++];
    *only = part_like(j->o, f, r->resolution.main_part);
    if (f->part_count > 1 && !view && !has_deep(f)) only->name = only->view = NULL;
    if (view) only->view = view;
    if (view && !only->name[0]) only->name = view;
    if (has_deep(f) && !only->name[0]) only->name = "input"; // parts of a multi-part file need names
    if (!make_channels(only, total_channels(f) + MAX_OURS * view_count(r), e)) return false;
    add_sources(k, only, r);
    for (int i = 0; !j->o->keep_none && i < f->part_count; i++)
        if (part_is_of_view(&f->parts[i], r->view))
            only->channel_count += keep_channels(j, r, &f->parts[i], true, only->channels + only->channel_count);
    append_ours(a, only);
    return true;
}

static bool keep_part(book *k, const job *j, const frame_result *r, int i, error *e)
{
    const exrio_file *f = r->file;
    exrio_out_part *part = &k->parts[k->part_count++];
    *part = part_like(j->o, f, i);
    if (output_keeps_chunks(j->o, f, i, &r->plan)) part->compression = f->parts[i].compression;
    if (!make_channels(part, f->parts[i].channel_count, e)) return false;
    part->channel_count = keep_channels(j, r, &f->parts[i], false, part->channels);
    part->verbatim = output_keeps_chunks(j->o, f, i, &r->plan);
    part->deep = f->parts[i].deep;
    if (!part->name[0]) part->name = "input"; // parts of a multi-part file need names
    return true;
}

// The view's parts as they are, and one with our layers: "ssdo", or "ssdo.left".
static bool add_part(book *k, assembly *a, const job *j, frame_result *r, error *e)
{
    const exrio_file *f = r->file;
    const char *view = view_in_names(f, r->view) ? NULL : r->view;
    part_name(r, a->part_name, sizeof a->part_name);
    for (int i = 0; i < f->part_count; i++) {
        if (part_is_of_view(&f->parts[i], r->view) && !part_is_ours(r, i) && !keep_part(k, j, r, i, e)) return false;
    }
    exrio_out_part *mine = k->shared = &k->parts[k->part_count++];
    *mine = part_like(j->o, f, r->resolution.main_part);
    mine->name = a->part_name;
    if (view) mine->view = view;
    mine->attributes_from = NULL;
    if (!make_channels(mine, MAX_OURS * view_count(r), e)) return false;
    append_ours(a, mine);
    r->second_part = true;
    if (!j->o->multipart)
        log_warn(j->log, "second-part",
                 "%s: its parts differ in window or share channel names, so our layers go into a part named '%s'", f->path,
                 a->part_name);
    return true;
}

static bool is_filtered(const exrio_part *part, const frame_result *first)
{
    for (; first; first = first->next_view)
        if (part_is_of_view(part, first->view)) return true;
    return false;
}

// Parts of no view that was filtered, and deep ones.
static bool keep_others(book *k, const job *j, const frame_result *first, error *e)
{
    for (int i = 0; !j->o->keep_none && i < first->file->part_count; i++) {
        if (is_filtered(&first->file->parts[i], first)) continue;
        const exrio_part *part = &first->file->parts[i];
        if (part->deep && part->tiled)
            log_warn(j->log, "deep-tiles", "%s: the deep part '%s' is left out: deep tiles cannot be copied (deep scanlines can)",
                     first->file->path, part->name);
        else if (!keep_part(k, j, first, i, e))
            return false;
    }
    return true;
}

static bool add_view(book *k, const job *j, frame_result *r, bool recorded, error *e)
{
    assembly *a = k->views[k->view_count] = mem_zero(1, sizeof *a, e);
    if (!a) return false;
    k->view_count++;
    view_add_layers(a, j, r);
    const naming n = naming_of(j, r);
    if (j->o->main_composite) view_add_main(a, &n);
    if (!view_add_attributes(a, j, r, e)) return false;
    if (recorded) view_add_attribute(a, RECORD_NAME, EXRIO_OUT_STRING)->string = k->record;
    if (k->shared && view_in_names(r->file, r->view)) {
        append_view(k, a, r);
        return true;
    }
    bool merge = j->o->keep_none || (!j->o->multipart && can_merge(r->file, r->view));
    return merge ? merge_parts(k, a, j, r, e) : add_part(k, a, j, r, e);
}

static void free_book(book *k)
{
    for (int v = 0; v < k->view_count; v++) {
        free(k->views[v]->args);
        free(k->views[v]);
    }
    for (int i = 0; i < k->part_count; i++) free(k->parts[i].channels);
    free(k->parts);
    free(k->sources);
}

// In every part of ours and in the first part, where a stale one may lie.
static void put_record(book *k, const frame_result *r)
{
    if (!r->record.made) return;
    record_format(&r->record, record_layout(k->parts, k->part_count), k->record);
    if (k->parts[0].attribute_count) return;
    k->first_record = (exrio_out_attr){.name = RECORD_NAME, .kind = EXRIO_OUT_STRING, .string = k->record};
    k->parts[0].attributes = &k->first_record;
    k->parts[0].attribute_count = 1;
}

typedef struct inspection {
    const job *j;
    const frame_result *r;
    const char *path;
} inspection;

static bool look_again(const void *context, const char *written, error *e)
{
    const inspection *i = context;
    return verify_written(i->j, i->r, written, i->path, e);
}

bool output_write(const job *j, frame_result *r, const char *path, error *e)
{
    book k = {.parts = mem_zero((size_t)r->file->part_count + VIEWS_MAX, sizeof *k.parts, e)};
    k.sources = k.parts ? mem_zero((size_t)r->file->part_count * (size_t)view_count(r), sizeof *k.sources, e) : NULL;
    bool ok = k.sources != NULL;
    bool others_first = !is_filtered(&r->file->parts[0], r) && !r->file->parts[0].deep; // the default view stays the first
    if (ok && others_first) ok = keep_others(&k, j, r, e);
    for (frame_result *v = r; ok && v; v = v->next_view) ok = add_view(&k, j, v, r->record.made, e);
    if (ok && !others_first) ok = keep_others(&k, j, r, e);
    if (ok) put_record(&k, r);
    const inspection look = {j, r, path};
    const exrio_inspector inspector = {look_again, &look};
    ok = ok && exrio_write_inspected(path, k.parts, k.part_count, j->threads, j->o->verify ? &inspector : NULL, e);
    free_book(&k);
    return ok;
}
