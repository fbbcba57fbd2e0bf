#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "exr/internal.h"

// --- checks ---

static int compare_names(const void *a, const void *b) { return strcmp(*(const char *const *)a, *(const char *const *)b); }

static bool check_channels(const char *path, const exrio_out_part *p, error *e)
{
    if (p->channel_count < 1) return err_set(e, ERR_OUTPUT, path, NULL, "would have a part without channels; ask for a layer");
    if (p->channel_count > EXRIO_MAX_CHANNELS)
        return err_set(e, ERR_OUTPUT, path, NULL, "would have %d channels in one part, more than %d; keep fewer layers",
                       p->channel_count, EXRIO_MAX_CHANNELS);
    const char **names = mem_zero((size_t)p->channel_count, sizeof *names, e);
    if (!names) return false;
    bool ok = true;
    for (int i = 0; ok && i < p->channel_count; i++) {
        names[i] = p->channels[i].name;
        size_t n = strlen(names[i]);
        if (n < 1 || n > EXRIO_MAX_NAME)
            ok = err_set(e, ERR_OUTPUT, path, names[i], "has a channel name of %zu bytes; the format allows 1 to %d", n,
                         EXRIO_MAX_NAME);
    }
    if (ok) qsort(names, (size_t)p->channel_count, sizeof *names, compare_names);
    for (int i = 1; ok && i < p->channel_count; i++)
        if (strcmp(names[i - 1], names[i]) == 0)
            ok = err_set(e, ERR_OUTPUT, path, names[i], "would hold two channels of one name; rename ours with --prefix");
    free(names);
    return ok;
}

static bool check_layout(const char *path, const exrio_out_part *p, error *e)
{
    int64_t w = (int64_t)p->data_window.x1 - p->data_window.x0 + 1, h = (int64_t)p->data_window.y1 - p->data_window.y0 + 1;
    if (w < 1 || h < 1 || w > EXRIO_MAX_SIDE || h > EXRIO_MAX_SIDE || w * h > EXRIO_MAX_PIXELS)
        return err_set(e, ERR_OUTPUT, path, NULL, "would have a data window of %lld x %lld pixels, which cannot be written",
                       (long long)w, (long long)h);
    if (!p->verbatim && (p->compression == EXR_COMPRESSION_DWAA || p->compression == EXR_COMPRESSION_DWAB))
        return err_set(e, ERR_OUTPUT, path, NULL, "cannot be written with DWAA or DWAB compression; use --compression zip");
    if (p->compression < EXR_COMPRESSION_NONE || p->compression >= EXR_COMPRESSION_LAST_TYPE)
        return err_set(e, ERR_OUTPUT, path, NULL, "cannot be written with compression number %d; use --compression zip",
                       p->compression);
    uint64_t pixel = 0;
    for (int i = 0; i < p->channel_count; i++) pixel += sample_size(p->channels[i].type);
    if (pixel * (uint64_t)w * 32 > EXRIO_MAX_CHUNK_BYTES) // 32: the most lines a chunk of ours has
        return err_set(e, ERR_OUTPUT, path, NULL, "would have lines too long for one block; keep fewer layers");
    return true;
}

bool exrio_check_parts(const char *path, const exrio_out_part *parts, int count, error *e)
{
    if (count < 1 || count > EXRIO_MAX_PARTS) return err_set(e, ERR_OUTPUT, path, NULL, "cannot be written with %d parts", count);
    for (int i = 0; i < count; i++) {
        const exrio_out_part *p = &parts[i];
        if (!check_channels(path, p, e) || !check_layout(path, p, e)) return false;
        if (count == 1) continue;
        if (!p->name || !p->name[0])
            return err_set(e, ERR_OUTPUT, path, NULL, "part %d has no name, which a file of several parts needs", i);
        for (int j = 0; j < i; j++)
            if (strcmp(parts[j].name, p->name) == 0)
                return err_set(e, ERR_OUTPUT, path, NULL, "would hold two parts named '%s'; use --layout single", p->name);
    }
    return true;
}

// --- the header ---

static bool is_long(const char *name) { return strlen(name) > EXRIO_SHORT_NAME; }

static bool has_long_copied_name(const exrio_out_part *p)
{
    exrio_source s;
    for (int n = 0; exrio_attr_source(p, n, &s); n++) {
        int32_t count = 0;
        if (exr_get_attribute_count(s.file->core, s.part, &count)) return false;
        for (int32_t i = 0; i < count; i++) {
            const exr_attribute_t *a = NULL;
            if (exr_get_attribute_by_index(s.file->core, s.part, EXR_ATTR_LIST_FILE_ORDER, i, &a) == EXR_ERR_SUCCESS &&
                (is_long(a->name) || is_long(a->type_name)))
                return true;
        }
    }
    return false;
}

// Names of more than 31 bytes need a flag that old readers refuse, so it is set only where there are any.
static bool has_long_name(const exrio_out_part *p)
{
    for (int i = 0; i < p->channel_count; i++)
        if (is_long(p->channels[i].name)) return true;
    for (int i = 0; i < p->attribute_count; i++)
        if (is_long(p->attributes[i].name)) return true;
    return has_long_copied_name(p);
}

static exr_attr_box2i_t box_to(box2 b)
{
    exr_attr_box2i_t r;
    r.min.x = b.x0;
    r.min.y = b.y0;
    r.max.x = b.x1;
    r.max.y = b.y1;
    return r;
}

// The screen window belongs to the camera, so it is kept although every writer must write one.
static exr_result_t put_required(exr_context_t core, int index, const exrio_out_part *p)
{
    exr_attr_box2i_t data = box_to(p->data_window), display = box_to(p->display_window);
    exr_attr_v2f_t center = {0};
    float width = 1.0f;
    if (p->attributes_from) {
        exr_context_t from = p->attributes_from->core;
        if (exr_get_screen_window_center(from, p->attributes_part, &center)) center = (exr_attr_v2f_t){0};
        if (exr_get_screen_window_width(from, p->attributes_part, &width)) width = 1.0f;
    }
    exr_result_t rv = exr_initialize_required_attr(core, index, &display, &data, p->pixel_aspect, &center, width,
                                                   EXR_LINEORDER_INCREASING_Y, (exr_compression_t)p->compression);
    for (int i = 0; rv == EXR_ERR_SUCCESS && i < p->channel_count; i++)
        rv = exr_add_channel(core, index, p->channels[i].name, (exr_pixel_type_t)p->channels[i].type,
                             EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    if (rv == EXR_ERR_SUCCESS && p->view && p->view[0]) rv = exr_attr_set_string(core, index, "view", p->view);
    return rv;
}

static exr_result_t put_ours(exr_context_t core, int index, const exrio_out_attr *a)
{
    switch (a->kind) {
    case EXRIO_OUT_STRING:
        return exr_attr_set_string(core, index, a->name, a->string);
    case EXRIO_OUT_FLOAT:
        return exr_attr_set_float(core, index, a->name, (float)a->number);
    case EXRIO_OUT_CHROMATICITIES: {
        float xy[8];
        for (int i = 0; i < 8; i++) xy[i] = (float)a->xy[i];
        exr_attr_chromaticities_t value;
        _Static_assert(sizeof value == sizeof xy, "red, green, blue, white");
        memcpy(&value, xy, sizeof value);
        return exr_attr_set_chromaticities(core, index, a->name, &value);
    }
    case EXRIO_OUT_STRINGS:
        return exr_attr_set_string_vector(core, index, a->name, a->string_count, (const char **)a->strings);
    case EXRIO_OUT_M44: {
        float m[16];
        for (int i = 0; i < 16; i++) m[i] = (float)a->m44[i / 4][i % 4];
        exr_attr_m44f_t value;
        memcpy(&value, m, sizeof value);
        return exr_attr_set_m44f(core, index, a->name, &value);
    }
    }
    return EXR_ERR_INVALID_ARGUMENT;
}

exr_result_t exrio_put_header(exr_context_t core, const exrio_out_part *parts, int count)
{
    exr_result_t rv = EXR_ERR_SUCCESS;
    bool long_names = false;
    for (int i = 0; i < count; i++) long_names |= has_long_name(&parts[i]);
    bool deep = false;
    for (int i = 0; i < count; i++) deep |= parts[i].deep;
    if (long_names) rv = exr_set_longname_support(core, 1);
    for (int i = 0; rv == EXR_ERR_SUCCESS && i < count; i++) {
        const exrio_out_part *p = &parts[i];
        int index = -1;
        rv = exr_add_part(core, p->name && p->name[0] ? p->name : NULL,
                          p->deep ? EXR_STORAGE_DEEP_SCANLINE : EXR_STORAGE_SCANLINE, &index);
        if (rv == EXR_ERR_SUCCESS) rv = put_required(core, index, p);
        if (rv == EXR_ERR_SUCCESS && deep) rv = exr_set_version(core, index, 1); // 3.1.5 wants it of flat parts too, as a reader
        if (rv == EXR_ERR_SUCCESS) rv = exrio_attr_copy_all(core, index, p);
        for (int a = 0; rv == EXR_ERR_SUCCESS && a < p->attribute_count; a++) rv = put_ours(core, index, &p->attributes[a]);
    }
    return rv == EXR_ERR_SUCCESS ? exr_write_header(core) : rv;
}
