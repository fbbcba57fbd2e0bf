// An OpenEXR file in memory: headers of all parts, and the pixels of the channels that were asked for.
//
// Reading goes through OpenEXRCore; pixels compressed with DWAA/DWAB, where it does not decode them (exr/library.h), through a
// module (plugin/dwa.h), opened on demand. Single and multi-part, scanline and tiled (level 0 only), any line
// order, half/float/uint. Subsampled channels are refused with ERR_INPUT, and so is a file
// that holds deep parts only; a deep part beside a flat one can be copied, and is not looked into. Samples keep their stored type
// and bits: nothing is converted, so that what is passed through is unchanged. All sizes in the header are checked before memory
// is taken for them.
//
// Pixel space: row-major over the part's own data window, top row first whatever the file's line order.
#ifndef SSDO_EXR_FILE_H
#define SSDO_EXR_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"
#include "base/half.h"

typedef enum sample_type { SAMPLE_UINT = 0, SAMPLE_HALF = 1, SAMPLE_FLOAT = 2 } sample_type; // OpenEXR's own numbers

enum { EXRIO_VIEWS = 16 }; // of one part, at most

typedef struct box2 {
    int x0, y0, x1, y1;
} box2; // inclusive, as in the file

static inline size_t sample_size(sample_type t) { return t == SAMPLE_HALF ? 2u : 4u; }
// Element i of a channel's data.
static inline float sample_value(sample_type t, const void *data, size_t i)
{
    if (t == SAMPLE_HALF) return half_to_float(((const uint16_t *)data)[i]);
    return t == SAMPLE_FLOAT ? ((const float *)data)[i] : (float)((const uint32_t *)data)[i];
}
static inline int box2_width(box2 b) { return b.x1 - b.x0 + 1; }
static inline int box2_height(box2 b) { return b.y1 - b.y0 + 1; }
static inline bool box2_equal(box2 a, box2 b) { return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1; }

typedef struct exrio_channel {
    char *name;
    char *stored;     // its name in the file, where exrio_file_open_all gave it another; else NULL
    const char *view; // the stereo view that its name says, one of the part's views; NULL for none
    sample_type type;
    bool wanted; // set before exrio_file_load: read this channel's pixels
    void *data;  // width * height samples of `type`, native byte order; NULL until loaded
} exrio_channel;

typedef struct exrio_part {
    char *name; // "" when the file gives none
    char *view; // "" when the file gives none
    // Single-part stereo: the views that channel names tell apart (layer.right.R), by the attribute multiView, the default view
    // first. None (0) where fewer than two of them have channels.
    char *views[EXRIO_VIEWS];
    int view_count;
    box2 data_window, display_window;
    float pixel_aspect;
    int compression; // exr_compression_t's value
    bool tiled;
    bool deep;               // its pixels cannot be looked at: no channel is ever loaded
    exrio_channel *channels; // in the file's order
    int channel_count;
} exrio_part;

typedef struct exrio_file {
    char *path;
    exrio_part *parts;
    int part_count;
    void *core;                  // OpenEXRCore's context, open until exrio_file_close; attributes are read and copied from it
    struct exrio_file **members; // the files that exrio_file_open_all put together; NULL for a file of its own
    int member_count;
} exrio_file;

// The bytes of an open file's headers and its first chunk table, 0 for a file that is no OpenEXR file. False with an error if the
// system refuses to read them.
bool exrio_head_bytes(const char *path, int fd, size_t size, uint64_t *head, error *e);

// Opens and checks the headers of all parts; reads no pixels. On failure *out is NULL and e names the file.
bool exrio_file_open(const char *path, exrio_file **out, error *e);

// Several files of one frame (one pass per file) as one, with the parts of all; one file is opened as it is. A channel without a
// layer in a single-part file (R, X, Z) is put under the pass the file is for, which is what tells its name from the others',
// without the frame number: R of shot_P.0001.exr beside shot_N.0001.exr becomes P.R. The picture itself (beauty, rgba, or no word
// of its own) keeps its names. ERR_INPUT names the file whose display window or pixel aspect differs from the first's (data
// windows may), and a channel that two files hold.
bool exrio_file_open_all(const char *const *paths, int count, exrio_file **out, error *e);

// The file that a part comes from: `file` itself unless it was put together. *part becomes its number there.
const exrio_file *exrio_part_file(const exrio_file *file, int *part);

// The channel's name without its view: "layer.R" of "layer.right.R" (or of "right.layer.R").
void exrio_name_without_view(const exrio_channel *c, char *out, size_t size);
// The way back, by OpenEXR's rule: the view stands before the component, but a name of one word stays so in the default view.
void exrio_name_with_view(const char *name, const char *view, bool is_default, char *out, size_t size);

// Reads the pixels of every channel with `wanted` set and no data yet, on `threads` threads. A truncated or damaged chunk is
// ERR_INPUT. A file that lost its end fails whole: no half-read data is left behind as if it were good.
bool exrio_file_load(exrio_file *file, int threads, error *e);

// Frees everything, pixels included. NULL is allowed.
void exrio_file_close(exrio_file *file);

// Attributes of a part. Each returns false when the attribute is missing or of another type; nothing is printed.
bool exrio_attr_string(const exrio_file *file, int part, const char *name, const char **value); // valid until close
bool exrio_attr_float(const exrio_file *file, int part, const char *name, double *value);       // int, float or double
bool exrio_attr_m44(const exrio_file *file, int part, const char *name, double m[4][4]); // m44f or m44d, as stored: row vectors
bool exrio_attr_v2(const exrio_file *file, int part, const char *name, double v[2]);     // v2f
bool exrio_attr_chromaticities(const exrio_file *file, int part,
                               double xy[8]); // red, green, blue, white: x y each; by exrio_attr_part
// Up to `most` strings of a string vector into values, valid until close; returns how many.
int exrio_attr_strings(const exrio_file *file, int part, const char *name, const char **values, int most);
// Where to look for what is said once for several parts (the camera, primaries): `part` if it has the attribute, else the first
// of the same view that has it, else `part`.
int exrio_attr_part(const exrio_file *file, int part, const char *name);
bool exrio_attr_exists(const exrio_file *file, int part, const char *name);
bool exrio_attr_begins(const exrio_file *file, int part, const char *beginning, size_t n); // any name with these n bytes in front

#endif
