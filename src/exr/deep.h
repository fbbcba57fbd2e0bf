// Deep scanline parts beside the flat ones: their chunks as they are stored, without looking into them. Internal to the room.
#ifndef SSDO_EXR_DEEP_H
#define SSDO_EXR_DEEP_H

#include "exr/internal.h"

typedef struct deep_chunk {
    exr_chunk_info_t info;
    void *packed, *counts; // owned; grown as needed
    uint64_t packed_capacity, counts_capacity;
} deep_chunk;

// The chunk that holds line y.
exr_result_t deep_read(exr_const_context_t core, int part, int y, deep_chunk *out);
void deep_free(deep_chunk *chunk);

// Writes the chunks of a deep scanline part (p->attributes_from) to part `index` of `core` as they are stored. A chunk of the
// input that cannot be read is ERR_INPUT naming that file.
exr_result_t deep_copy(exr_context_t core, int index, const exrio_out_part *p, int lines_per_chunk, int chunks, error *e);

#endif
