#include "exr/compare.h"

#include <stdlib.h>
#include <string.h>

#include "exr/deep.h"

static const exr_attribute_t *find(const exrio_file *file, int part, const char *name)
{
    const exr_attribute_t *a = NULL;
    return exr_get_attribute_by_name(file->core, part, name, &a) == EXR_ERR_SUCCESS ? a : NULL;
}

static bool same_bytes(const void *a, const void *b, int64_t size_a, int64_t size_b)
{
    return size_a == size_b && (size_a <= 0 || memcmp(a, b, (size_t)size_a) == 0);
}

static bool same_strings(const exr_attr_string_vector_t *a, const exr_attr_string_vector_t *b)
{
    if (a->n_strings != b->n_strings) return false;
    for (int32_t i = 0; i < a->n_strings; i++)
        if (!same_bytes(a->strings[i].str, b->strings[i].str, a->strings[i].length, b->strings[i].length)) return false;
    return true;
}

static bool same_previews(const exr_attr_preview_t *a, const exr_attr_preview_t *b)
{
    int64_t size = 4 * (int64_t)a->width * a->height;
    return a->width == b->width && a->height == b->height && same_bytes(a->rgba, b->rgba, size, size);
}

// Values of a fixed size stand behind the pointer, or in its place.
static bool same_value(const exr_attribute_t *a, const exr_attribute_t *b)
{
    switch (a->type) {
    case EXR_ATTR_STRING:
        return same_bytes(a->string->str, b->string->str, a->string->length, b->string->length);
    case EXR_ATTR_STRING_VECTOR:
        return same_strings(a->stringvector, b->stringvector);
    case EXR_ATTR_FLOAT_VECTOR:
        return same_bytes(a->floatvector->arr, b->floatvector->arr, 4 * (int64_t)a->floatvector->length,
                          4 * (int64_t)b->floatvector->length);
    case EXR_ATTR_PREVIEW:
        return same_previews(a->preview, b->preview);
    case EXR_ATTR_OPAQUE:
        return same_bytes(a->opaque->packed_data, b->opaque->packed_data, a->opaque->size, b->opaque->size);
    case EXR_ATTR_INT:
        return a->i == b->i;
    case EXR_ATTR_FLOAT:
        return memcmp(&a->f, &b->f, sizeof a->f) == 0;
    case EXR_ATTR_DOUBLE:
        return memcmp(&a->d, &b->d, sizeof a->d) == 0;
    case EXR_ATTR_COMPRESSION:
    case EXR_ATTR_ENVMAP:
    case EXR_ATTR_LINEORDER:
        return a->uc == b->uc;
    default: {
        size_t size = exrio_attr_value_size((int)a->type);
        return size > 0 && memcmp(a->rawptr, b->rawptr, size) == 0;
    }
    }
}

static bool counts(const exr_attribute_t *a)
{
    if (strcmp(a->name, "screenWindowCenter") == 0 || strcmp(a->name, "screenWindowWidth") == 0) return true;
    return !exrio_attr_structural(a->name) && a->type != EXR_ATTR_CHLIST && strncmp(a->name, "ssdo/", 5) != 0;
}

static bool is_earlier(const exrio_source *sources, int before, const char *name)
{
    for (int i = 0; i < before; i++)
        if (find(sources[i].file, sources[i].part, name)) return true;
    return false;
}

const char *exrio_attributes_differ(const exrio_source *sources, int count, const exrio_file *out, int part)
{
    for (int s = 0; s < count; s++) {
        int32_t n = 0;
        const exrio_file *from = sources[s].file;
        if (exr_get_attribute_count(from->core, sources[s].part, &n) != EXR_ERR_SUCCESS) return "?";
        for (int32_t i = 0; i < n; i++) {
            const exr_attribute_t *a = NULL, *b;
            if (exr_get_attribute_by_index(from->core, sources[s].part, EXR_ATTR_LIST_FILE_ORDER, i, &a) != EXR_ERR_SUCCESS)
                return "?";
            if (!counts(a) || is_earlier(sources, s, a->name)) continue;
            b = find(out, part, a->name);
            if (!b || a->type != b->type || strcmp(a->type_name, b->type_name) != 0 || !same_value(a, b)) return a->name;
        }
    }
    return NULL;
}

bool exrio_deep_same(const exrio_file *a, int part_a, const exrio_file *b, int part_b)
{
    const box2 w = a->parts[part_a].data_window;
    int32_t lines = 0, lines_b = 0;
    deep_chunk x = {0}, y = {0};
    bool same = box2_equal(w, b->parts[part_b].data_window) &&
                exr_get_scanlines_per_chunk(a->core, part_a, &lines) == EXR_ERR_SUCCESS &&
                exr_get_scanlines_per_chunk(b->core, part_b, &lines_b) == EXR_ERR_SUCCESS && lines == lines_b && lines > 0;
    for (int line = w.y0; same && line <= w.y1; line += lines)
        same = deep_read(a->core, part_a, line, &x) == EXR_ERR_SUCCESS &&
               deep_read(b->core, part_b, line, &y) == EXR_ERR_SUCCESS && x.info.unpacked_size == y.info.unpacked_size &&
               same_bytes(x.packed, y.packed, (int64_t)x.info.packed_size, (int64_t)y.info.packed_size) &&
               same_bytes(x.counts, y.counts, (int64_t)x.info.sample_count_table_size, (int64_t)y.info.sample_count_table_size);
    deep_free(&x);
    deep_free(&y);
    return same;
}
