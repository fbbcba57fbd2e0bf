// The names of our channels, and which of the input's they replace.
#ifndef SSDO_PIPELINE_OUTPUT_NAMES_H
#define SSDO_PIPELINE_OUTPUT_NAMES_H

#include "pipeline/frame.h"

enum { NAME_SIZE = 128 };

// What a name in a file of ours depends on.
typedef struct naming {
    const options *o;
    const exrio_file *file;
    const char *view; // NULL without views
} naming;

naming naming_of(const job *j, const frame_result *r);

// Writes the full name of a layer's channel, of NAME_SIZE.
void layer_channel(const naming *n, const char *layer, char component, char *name);
// Whether the channel has the name of one that the plan makes.
bool name_is_ours(const naming *n, const plan *p, const char *channel);
// R, G, B and A of the view, which --main composite replaces.
bool name_is_main(const naming *n, const char *channel);

#endif
