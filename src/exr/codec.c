#include "exr/codec.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "samples are copied as the file stores them, little-endian");

typedef uint8_t bytes16 __attribute__((vector_size(16)));
typedef uint16_t words8 __attribute__((vector_size(16)));
typedef uint64_t longs2 __attribute__((vector_size(16)));
typedef uint8_t bytes8 __attribute__((vector_size(8)));

static bytes16 load(const uint8_t *p)
{
    bytes16 v;
    memcpy(&v, p, sizeof v);
    return v;
}

static void store(uint8_t *p, bytes16 v) { memcpy(p, &v, sizeof v); }

void codec_split(const uint8_t *from, uint8_t *to, uint8_t *scratch, size_t n)
{
    uint8_t *even = scratch, *odd = scratch + (n + 1) / 2;
    size_t i = 0;
    for (; i + 16 <= n; i += 16) {
        words8 w = (words8)load(from + i);
        bytes8 lo = __builtin_convertvector(w & 0xff, bytes8), hi = __builtin_convertvector(w >> 8, bytes8);
        memcpy(even + i / 2, &lo, sizeof lo);
        memcpy(odd + i / 2, &hi, sizeof hi);
    }
    for (; i < n; i++) *(i % 2 ? odd + i / 2 : even + i / 2) = from[i];
    if (n) to[0] = scratch[0];
    for (i = 1; i + 16 <= n; i += 16) store(to + i, load(scratch + i) - load(scratch + i - 1) + 128);
    for (; i < n; i++) to[i] = (uint8_t)(scratch[i] - scratch[i - 1] + 128);
}

// Undoes the differences in place: a running sum, 16 bytes at a time (three shifts sum within eight bytes).
static void running_sum(uint8_t *b, size_t n)
{
    const uint64_t ones = 0x0101010101010101u;
    if (n) b[0] = (uint8_t)(b[0] - 128); // the first byte was stored as it is
    uint8_t sum = 0;
    size_t i = 0;
    for (; i + 16 <= n; i += 16) {
        bytes16 v = load(b + i) + 128;
        v += (bytes16)((longs2)v << 8);
        v += (bytes16)((longs2)v << 16);
        v += (bytes16)((longs2)v << 32);
        uint8_t middle = (uint8_t)(sum + v[7]);
        v += (bytes16)(longs2){sum * ones, middle * ones};
        sum = v[15];
        store(b + i, v);
    }
    for (; i < n; i++) b[i] = sum = (uint8_t)(sum + b[i] + 128);
}

void codec_merge(uint8_t *from, uint8_t *to, size_t n)
{
    running_sum(from, n);
    const uint8_t *even = from, *odd = from + (n + 1) / 2;
    size_t i = 0;
    for (; i + 16 <= n; i += 16) {
        bytes8 lo, hi;
        memcpy(&lo, even + i / 2, sizeof lo);
        memcpy(&hi, odd + i / 2, sizeof hi);
        store(to + i, (bytes16)(__builtin_convertvector(lo, words8) | __builtin_convertvector(hi, words8) << 8));
    }
    for (; i < n; i++) to[i] = i % 2 ? odd[i / 2] : even[i / 2];
}

static bool reserve(codec *c, size_t n)
{
    if (c->scratch_size >= n) return true;
    for (int i = 0; i < 2; i++) {
        free(c->scratch[i]);
        c->scratch[i] = NULL;
    }
    c->scratch_size = 0;
    for (int i = 0; i < 2; i++)
        if (!(c->scratch[i] = mem_pixels(n, 1, NULL))) return false;
    c->scratch_size = n;
    return true;
}

void codec_free(codec *c)
{
    libdeflate_free_compressor(c->deflate);
    libdeflate_free_decompressor(c->inflate);
    for (int i = 0; i < 2; i++) free(c->scratch[i]);
    *c = (codec){0};
}

// --- decoding ---

// Damaged PIZ chunks make the library (3.1.5, fixed later) read past a buffer by up to the size of a Huffman table.
enum { OVERREAD = 1 << 16 };

static void *allocate_padded(exr_transcoding_pipeline_buffer_id_t id, size_t size)
{
    (void)id;
    return size > SIZE_MAX - OVERREAD ? NULL : mem_zero(size + OVERREAD, 1, NULL);
}

static void free_padded(exr_transcoding_pipeline_buffer_id_t id, void *p)
{
    (void)id;
    free(p);
}

static exr_result_t inflate_chunk(exr_decode_pipeline_t *p)
{
    codec *c = p->decoding_user_data;
    size_t packed = p->chunk.packed_size, size = p->chunk.unpacked_size;
    if (packed == size) return EXR_ERR_SUCCESS; // stored as it is; both buffers are the same one
    if (!reserve(c, size)) return EXR_ERR_OUT_OF_MEMORY;
    if (libdeflate_zlib_decompress(c->inflate, p->packed_buffer, packed, c->scratch[0], size, NULL) != LIBDEFLATE_SUCCESS)
        return EXR_ERR_CORRUPT_CHUNK;
    codec_merge(c->scratch[0], p->unpacked_buffer, size);
    return EXR_ERR_SUCCESS;
}

static exr_result_t unpack_rows(exr_decode_pipeline_t *p)
{
    const uint8_t *from = p->unpacked_buffer;
    for (int y = 0; y < p->chunk.height; y++) {
        for (int i = 0; i < p->channel_count; i++) {
            const exr_coding_channel_info_t *ch = &p->channels[i];
            size_t row = (size_t)ch->width * (size_t)ch->bytes_per_element;
            if (ch->decode_to_ptr) memcpy(ch->decode_to_ptr + (ptrdiff_t)y * ch->user_line_stride, from, row);
            from += row;
        }
    }
    return EXR_ERR_SUCCESS;
}

exr_result_t codec_attach_decoder(codec *c, exr_const_context_t core, int part, exr_decode_pipeline_t *p)
{
    exr_result_t rv = exr_decoding_choose_default_routines(core, part, p);
    if (rv != EXR_ERR_SUCCESS) return rv;
    p->decoding_user_data = c;
    p->unpack_and_convert_fn = unpack_rows;
    p->alloc_fn = allocate_padded;
    p->free_fn = free_padded;
    if (p->chunk.compression != EXR_COMPRESSION_ZIP && p->chunk.compression != EXR_COMPRESSION_ZIPS) return rv;
    if (!c->inflate && !(c->inflate = libdeflate_alloc_decompressor())) return EXR_ERR_OUT_OF_MEMORY;
    p->decompress_fn = inflate_chunk;
    return rv;
}

// --- encoding ---

enum { COMPRESSED_ROOM = 1 << 16 }; // beyond the size of what is compressed, an eighth of it besides

// The library holds its lock while this runs, so the packing itself waits until compress_chunk.
static exr_result_t announce_size(exr_encode_pipeline_t *p)
{
    p->packed_bytes = p->chunk.unpacked_size;
    return EXR_ERR_SUCCESS;
}

static void pack_rows(exr_encode_pipeline_t *p)
{
    uint8_t *to = p->packed_buffer;
    for (int y = 0; y < p->chunk.height; y++) {
        for (int i = 0; i < p->channel_count; i++) {
            const exr_coding_channel_info_t *ch = &p->channels[i];
            size_t row = (size_t)ch->width * (size_t)ch->bytes_per_element;
            memcpy(to, ch->encode_from_ptr + (ptrdiff_t)y * ch->user_line_stride, row);
            to += row;
        }
    }
}

// Lets the packed bytes stand for the compressed ones, as the library does (a size of zero: not a buffer of its own).
static void store_raw(exr_encode_pipeline_t *p)
{
    if (p->compressed_buffer && p->compressed_alloc_size) free(p->compressed_buffer);
    p->compressed_buffer = p->packed_buffer;
    p->compressed_alloc_size = 0;
    p->compressed_bytes = p->packed_bytes;
}

static exr_result_t take_compressed(exr_encode_pipeline_t *p, size_t size)
{
    if (p->compressed_buffer && p->compressed_alloc_size >= size) return EXR_ERR_SUCCESS;
    if (p->compressed_alloc_size) free(p->compressed_buffer);
    p->compressed_alloc_size = 0;
    if (!(p->compressed_buffer = mem_zero(size, 1, NULL))) return EXR_ERR_OUT_OF_MEMORY;
    p->compressed_alloc_size = size;
    return EXR_ERR_SUCCESS;
}

static exr_result_t deflate_chunk(exr_encode_pipeline_t *p, codec *c)
{
    size_t size = p->packed_bytes;
    if (!reserve(c, size)) return EXR_ERR_OUT_OF_MEMORY;
    codec_split(p->packed_buffer, c->scratch[0], c->scratch[1], size);
    if (take_compressed(p, size) != EXR_ERR_SUCCESS) return EXR_ERR_OUT_OF_MEMORY;
    // One byte less than the raw size: readers take a chunk of that very size for a raw one.
    p->compressed_bytes = libdeflate_zlib_compress(c->deflate, c->scratch[0], size, p->compressed_buffer, size - 1);
    if (!p->compressed_bytes) store_raw(p);
    return EXR_ERR_SUCCESS;
}

static exr_result_t compress_chunk(exr_encode_pipeline_t *p)
{
    codec *c = p->encoding_user_data;
    pack_rows(p);
    exr_result_t rv = EXR_ERR_SUCCESS;
    switch (p->chunk.compression) {
    case EXR_COMPRESSION_NONE:
        store_raw(p);
        return rv;
    case EXR_COMPRESSION_ZIP:
    case EXR_COMPRESSION_ZIPS:
        return deflate_chunk(p, c);
    case EXR_COMPRESSION_B44:
    case EXR_COMPRESSION_B44A:
        return c->compress_fn(p); // readers always decode these
    default:
        // PIZ puts a bitmap of up to 8 KiB and a table before the data, which noise does not make shorter: up to 3.2 the library
        // does not look whether they fit, and from 3.3 on it gives up where they do not.
        rv = take_compressed(p, p->packed_bytes + p->packed_bytes / 8 + COMPRESSED_ROOM);
        if (rv == EXR_ERR_SUCCESS) rv = c->compress_fn(p);
        if (rv == EXR_ERR_SUCCESS && p->compressed_bytes >= p->packed_bytes) store_raw(p);
        return rv;
    }
}

static void *allocate_plain(exr_transcoding_pipeline_buffer_id_t id, size_t size)
{
    (void)id;
    return mem_zero(size, 1, NULL);
}

exr_result_t codec_attach_encoder(codec *c, exr_const_context_t core, int part, exr_encode_pipeline_t *p)
{
    exr_result_t rv = exr_encoding_choose_default_routines(core, part, p);
    if (rv != EXR_ERR_SUCCESS) return rv;
    c->compress_fn = p->compress_fn;
    p->encoding_user_data = c;
    p->convert_and_pack_fn = announce_size;
    p->compress_fn = compress_chunk;
    p->yield_until_ready_fn = NULL;
    p->write_fn = NULL;
    p->alloc_fn = allocate_plain;
    p->free_fn = free_padded;
    if (!c->deflate && !(c->deflate = libdeflate_alloc_compressor(c->level))) return EXR_ERR_OUT_OF_MEMORY;
    return rv;
}
