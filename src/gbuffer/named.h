// The layer or channel that the command line names (--depth, --position and the like), in the channels of one view. Internal to
// the room.
#ifndef SSDO_GBUFFER_NAMED_H
#define SSDO_GBUFFER_NAMED_H

#include "gbuffer/layers.h"

typedef struct named_search {
    const layer_index *index;
    const resolve_options *options; // whose view and view layer count
    const char *key;                // of the view layer that was chosen
    error *e;
} named_search;

// A channel's name, three of them with commas between (for kinds of three), or a layer's. A name that several channels of the
// view have, of which the view layer does not choose one, is ERR_INPUT naming them; so is one that only another view has, with
// that view; so is one that nothing has, with what there is. flag: for messages.
bool named_find(const named_search *s, const char *name, layer_kind kind, const char *flag, layer_group *out);

#endif
