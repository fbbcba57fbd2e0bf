#include "pipeline/extras.h"

#include <json-c/json.h>
#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

#include "base/infile.h"
#include "pipeline/inputs.h"

enum { MOST_BYTES = 1 << 28 };

static uint8_t *read_file(const char *path, size_t *size)
{
    error ignored = {0};
    return (uint8_t *)infile_text(path, (infile_kind){NULL, ERR_OUTPUT}, MOST_BYTES, size, &ignored);
}

static uint32_t big_endian(const uint8_t *b) { return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3]; }

// PNG is a signature and chunks: length, name, that many bytes, checksum of name and bytes. The last is IEND.
static bool find_text(const uint8_t *png, size_t size, const char *key, char *text, size_t capacity)
{
    static const uint8_t signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    size_t at = sizeof signature, key_size = strlen(key) + 1;
    bool found = false;
    if (size < at || memcmp(png, signature, at) != 0) return false;
    while (size - at >= 12) {
        const uint8_t *name = png + at + 4, *data = name + 4;
        size_t n = big_endian(png + at);
        if (n > size - at - 12 || libdeflate_crc32(0, name, n + 4) != big_endian(data + n)) return false;
        if (memcmp(name, "tEXt", 4) == 0 && n >= key_size && memcmp(data, key, key_size) == 0) {
            size_t length = n - key_size < capacity - 1 ? n - key_size : capacity - 1;
            memcpy(text, data + key_size, length);
            text[length] = 0;
            found = true;
        }
        at += n + 12;
        if (memcmp(name, "IEND", 4) == 0) return found && at == size;
    }
    return false;
}

bool png_text(const char *path, const char *key, char *text, size_t size)
{
    size_t n = 0;
    uint8_t *bytes = read_file(path, &n);
    bool found = bytes && find_text(bytes, n, key, text, size);
    free(bytes);
    return found;
}

static bool report_says(const char *path, const char *wanted)
{
    size_t n = 0;
    uint8_t *bytes = read_file(path, &n);
    json_object *o = bytes ? json_tokener_parse((const char *)bytes) : NULL, *value = NULL;
    bool same = o && json_object_is_type(o, json_type_object) && json_object_object_get_ex(o, "digest", &value) &&
                json_object_is_type(value, json_type_string) && strcmp(json_object_get_string(value), wanted) == 0;
    json_object_put(o);
    free(bytes);
    return same;
}

bool extras_are_done(const job *j, int frame, const frame_record *r)
{
    char path[FILE_PATH], text[DIGEST_TEXT + 2], wanted[DIGEST_TEXT + 1];
    for (int i = 0; i < j->files->count; i++) {
        const run_file *f = &j->files->list[i];
        bool preview = f->kind == FILE_PREVIEW, report = f->kind == FILE_REPORT && (f->framed || !inputs_are_framed(j->o));
        if ((!preview && !report) || !run_file_path(f, frame, path, sizeof path)) continue;
        digest_format(preview ? r->preview : r->sampled, wanted);
        if (report && !report_says(path, wanted)) return false;
        if (preview && (!png_text(path, RECORD_NAME, text, sizeof text) || strcmp(text, wanted) != 0)) return false;
    }
    return true;
}
