// A part of a file that will be written: its channels and attributes. Everything is borrowed.
#ifndef SSDO_EXR_OUT_PART_H
#define SSDO_EXR_OUT_PART_H

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

#endif
