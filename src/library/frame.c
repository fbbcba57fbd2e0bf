#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "library/objects.h"
#include "library/struct_size.h"

// The view and layer of an index, counted over the views. False beyond the last.
static bool locate(const ssdo_frame *f, int index, const frame_result **view, layer_id *layer)
{
    for (*view = &f->result; index >= 0 && *view; *view = (*view)->next_view)
        for (int l = 0; l < LAYER_COUNT; l++)
            if ((*view)->layers[l] && index-- == 0) {
                *layer = (layer_id)l;
                return true;
            }
    return false;
}

int ssdo_layer_count(const ssdo_frame *f)
{
    int n = 0;
    const frame_result *view;
    for (layer_id layer; locate(f, n, &view, &layer);) n++;
    return n;
}

ssdo_status ssdo_get_layer(const ssdo_frame *f, int index, ssdo_layer *out)
{
    const frame_result *view;
    layer_id l;
    size_t size = out->size;
    if (!locate(f, index, &view, &l) || size <= sizeof size || size > sizeof *out) return SSDO_USAGE;
    const ssdo_layer layer = {.size = size,
                              .name = layer_table[l]->name,
                              .channels = layer_table[l]->channels,
                              .view = view->view,
                              .width = view->gb.width,
                              .height = view->gb.height,
                              .pixels = view->layers[l]};
    memcpy(out, &layer, size);
    return SSDO_OK;
}

int ssdo_find_layer(const ssdo_frame *f, const char *name, const char *view)
{
    ssdo_layer layer = {.size = sizeof layer};
    for (int i = 0; ssdo_get_layer(f, i, &layer) == SSDO_OK; i++)
        if (strcmp(layer.name, name) == 0 && (!view || (layer.view && strcmp(layer.view, view) == 0))) return i;
    return -1;
}

ssdo_status ssdo_copy_layer(const ssdo_frame *f, int index, float *to, size_t count)
{
    ssdo_layer layer = {.size = sizeof layer};
    if (ssdo_get_layer(f, index, &layer) != SSDO_OK ||
        count != (size_t)layer.width * (size_t)layer.height * strlen(layer.channels))
        return SSDO_USAGE;
    memcpy(to, layer.pixels, count * sizeof *to);
    return SSDO_OK;
}

void ssdo_free_frame(ssdo_frame *f)
{
    if (!f) return;
    frame_free(&f->result);
    if (f->memory >= 0) close(f->memory);
    free(f);
}
