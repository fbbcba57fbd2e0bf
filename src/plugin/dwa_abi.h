// The border between the program (C) and the module ssdo-dwa.so (C++): what dwa_shim.cpp exports and dwa.c looks up.
#ifndef SSDO_PLUGIN_DWA_ABI_H
#define SSDO_PLUGIN_DWA_ABI_H

#include <stddef.h>
#include <stdint.h>

typedef enum dwa_result { DWA_OK, DWA_DAMAGED, DWA_MEMORY } dwa_result;

// The file. read: up to n bytes from `offset` on; returns how many there are. Called from the thread that opens or decodes.
typedef struct dwa_source {
    void *context;
    uint64_t size;
    size_t (*read)(void *context, void *to, size_t n, uint64_t offset);
} dwa_source;

// The window, inclusive, must be the part's data window.
typedef struct dwa_part {
    int index, x0, y0, x1, y1;
} dwa_part;

// A channel of that part, all of whose samples have room at `samples`: row-major, the window's top left one first, in their
// stored type (0 uint, 1 half, 2 float).
typedef struct dwa_channel {
    const char *name;
    int type;
    void *samples;
} dwa_channel;

// Open makes a decoder, which borrows the source and lives until close; decode fills rows first to last, inclusive, of the
// channels. One decoder is used by one thread at a time. Where the result is not DWA_OK, `message` holds a sentence.
typedef dwa_result (*dwa_open_fn)(const dwa_source *source, const dwa_part *part, void **decoder, char *message,
                                  size_t message_size);
typedef dwa_result (*dwa_decode_fn)(void *decoder, const dwa_channel *channels, int count, int first, int last, char *message,
                                    size_t message_size);
typedef void (*dwa_close_fn)(void *decoder);

#endif
