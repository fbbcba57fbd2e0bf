#include "exr/deep.h"

#include <stdlib.h>

#include "base/mem.h"

static bool reserve(void **buffer, uint64_t *room, uint64_t n)
{
    if (n <= *room) return true;
    if (n > EXR_MAX_CHUNK_BYTES) return false;
    void *grown = mem_grow(*buffer, (size_t)n, 1, NULL);
    if (!grown) return false;
    *buffer = grown;
    *room = n;
    return true;
}

exr_result_t deep_copy(exr_context_t core, int index, const exr_out_part *p, int lines_per_chunk, int chunks)
{
    exr_const_context_t in = p->attributes_from->core;
    void *packed = NULL, *counts = NULL;
    uint64_t packed_room = 0, counts_room = 0;
    exr_result_t rv = EXR_ERR_SUCCESS;
    for (int i = 0; rv == EXR_ERR_SUCCESS && i < chunks; i++) {
        exr_chunk_info_t c;
        rv = exr_read_scanline_chunk_info(in, p->attributes_part, p->data_window.y0 + i * lines_per_chunk, &c);
        if (rv != EXR_ERR_SUCCESS) break;
        if (!reserve(&packed, &packed_room, c.packed_size) || !reserve(&counts, &counts_room, c.sample_count_table_size)) {
            rv = EXR_ERR_OUT_OF_MEMORY;
            break;
        }
        rv = exr_read_deep_chunk(in, p->attributes_part, &c, packed, counts);
        if (rv == EXR_ERR_SUCCESS)
            rv = exr_write_deep_scanline_chunk(core, index, c.start_y, packed, c.packed_size, c.unpacked_size, counts,
                                               c.sample_count_table_size);
    }
    free(packed);
    free(counts);
    return rv;
}
