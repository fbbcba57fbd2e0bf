// The channels of a file as layers with components, whatever way the writer put the names together. Internal to the room.
#ifndef SSDO_GBUFFER_LAYERS_H
#define SSDO_GBUFFER_LAYERS_H

#include "gbuffer/resolution.h"

enum { LAYER_NAME = 512, LAYER_KEY = 128, EXRIO_NAME_ROOM = 256, LAYERS_TEXT = 3000 }; // the last: of a list of them

// A part that holds the picture: the only one, or one of several, which are view layers then, each of the part's name.
typedef enum picture_kind { PICTURE_NO, PICTURE_ONLY, PICTURE_OF_SEVERAL } picture_kind;

// What a pattern looks for: one channel; X Y Z or else R G B; R G B or else (under a name) X Y Z.
typedef enum layer_kind { LAYER_SCALAR, LAYER_VECTOR, LAYER_COLOUR } layer_kind;

typedef struct layer_entry {
    channel_ref ref;
    char layer[LAYER_NAME]; // without the component and the stereo view; begins with the part's name in a multi-part file
    char component[8];      // upper case, one letter (red -> R); "" for a bare scalar
    char view[32];          // stereo view, from the part or the name; usually ""
    bool bare;              // the channel's own name is the component alone: the layer is the part, or has no name
    picture_kind picture;   // of a part whose bare channels count as the nameless layer's (picture.h)
} layer_entry;

typedef struct layer_index {
    const exrio_file *file; // borrowed
    layer_entry *entries;
    int count;
} layer_index;

// view: leave out the channels of other stereo views, and say of none which it is of; NULL: all.
bool layers_index(const exrio_file *file, const char *view, layer_index *out, error *e);
void layers_free(layer_index *index);

// A group of channels found for a pattern.
typedef struct layer_group {
    channel_ref channels[4];
    int components;      // 1 or 3
    char key[LAYER_KEY]; // what identifies the view layer: the layer's name before the pattern, and the stereo view
    bool exact;          // the pattern matched in upper and lower case too
} layer_group;

// All groups that match a pattern of conventions.h, at most `most`, in file order.
int layers_match(const layer_index *index, const char *pattern, layer_kind kind, layer_group *out, int most);

// Whether the text is that name, whatever its case and whatever joins its words ("World Position", "world_position").
bool layers_name_is(const char *text, const char *name);

// Whether the entry's layer has all these components.
bool layers_has(const layer_index *index, const layer_entry *entry, const char *components);

// The group of exactly this layer name (case as given first, then any), for an option such as --position.
bool layers_exact(const layer_index *index, const char *layer, layer_kind kind, layer_group *out);

// All channels of this name (case as given first, then any), for the same options: as in the file, without the view, or behind
// the part's name ("depth_left.Z"). Several parts may have one of that name.
int layers_channels(const layer_index *index, const char *name, layer_group *out, int most);

// "PART.CHANNEL" where the file has several parts and the channel does not say it itself, else the channel's name.
void layers_channel_name(const exrio_file *file, channel_ref ref, char *buf, size_t size);

// The channel `component` of the layer that holds `of`; part -1 when there is none.
channel_ref layers_sibling(const layer_index *index, channel_ref of, const char *component);

// "R G B A, Z, N": the nameless channels and the names of the layers, for messages. What does not fit is counted at the end.
void layers_list(const layer_index *index, char *buf, size_t size);

#endif
