// OpenEXR files put together byte by byte, for headers that no library would write.
#ifndef SSDO_TESTS_EXR_RAW_H
#define SSDO_TESTS_EXR_RAW_H

#include "exrio_support.h"

typedef struct raw_file {
    uint8_t bytes[16384];
    size_t size;
} raw_file;

static inline void raw_put(raw_file *r, const void *data, size_t n)
{
    assert_true(r->size + n <= sizeof r->bytes);
    memcpy(r->bytes + r->size, data, n);
    r->size += n;
}

static inline void raw_int(raw_file *r, uint32_t v) { raw_put(r, &v, sizeof v); }

static inline void raw_attribute(raw_file *r, const char *name, const char *type, const void *data, size_t n)
{
    raw_put(r, name, strlen(name) + 1);
    raw_put(r, type, strlen(type) + 1);
    raw_int(r, (uint32_t)n);
    raw_put(r, data, n);
}

static inline void raw_start(raw_file *r, uint32_t flags)
{
    r->size = 0;
    raw_int(r, 20000630);
    raw_int(r, 2 | flags);
}

// A channel list of one half channel.
static inline void raw_channels(raw_file *r, const char *name, uint32_t type, uint32_t sampling)
{
    raw_file list = {.size = 0};
    raw_put(&list, name, strlen(name) + 1);
    raw_int(&list, type);
    raw_int(&list, 0);
    raw_int(&list, sampling);
    raw_int(&list, sampling);
    raw_put(&list, "", 1);
    raw_attribute(r, "channels", "chlist", list.bytes, list.size);
}

static inline void raw_window(raw_file *r, const char *name, int32_t x1, int32_t y1)
{
    const int32_t box[4] = {0, 0, x1, y1};
    raw_attribute(r, name, "box2i", box, sizeof box);
}

// All required attributes but the channels.
static inline void raw_required(raw_file *r, uint8_t compression, int32_t x1, int32_t y1)
{
    const uint8_t order = 0;
    const float one = 1, zero[2] = {0, 0};
    raw_attribute(r, "compression", "compression", &compression, 1);
    raw_window(r, "dataWindow", x1, y1);
    raw_window(r, "displayWindow", x1, y1);
    raw_attribute(r, "lineOrder", "lineOrder", &order, 1);
    raw_attribute(r, "pixelAspectRatio", "float", &one, 4);
    raw_attribute(r, "screenWindowCenter", "v2f", zero, 8);
    raw_attribute(r, "screenWindowWidth", "float", &one, 4);
}

// Ends the header of a 1 x 1 uncompressed image of one half channel and adds its pixel, 0x3c00.
static inline void raw_finish(raw_file *r)
{
    raw_put(r, "", 1);
    uint64_t at = r->size + 8;
    raw_put(r, &at, sizeof at);
    raw_int(r, 0); // line 0
    raw_int(r, 2); // bytes
    raw_put(r, "\0\x3c", 2);
}

static inline void raw_save(const raw_file *r, const char *path) { spill(path, r->bytes, r->size); }

#endif
