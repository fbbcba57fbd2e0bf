// Geometry that no channel's name tells. Internal to the room.
#ifndef SSDO_GBUFFER_GUESS_H
#define SSDO_GBUFFER_GUESS_H

#include "gbuffer/layers.h"

// The only Z of the file that is no vector's, whatever layer it is in ("customDepth.Z").
bool guess_lone_depth(const layer_index *index, layer_group *out);

// The nameless channels of a file that holds one pass, if a word of the file's name is a name of the role in the convention
// table: "depth.exr", "shot_010_P.0001.exr". A scalar role takes the one channel, or the first of three equal ones (colour
// outputs store a depth that way).
bool guess_by_file_name(const layer_index *index, role r, layer_kind kind, layer_group *out);

#endif
