#include <string.h>

#include "exr/file.h"
#include "exr/internal.h"
#include "exr/write.h"

static const exr_attribute_t *find(const exrio_file *file, int part, const char *name)
{
    const exr_attribute_t *a = NULL;
    file = exrio_part_file(file, &part);
    if (exr_get_attribute_by_name(file->core, part, name, &a) != EXR_ERR_SUCCESS) return NULL;
    return a;
}

bool exrio_attr_exists(const exrio_file *file, int part, const char *name) { return find(file, part, name) != NULL; }

bool exrio_attr_begins(const exrio_file *file, int part, const char *beginning, size_t n)
{
    int32_t count = 0;
    file = exrio_part_file(file, &part);
    if (exr_get_attribute_count(file->core, part, &count) != EXR_ERR_SUCCESS) return false;
    for (int32_t i = 0; i < count; i++) {
        const exr_attribute_t *a = NULL;
        if (exr_get_attribute_by_index(file->core, part, EXR_ATTR_LIST_FILE_ORDER, i, &a) != EXR_ERR_SUCCESS) return false;
        if (strncmp(a->name, beginning, n) == 0) return true;
    }
    return false;
}

bool exrio_attr_string(const exrio_file *file, int part, const char *name, const char **value)
{
    const exr_attribute_t *a = find(file, part, name);
    if (!a || a->type != EXR_ATTR_STRING) return false;
    *value = a->string->str ? a->string->str : "";
    return true;
}

int exrio_attr_strings(const exrio_file *file, int part, const char *name, const char **values, int most)
{
    const exr_attribute_t *a = find(file, part, name);
    if (!a || a->type != EXR_ATTR_STRING_VECTOR) return 0;
    int n = a->stringvector->n_strings < most ? a->stringvector->n_strings : most;
    for (int i = 0; i < n; i++) values[i] = a->stringvector->strings[i].str ? a->stringvector->strings[i].str : "";
    return n;
}

bool exrio_attr_float(const exrio_file *file, int part, const char *name, double *value)
{
    const exr_attribute_t *a = find(file, part, name);
    if (!a) return false;
    switch (a->type) {
    case EXR_ATTR_FLOAT:
        *value = (double)a->f;
        return true;
    case EXR_ATTR_DOUBLE:
        *value = a->d;
        return true;
    case EXR_ATTR_INT:
        *value = (double)a->i;
        return true;
    default:
        return false;
    }
}

bool exrio_attr_m44(const exrio_file *file, int part, const char *name, double m[4][4])
{
    const exr_attribute_t *a = find(file, part, name);
    if (!a || (a->type != EXR_ATTR_M44F && a->type != EXR_ATTR_M44D)) return false;
    for (int i = 0; i < 16; i++) {
        float f;
        if (a->type == EXR_ATTR_M44F) {
            memcpy(&f, (const char *)a->m44f + (size_t)i * sizeof f, sizeof f); // the library's struct is packed
            m[i / 4][i % 4] = (double)f;
        } else {
            memcpy(&m[i / 4][i % 4], (const char *)a->m44d + (size_t)i * sizeof(double), sizeof(double));
        }
    }
    return true;
}

bool exrio_attr_v2(const exrio_file *file, int part, const char *name, double v[2])
{
    const exr_attribute_t *a = find(file, part, name);
    if (!a || a->type != EXR_ATTR_V2F) return false;
    v[0] = (double)a->v2f->x;
    v[1] = (double)a->v2f->y;
    return true;
}

bool exrio_attr_chromaticities(const exrio_file *file, int part, double xy[8])
{
    static const char *const name = "chromaticities";
    const exr_attribute_t *a = find(file, exrio_attr_part(file, part, name), name);
    if (!a || a->type != EXR_ATTR_CHROMATICITIES) return false;
    const exr_attr_chromaticities_t *c = a->chromaticities;
    const double all[8] = {(double)c->red_x,  (double)c->red_y,  (double)c->green_x, (double)c->green_y,
                           (double)c->blue_x, (double)c->blue_y, (double)c->white_x, (double)c->white_y};
    memcpy(xy, all, sizeof all);
    return true;
}

bool exrio_attr_structural(const char *name)
{
    static const char *const structural[] = {"channels",
                                             "chunkCount",
                                             "compression",
                                             "dataWindow",
                                             "displayWindow",
                                             "lineOrder",
                                             "name",
                                             "pixelAspectRatio",
                                             "tiles",
                                             "type",
                                             "version",
                                             "view",
                                             "screenWindowCenter",
                                             "screenWindowWidth"};
    for (size_t i = 0; i < sizeof structural / sizeof *structural; i++)
        if (strcmp(name, structural[i]) == 0) return true;
    return false;
}

static bool is_ours(const char *name, const exrio_out_attr *ours, int count)
{
    for (int i = 0; i < count; i++)
        if (strcmp(name, ours[i].name) == 0) return true;
    return false;
}

size_t exrio_attr_value_size(int type)
{
    switch (type) {
    case EXR_ATTR_BOX2I:
        return sizeof(exr_attr_box2i_t);
    case EXR_ATTR_BOX2F:
        return sizeof(exr_attr_box2f_t);
    case EXR_ATTR_CHROMATICITIES:
        return sizeof(exr_attr_chromaticities_t);
    case EXR_ATTR_FLOAT_VECTOR:
        return sizeof(exr_attr_float_vector_t);
    case EXR_ATTR_KEYCODE:
        return sizeof(exr_attr_keycode_t);
    case EXR_ATTR_M33F:
        return sizeof(exr_attr_m33f_t);
    case EXR_ATTR_M33D:
        return sizeof(exr_attr_m33d_t);
    case EXR_ATTR_M44F:
        return sizeof(exr_attr_m44f_t);
    case EXR_ATTR_M44D:
        return sizeof(exr_attr_m44d_t);
    case EXR_ATTR_PREVIEW:
        return sizeof(exr_attr_preview_t);
    case EXR_ATTR_RATIONAL:
        return sizeof(exr_attr_rational_t);
    case EXR_ATTR_STRING:
        return sizeof(exr_attr_string_t);
    case EXR_ATTR_STRING_VECTOR:
        return sizeof(exr_attr_string_vector_t);
    case EXR_ATTR_TILEDESC:
        return sizeof(exr_attr_tiledesc_t);
    case EXR_ATTR_TIMECODE:
        return sizeof(exr_attr_timecode_t);
    case EXR_ATTR_V2I:
        return sizeof(exr_attr_v2i_t);
    case EXR_ATTR_V2F:
        return sizeof(exr_attr_v2f_t);
    case EXR_ATTR_V2D:
        return sizeof(exr_attr_v2d_t);
    case EXR_ATTR_V3I:
        return sizeof(exr_attr_v3i_t);
    case EXR_ATTR_V3F:
        return sizeof(exr_attr_v3f_t);
    case EXR_ATTR_V3D:
        return sizeof(exr_attr_v3d_t);
    case EXR_ATTR_OPAQUE:
        return sizeof(exr_attr_opaquedata_t);
    default:
        return 0;
    }
}

// An allocation size of zero is the library's mark for data that somebody else owns.
static void disown(exr_attribute_t *a)
{
    switch (a->type) {
    case EXR_ATTR_FLOAT_VECTOR:
        a->floatvector->alloc_size = 0;
        break;
    case EXR_ATTR_PREVIEW:
        a->preview->alloc_size = 0;
        break;
    case EXR_ATTR_STRING:
        a->string->alloc_size = 0;
        break;
    case EXR_ATTR_STRING_VECTOR:
        a->stringvector->alloc_size = 0;
        break;
    case EXR_ATTR_OPAQUE:
        a->opaque->packed_alloc_size = 0;
        if (!a->opaque->size) a->opaque->packed_data = a->opaque; // no bytes, but the library wants a pointer to them
        break;
    default:
        break;
    }
}

// The library's own setters take C strings and would cut one that holds a zero byte.
static exr_result_t borrow(exr_context_t to, int part, const exr_attribute_t *source)
{
    exr_attribute_t *a = NULL;
    exr_result_t rv = exr_attr_declare_by_type(to, part, source->name, source->type_name, &a);
    if (rv != EXR_ERR_SUCCESS) return rv;
    if (a->type != source->type) return EXR_ERR_ATTR_TYPE_MISMATCH;
    size_t size = exrio_attr_value_size((int)a->type);
    if (size)
        memcpy(a->rawptr, source->rawptr, size);
    else
        a->d = source->d; // the widest of the values kept in place
    disown(a);
    return EXR_ERR_SUCCESS;
}

bool exrio_attr_source(const exrio_out_part *p, int number, exrio_source *out)
{
    int first = p->attributes_from != NULL;
    if (number >= first + p->also_count) return false;
    *out = first && number == 0 ? (exrio_source){p->attributes_from, p->attributes_part} : p->also[number - first];
    return true;
}

// An earlier source has the name.
static bool is_taken(const exrio_out_part *p, int before, const char *name)
{
    exrio_source s;
    for (int i = 0; i < before && exrio_attr_source(p, i, &s); i++)
        if (exrio_attr_exists(s.file, s.part, name)) return true;
    return false;
}

exr_result_t exrio_attr_copy_all(exr_context_t to, int part, const exrio_out_part *p)
{
    exr_result_t rv = EXR_ERR_SUCCESS;
    exrio_source s;
    for (int n = 0; rv == EXR_ERR_SUCCESS && exrio_attr_source(p, n, &s); n++) {
        int32_t count = 0;
        rv = exr_get_attribute_count(s.file->core, s.part, &count);
        for (int32_t i = 0; rv == EXR_ERR_SUCCESS && i < count; i++) {
            const exr_attribute_t *a = NULL;
            rv = exr_get_attribute_by_index(s.file->core, s.part, EXR_ATTR_LIST_FILE_ORDER, i, &a);
            if (rv != EXR_ERR_SUCCESS) break;
            // A second channel list under another name would say nothing about the new file, and the library cannot lend one.
            if (exrio_attr_structural(a->name) || a->type == EXR_ATTR_CHLIST || is_taken(p, n, a->name) ||
                is_ours(a->name, p->attributes, p->attribute_count))
                continue;
            rv = borrow(to, part, a);
        }
    }
    return rv;
}

int exrio_attr_part(const exrio_file *file, int part, const char *name)
{
    if (exrio_attr_exists(file, part, name)) return part;
    for (int i = 0; i < file->part_count; i++)
        if (strcmp(file->parts[i].view, file->parts[part].view) == 0 && exrio_attr_exists(file, i, name)) return i;
    return part;
}
