// Writing an OpenEXR file, whole or not at all.
//
// The file is written under a temporary name in the target's folder (host, process and random number in it), flushed to disk and
// renamed onto the target; on any failure the temporary file is removed and an older target stays as it was. Chunks are encoded
// on several threads and stored in order, so the bytes do not depend on the number of threads. No time stamp is written.
#ifndef SSDO_EXR_WRITE_H
#define SSDO_EXR_WRITE_H

#include "base/error.h"
#include "exr/file.h"

typedef struct exrio_out_channel {
    const char *name;
    sample_type type;
    const void *data; // width * height samples of `type`, the part's data window, borrowed
} exrio_out_channel;

// (OpenEXR owns the names EXR_ATTR_*.)
typedef enum exrio_attr_kind {
    EXRIO_OUT_STRING,
    EXRIO_OUT_FLOAT,
    EXRIO_OUT_M44,
    EXRIO_OUT_CHROMATICITIES,
    EXRIO_OUT_STRINGS
} exrio_attr_kind;

typedef struct exrio_out_attr {
    const char *name;
    exrio_attr_kind kind;
    const char *string;
    double number;
    double m44[4][4];
    double xy[8]; // as exrio_attr_chromaticities gives them
    const char *strings[EXRIO_VIEWS];
    int string_count;
} exrio_out_attr;

// A part of an open file, numbered as in that very file (exrio_part_file).
typedef struct exrio_source {
    const exrio_file *file;
    int part;
} exrio_source;

typedef struct exrio_out_part {
    const char *name, *view; // NULL or "" for none; a multi-part file needs distinct names
    box2 data_window, display_window;
    float pixel_aspect;
    int compression;             // exr_compression_t's value
    int level;                   // zip level, 0 = the writer's default
    exrio_out_channel *channels; // any order; stored sorted by name, as the format demands
    int channel_count;
    bool verbatim; // copy the chunks of attributes_from's part as they are stored; only if exrio_part_is_verbatim says so.
                   // channels: all of that part's, with data NULL
    bool deep;     // the same of a deep part's lines; verbatim only
    const exrio_file
        *attributes_from; // every attribute of this part that is not structural is copied, NULL for none; exrio_part_file
    int attributes_part;
    const exrio_source *also; // more parts to copy attributes from, in this order, as far as their names are new; borrowed
    int also_count;
    const exrio_out_attr *attributes; // ours; they replace copied ones of the same name
    int attribute_count;
} exrio_out_part;

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
