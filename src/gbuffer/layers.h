// The channels of a file as layers with components, whatever way the writer put the names together. Internal to the room.
#ifndef SSDO_GBUFFER_LAYERS_H
#define SSDO_GBUFFER_LAYERS_H

#include "gbuffer/resolve.h"

enum { LAYER_NAME = 512, LAYER_KEY = 128 };

typedef struct layer_entry {
    channel_ref ref;
    char layer[LAYER_NAME]; // without the component and the stereo view; begins with the part's name in a multi-part file
    char component[8];      // upper case, one letter (red -> R); "" for a bare scalar
    char view[32];          // stereo view, from the part or the name; usually ""
} layer_entry;

typedef struct layer_index {
    layer_entry *entries;
    int count;
} layer_index;

// view: leave out the channels of other stereo views, and say of none which it is of; NULL: all.
bool layers_index(const exr_file *file, const char *view, layer_index *out, error *e);
void layers_free(layer_index *index);

// A group of channels found for a pattern.
typedef struct layer_group {
    channel_ref channels[4];
    int components;      // 1 or 3
    char key[LAYER_KEY]; // what identifies the view layer: the layer's name before the pattern, and the stereo view
    bool exact;          // the pattern matched in upper and lower case too
} layer_group;

// All groups that match a pattern of conventions.h with `components` (1 or 3) channels, at most `most`, in file order.
int layers_match(const layer_index *index, const char *pattern, int components, layer_group *out, int most);

// The group of exactly this layer name (case as given first, then any), for an option such as --position.
bool layers_exact(const layer_index *index, const char *layer, int components, layer_group *out);

// The channel `component` of the layer that holds `of`; part -1 when there is none.
channel_ref layers_sibling(const layer_index *index, channel_ref of, const char *component);

// "A, B, C ..." of the distinct layer names, for messages.
void layers_list(const layer_index *index, char *buf, size_t size);

#endif
