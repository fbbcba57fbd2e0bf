#include "exr/deep.h"

#include <stdlib.h>

#include "base/mem.h"

static bool reserve(void **buffer, uint64_t *capacity, uint64_t n)
{
    if (n <= *capacity) return true;
    if (n > EXRIO_MAX_CHUNK_BYTES) return false;
    void *grown = mem_grow(*buffer, (size_t)n, 1, NULL);
    if (!grown) return false;
    *buffer = grown;
    *capacity = n;
    return true;
}

exr_result_t deep_read(exr_const_context_t core, int part, int y, deep_chunk *c)
{
    exr_result_t rv = exr_read_scanline_chunk_info(core, part, y, &c->info);
    if (rv != EXR_ERR_SUCCESS) return rv;
    if (!reserve(&c->packed, &c->packed_capacity, c->info.packed_size) ||
        !reserve(&c->counts, &c->counts_capacity, c->info.sample_count_table_size))
        return EXR_ERR_OUT_OF_MEMORY;
    return exr_read_deep_chunk(core, part, &c->info, c->packed, c->counts);
}

void deep_free(deep_chunk *c)
{
    free(c->packed);
    free(c->counts);
}

exr_result_t deep_copy(exr_context_t core, int index, const exrio_out_part *p, int lines_per_chunk, int chunks, error *e)
{
    deep_chunk c = {0};
    exr_result_t rv = EXR_ERR_SUCCESS;
    for (int i = 0; rv == EXR_ERR_SUCCESS && i < chunks; i++) {
        rv = deep_read(p->attributes_from->core, p->attributes_part, p->data_window.y0 + i * lines_per_chunk, &c);
        if (rv != EXR_ERR_SUCCESS && rv != EXR_ERR_OUT_OF_MEMORY)
            err_set(
                e, ERR_INPUT, p->attributes_from->path, NULL,
                "its deep part '%s' is truncated or damaged (%s); render it or copy it again, or leave it out with --keep none",
                p->name, exr_get_default_error_message(rv));
        if (rv == EXR_ERR_SUCCESS)
            rv = exr_write_deep_scanline_chunk(core, index, c.info.start_y, c.packed, c.info.packed_size, c.info.unpacked_size,
                                               c.counts, c.info.sample_count_table_size);
    }
    deep_free(&c);
    return rv;
}
