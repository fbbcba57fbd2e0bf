#include "library/memory_file.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "exr/write.h"
#include "library/struct_size.h"

enum { LARGEST_SIDE = 1 << 24 };

static bool check_channel(const ssdo_channel *c, int index, error *e)
{
    if (!c->name || !c->name[0]) return err_set(e, ERR_USAGE, NULL, NULL, "channel %d has no name", index);
    if (!c->samples) return err_set(e, ERR_USAGE, NULL, c->name, "a channel has no samples");
    if (c->type < SSDO_UINT || c->type > SSDO_FLOAT)
        return err_set(e, ERR_USAGE, NULL, c->name, "a channel's type is %d; uint, half and float are 0, 1 and 2", (int)c->type);
    return true;
}

// The samples side by side: as they are, or copied to *owned.
static const void *packed(const ssdo_channel *c, int width, int height, void **owned, error *e)
{
    size_t size = sample_size((sample_type)c->type), w = (size_t)width;
    ptrdiff_t pixel = c->pixel_stride ? c->pixel_stride : (ptrdiff_t)size, row = c->row_stride ? c->row_stride : pixel * width;
    if (pixel == (ptrdiff_t)size && row == pixel * width) return c->samples;
    char *to = *owned = mem_pixels(w * (size_t)height, size, e);
    for (int y = 0; to && y < height; y++) {
        const char *from = (const char *)c->samples + y * row;
        for (int x = 0; x < width; x++) memcpy(to + ((size_t)y * w + (size_t)x) * size, from + x * pixel, size);
    }
    return to;
}

static bool take_attribute(const ssdo_attribute *a, exrio_out_attr *out, error *e)
{
    if (!a->name || !a->name[0]) return err_set(e, ERR_USAGE, NULL, NULL, "an attribute has no name");
    *out = (exrio_out_attr){.name = a->name};
    if (a->kind == SSDO_TEXT ? !a->text : !a->numbers)
        return err_set(e, ERR_USAGE, NULL, NULL, "the attribute %s has no value", a->name);
    switch (a->kind) {
    case SSDO_TEXT:
        out->kind = EXRIO_OUT_STRING, out->string = a->text;
        return true;
    case SSDO_NUMBER:
        out->kind = EXRIO_OUT_FLOAT, out->number = a->numbers[0];
        return true;
    case SSDO_MATRIX:
        out->kind = EXRIO_OUT_M44, memcpy(out->m44, a->numbers, sizeof out->m44);
        return true;
    }
    return err_set(e, ERR_USAGE, NULL, NULL, "the attribute %s has the unknown kind %d", a->name, (int)a->kind);
}

typedef struct contents {
    exrio_out_channel *channels;
    void **owned; // a channel's packed samples
    exrio_out_attr *attributes;
} contents;

static bool fill(const ssdo_input *in, contents *c, error *e)
{
    const char *at = (const char *)in->channels;
    for (int i = 0; i < in->channel_count; i++) {
        ssdo_channel channel;
        if (!struct_take(&channel, sizeof channel, at, "ssdo_channel", e) || !check_channel(&channel, i, e)) return false;
        at += ((const ssdo_channel *)(const void *)at)->size;
        const void *data = packed(&channel, in->width, in->height, &c->owned[i], e);
        if (!data) return false;
        c->channels[i] = (exrio_out_channel){.name = channel.name, .type = (sample_type)channel.type, .data = data};
    }
    at = (const char *)in->attributes;
    for (int i = 0; i < in->attribute_count; i++) {
        ssdo_attribute attribute;
        if (!struct_take(&attribute, sizeof attribute, at, "ssdo_attribute", e) ||
            !take_attribute(&attribute, &c->attributes[i], e))
            return false;
        at += ((const ssdo_attribute *)(const void *)at)->size;
    }
    return true;
}

int memory_file_make(const ssdo_input *in, int threads, error *e)
{
    if (in->channel_count < 1 || !in->channels || in->attribute_count < 0 || (in->attribute_count > 0 && !in->attributes)) {
        err_set(e, ERR_USAGE, NULL, NULL, "the input has neither files nor channels");
        return -1;
    }
    if (in->width < 1 || in->height < 1 || in->width > LARGEST_SIDE || in->height > LARGEST_SIDE) {
        err_set(e, ERR_USAGE, NULL, NULL, "the input has %d x %d pixels", in->width, in->height);
        return -1;
    }
    int fd = -1, n = in->channel_count;
    contents c = {.channels = mem_zero((size_t)n, sizeof *c.channels, e),
                  .owned = mem_zero((size_t)n, sizeof *c.owned, e),
                  .attributes = mem_zero((size_t)in->attribute_count, sizeof *c.attributes, e)};
    if (c.channels && c.owned && c.attributes && fill(in, &c, e)) {
        const box2 window = {0, 0, in->width - 1, in->height - 1};
        const exrio_out_part part = {.data_window = window,
                                     .display_window = window,
                                     .pixel_aspect = 1.0f,
                                     .channels = c.channels,
                                     .channel_count = n,
                                     .attributes = c.attributes,
                                     .attribute_count = in->attribute_count};
        fd = exrio_write_memory(&part, 1, threads, e);
    }
    for (int i = 0; c.owned && i < n; i++) free(c.owned[i]);
    free(c.owned);
    free(c.channels);
    free(c.attributes);
    return fd;
}
