// The names of our channels, and which of the input's they replace.
#ifndef SSDO_PIPELINE_OUTPUT_NAMES_H
#define SSDO_PIPELINE_OUTPUT_NAMES_H

#include "pipeline/result.h"

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
// Whether a channel is made anew, for the view or (where names tell views) any that comes after it in the list. merged: our
// layers are in the channel's own part.
bool name_is_replaced(const job *j, const frame_result *r, const char *channel, bool merged);

// Whether the view is made of the part. Deep parts are copied beside the flat ones, whosever view they are.
bool part_is_of_view(const exrio_part *part, const char *view);
// The name of a part of ours.
void part_name(const frame_result *r, char *name, size_t size);
// Whether an earlier run of ours made the part.
bool part_is_ours(const frame_result *r, int part);

// Input channels that already carry names of ours are replaced if the file says we made them (ssdo/version), else ERR_INPUT
// naming --prefix. Called before any pixel is read, so that a long job does not fail at its end. view: the one to be written.
bool output_check_names(const options *o, const exrio_file *file, const char *view, const plan *p, error *e);

// --layout multipart: true if the part goes through as stored, so that its channels need not be read for writing.
bool output_keeps_chunks(const options *o, const exrio_file *file, int part, const plan *p);

// Whether a channel of the input's part is made anew, or left out with what an earlier run made, instead of being passed through.
// r: the first view, once it was written.
bool output_replaces(const job *j, const frame_result *r, int part, const char *channel);

#endif
