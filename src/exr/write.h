// Writing an OpenEXR file, whole or not at all.
//
// The file is written under a temporary name in the target's folder (host, process and random number in it), flushed to disk and
// renamed onto the target; on any failure the temporary file is removed and an older target stays as it was. Chunks are encoded
// on several threads and stored in order, so the bytes do not depend on the number of threads. No time stamp is written.
#ifndef SSDO_EXR_WRITE_H
#define SSDO_EXR_WRITE_H

#include "base/error.h"
#include "exr/out_part.h"

// What is asked about the file once all of it is on the disk and before it takes its name: false, with *e filled, and it is not
// kept. `written` is its temporary name.
typedef struct exrio_inspector {
    bool (*look)(const void *context, const char *written, error *e);
    const void *context;
} exrio_inspector;

// exrio_write with an inspector; NULL for none.
bool exrio_write_inspected(const char *path, const exrio_out_part *parts, int part_count, int threads,
                           const exrio_inspector *inspector, error *e);

// Writes scanline parts. Two channels of one name in a part, or two parts of one name, are ERR_OUTPUT.
bool exrio_write(const char *path, const exrio_out_part *parts, int part_count, int threads, error *e);

// Writes to a file that has no name and lies in memory; the descriptor is the caller's to close, -1 on failure. /proc/self/fd/N
// opens it.
int exrio_write_memory(const exrio_out_part *parts, int part_count, int threads, error *e);

// True if a part's chunks can stand in a file of ours as they are: scanlines, nothing subsampled.
bool exrio_part_is_verbatim(const exrio_part *part);

// n floats (reading every `stride`-th) into halves. NaN becomes 0, values beyond +-65504 are clamped; returns how many were
// changed.
size_t exrio_to_half(const float *from, size_t stride, size_t n, uint16_t *to);

#endif
