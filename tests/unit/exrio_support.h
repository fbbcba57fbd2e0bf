// What the tests of src/exr share: a scratch folder, small images with every kind of bit pattern, the OpenEXR tools.
#ifndef SSDO_TESTS_EXR_SUPPORT_H
#define SSDO_TESTS_EXR_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "exr/file.h"
#include "exr/write.h"

static char scratch_folder[64];

static inline int make_scratch(void **state)
{
    (void)state;
    strcpy(scratch_folder, "/dev/shm/ssdo-exr-XXXXXX"); // memory: some tests write thousands of files
    if (mkdtemp(scratch_folder)) return 0;
    strcpy(scratch_folder, "/tmp/ssdo-exr-XXXXXX");
    return mkdtemp(scratch_folder) ? 0 : -1;
}

static inline int run_command(const char *format, ...) __attribute__((format(printf, 1, 2)));
static inline int run_command(const char *format, ...)
{
    char command[4096];
    va_list args;
    va_start(args, format);
    vsnprintf(command, sizeof command, format, args);
    va_end(args);
    return system(command);
}

static inline int remove_scratch(void **state)
{
    (void)state;
    return run_command("rm -rf '%s'", scratch_folder);
}

// A path in the scratch folder; four may be in use at a time.
static inline const char *in_scratch(const char *name)
{
    static char paths[4][256];
    static int next;
    char *p = paths[next++ % 4];
    snprintf(p, sizeof paths[0], "%s/%s", scratch_folder, name);
    return p;
}

static inline bool have_tool(const char *name)
{
    if (run_command("command -v %s >/dev/null 2>&1", name) == 0) return true;
    print_message("note: %s is not installed, so this is not checked\n", name);
    return false;
}

#define assert_ok(call, e)                                                                                                       \
    do {                                                                                                                         \
        bool ok_ = (call);                                                                                                       \
        if (!ok_) print_error("%s: %s\n", (e).file, (e).message);                                                                \
        assert_true(ok_);                                                                                                        \
    } while (0)

// Every pattern of a half or float occurs: NaNs with payloads, infinities, subnormals, both zeros. `noise` 0 gives runs.
static inline void *make_samples(sample_type type, size_t count, uint32_t seed, bool noise)
{
    uint8_t *data = test_malloc(count * sample_size(type));
    uint32_t r = seed * 2654435761u + 1;
    for (size_t i = 0; i < count; i++) {
        r = r * 1664525u + 1013904223u;
        uint32_t v = noise ? r ^ r >> 15 : (uint32_t)(i / 37) * 0x01010203u;
        if (i % 11 == 0) v = type == SAMPLE_HALF ? 0x7c01u + v % 1022 : 0x7f800001u + v % 8388606u; // NaN with a payload
        if (i % 13 == 0) v = type == SAMPLE_HALF ? 0xfc00u : 0xff800000u;                           // -infinity
        memcpy(data + i * sample_size(type), &v, sample_size(type));
    }
    return data;
}

typedef struct image {
    exrio_out_channel channels[8];
    exrio_out_part part;
} image;

// Unsorted names, all three types, a data window away from the origin.
static inline void make_image(image *im, int width, int height, int compression, bool noise)
{
    static const char *const names[] = {"Z", "a.R", "a.G", "id", "a.B", "R", "normal.X"};
    static const sample_type types[] = {SAMPLE_FLOAT, SAMPLE_HALF, SAMPLE_HALF, SAMPLE_UINT,
                                        SAMPLE_HALF,  SAMPLE_HALF, SAMPLE_FLOAT};
    memset(im, 0, sizeof *im);
    for (int i = 0; i < 7; i++)
        im->channels[i] = (exrio_out_channel){names[i], types[i],
                                              make_samples(types[i], (size_t)width * (size_t)height, (uint32_t)i + 1, noise)};
    im->part = (exrio_out_part){.data_window = {-3, 5, width - 4, height + 4},
                                .display_window = {0, 0, 63, 47},
                                .pixel_aspect = 1.0f,
                                .compression = compression,
                                .channels = im->channels,
                                .channel_count = 7};
}

static inline void free_image(image *im)
{
    for (int i = 0; i < im->part.channel_count; i++) test_free((void *)(uintptr_t)im->channels[i].data);
}

static inline const exrio_channel *find_channel(const exrio_part *p, const char *name)
{
    for (int i = 0; i < p->channel_count; i++)
        if (strcmp(p->channels[i].name, name) == 0) return &p->channels[i];
    return NULL;
}

static inline exrio_file *open_all(const char *path, int threads)
{
    error e = {0};
    exrio_file *f = NULL;
    assert_ok(exrio_file_open(path, &f, &e), e);
    for (int p = 0; p < f->part_count; p++)
        for (int c = 0; c < f->parts[p].channel_count; c++) f->parts[p].channels[c].wanted = true;
    assert_ok(exrio_file_load(f, threads, &e), e);
    return f;
}

// The part holds exactly the image's channels, bit for bit.
static inline void assert_same_pixels(const image *im, const exrio_part *p)
{
    size_t count = (size_t)box2_width(p->data_window) * (size_t)box2_height(p->data_window);
    assert_int_equal(p->channel_count, im->part.channel_count);
    assert_true(box2_equal(p->data_window, im->part.data_window));
    for (int i = 0; i < im->part.channel_count; i++) {
        const exrio_channel *c = find_channel(p, im->channels[i].name);
        assert_non_null(c);
        assert_int_equal(c->type, im->channels[i].type);
        assert_memory_equal(c->data, im->channels[i].data, count * sample_size(c->type));
    }
}

static inline uint8_t *slurp(const char *path, size_t *size)
{
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    fseek(f, 0, SEEK_END);
    *size = (size_t)ftell(f);
    rewind(f);
    uint8_t *data = test_malloc(*size + 1);
    assert_int_equal(fread(data, 1, *size, f), *size);
    data[*size] = 0;
    fclose(f);
    return data;
}

static inline void spill(const char *path, const void *data, size_t size)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, size, f), size);
    fclose(f);
}

#endif
