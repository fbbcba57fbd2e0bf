// Packing rows and the ZIP codec, plugged into the library's chunk pipelines.
//
// A chunk holds, line by line, the line's samples of each channel in turn. ZIP and ZIPS split the chunk's bytes into those at
// even and those at odd places, replace each byte by its difference to the one before plus 128, and deflate the result. The
// library does the latter with zlib and byte by byte; libdeflate and wide loops are five times faster at the same format.
#ifndef SSDO_EXR_CODEC_H
#define SSDO_EXR_CODEC_H

#include <stddef.h>
#include <stdint.h>

#include <libdeflate.h>
#include <openexr.h>

// One thread's codec. Zero it before the first use; codec_free when done. Pipelines point at it with their user data.
typedef struct codec {
    struct libdeflate_compressor *deflate;
    struct libdeflate_decompressor *inflate;
    uint8_t *scratch[2];
    size_t scratch_size;
    int level;                                            // deflate level for encoding, 1..12
    exr_result_t (*compress_fn)(exr_encode_pipeline_t *); // the library's own, for the other compressions
} codec;

void codec_free(codec *c);

// Completes a pipeline that was initialised: call it while no channel of it has a pointer yet (the library would choose to read
// an uncompressed chunk line by line), then set for the channels that are wanted their pointer and line stride.
exr_result_t codec_attach_decoder(codec *c, exr_const_context_t core, int part, exr_decode_pipeline_t *p);

// The same for writing; every channel must then get a pointer and a line stride. The pipeline writes nothing: after
// exr_encoding_run the chunk's bytes are in compressed_buffer, compressed_bytes of them.
exr_result_t codec_attach_encoder(codec *c, exr_const_context_t core, int part, exr_encode_pipeline_t *p);

// The two reversible steps around deflate, for n bytes; `from`, `to` and `scratch` do not overlap. For tests.
void codec_split(const uint8_t *from, uint8_t *to, uint8_t *scratch, size_t n);
void codec_merge(uint8_t *from, uint8_t *to, size_t n); // spoils `from`

#endif
