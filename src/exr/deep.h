// Copying a deep part beside the flat ones: chunk by chunk, without looking into it. Internal to the room.
#ifndef SSDO_EXR_DEEP_H
#define SSDO_EXR_DEEP_H

#include "exr/internal.h"

// Writes the chunks of a deep scanline part (p->attributes_from) to part `index` of `core` as they are stored.
exr_result_t deep_copy(exr_context_t core, int index, const exr_out_part *p, int lines_per_chunk, int chunks);

#endif
