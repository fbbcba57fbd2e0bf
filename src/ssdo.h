// libssdo: the filter as a library. A G-buffer goes in, from memory or from files; occlusion, light and one bounce come out, into
// the caller's memory or as the file that ssdo-filter writes.
//
//     ssdo_context *c = ssdo_create(NULL);
//     ssdo_frame *f = NULL;
//     ssdo_set(c, "env", "sky.exr");
//     ssdo_input in = {sizeof in, .files = (const char *const[]){"in.exr"}, .file_count = 1};
//     if (ssdo_filter(c, &in, &f) == SSDO_OK) ssdo_write(c, f, "out.exr");
//     else fprintf(stderr, "%s\n", ssdo_message(c));
//     ssdo_free_frame(f);
//     ssdo_destroy(c);
//
// Settings are the options of ssdo-filter(1) by their long names and with their words: the manual is the reference, and a setting
// that is not made has the program's default. What is computed, and every byte of a written file, is what the program makes of
// the same settings.
//
// Threads: a context may be used from any thread; calls on one context wait for one another. Contexts are independent of one
// another. All GL work is done on a thread of the context's own, so that the caller's current GL context is never touched. The
// library never exits, prints, tunes malloc or changes an environment variable. It reads those that ssdo-filter(1) names.
//
// Structs begin with their own size, which the caller sets to sizeof: fields are only ever added at the end, and a field that the
// caller does not know is 0. All memory that is passed in is borrowed for the call. Strings are UTF-8.
#ifndef SSDO_H
#define SSDO_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define SSDO_EXPORT __attribute__((visibility("default")))
#else
#define SSDO_EXPORT
#endif

// The number of the interface: that of the shared library's name. It changes when something is taken away.
#define SSDO_INTERFACE 0

// The values are the program's exit codes.
typedef enum ssdo_status {
    SSDO_OK = 0,
    SSDO_USAGE = 2, // a setting or an argument is wrong
    SSDO_BAD_INPUT = 3,
    SSDO_BAD_OUTPUT = 4,
    SSDO_NO_GL = 5, // no usable device, or the device failed
    SSDO_NO_MEMORY = 6,
    SSDO_DOUBT = 7,    // with the setting "strict": it is doubtful what a pass means
    SSDO_STOPPED = 130 // by ssdo_stop
} ssdo_status;

typedef enum ssdo_level { SSDO_WARNING = 1, SSDO_INFORMATION = 2 } ssdo_level;

typedef struct ssdo_setup {
    size_t size; // sizeof(ssdo_setup)
    // Takes warnings, and information if `level` asks for it; one line, without a line end. May be called from threads of the
    // library, by one at a time; must not call the library. NULL: nobody is told.
    void (*message)(void *user, ssdo_level level, const char *text);
    void *user;
    ssdo_level level; // 0: SSDO_WARNING
} ssdo_setup;

typedef enum ssdo_type { SSDO_UINT = 0, SSDO_HALF = 1, SSDO_FLOAT = 2 } ssdo_type;

// A channel of a G-buffer in memory, named as a renderer names it in a file ("N.X", "Z", "albedo.R"): by the name its meaning is
// found, and the settings "position", "normal" and so on prevail.
typedef struct ssdo_channel {
    size_t size; // sizeof(ssdo_channel)
    const char *name;
    ssdo_type type;
    const void *samples;    // of the top left pixel
    ptrdiff_t pixel_stride; // bytes from a pixel to the one right of it; 0: the samples lie side by side
    ptrdiff_t row_stride;   // bytes from a row to the one below; 0: rows follow one another
} ssdo_channel;

typedef enum ssdo_kind { SSDO_TEXT = 0, SSDO_NUMBER = 1, SSDO_MATRIX = 2 } ssdo_kind;

// An entry of the header that a file would have: "worldToCamera", a matrix of 16 numbers, row by row, for row vectors.
typedef struct ssdo_attribute {
    size_t size; // sizeof(ssdo_attribute)
    const char *name;
    ssdo_kind kind;
    const char *text;
    const double *numbers;
} ssdo_attribute;

// A frame: either files (several: the passes of one frame, one file each), or channels in memory.
typedef struct ssdo_input {
    size_t size; // sizeof(ssdo_input)
    const char *const *files;
    int file_count;
    int width, height; // of the channels, in pixels
    const ssdo_channel *channels;
    int channel_count;
    const ssdo_attribute *attributes;
    int attribute_count;
} ssdo_input;

typedef struct ssdo_context ssdo_context;
typedef struct ssdo_frame ssdo_frame;

// A layer of a filtered frame.
typedef struct ssdo_layer {
    size_t size;          // sizeof(ssdo_layer), set by the caller
    const char *name;     // "occlusion"
    const char *channels; // one letter each: "R", "RGB"
    const char *view;     // of a stereo file; NULL for none
    int width, height;
    const float *pixels; // channels of a pixel side by side, rows from the top without gaps, linear; the frame's
} ssdo_layer;

// NULL when memory is short, setup->size is wrong, or the OpenEXR library is of another version than the headers were. `setup`
// may be NULL. Nothing is opened yet.
SSDO_EXPORT ssdo_context *ssdo_create(const ssdo_setup *setup);
SSDO_EXPORT void ssdo_destroy(ssdo_context *c); // NULL is allowed

// Makes a setting; NULL takes it back. A flag ("strict") has the value "" or "1". SSDO_USAGE says in ssdo_message what is wrong
// with the name or the value, and the setting stays as it was. Options that name outputs, list frames or print are no settings.
SSDO_EXPORT ssdo_status ssdo_set(ssdo_context *c, const char *name, const char *value);

// Filters a frame. On success *frame is the caller's to free. The first call opens the device.
SSDO_EXPORT ssdo_status ssdo_filter(ssdo_context *c, const ssdo_input *input, ssdo_frame **frame);

// Makes a running ssdo_filter of this context end soon, with SSDO_STOPPED. From any thread, and from a signal handler; it alone
// does not wait.
SSDO_EXPORT void ssdo_stop(ssdo_context *c);

// What went wrong in the last call on this context that did not return SSDO_OK: one sentence that names file, channel and remedy.
// Valid until the next call.
SSDO_EXPORT const char *ssdo_message(const ssdo_context *c);

// The layers that were made: all views of a stereo file, one after the other.
SSDO_EXPORT int ssdo_layer_count(const ssdo_frame *f);
SSDO_EXPORT ssdo_status ssdo_get_layer(const ssdo_frame *f, int index, ssdo_layer *layer);
// The index of a layer by its name and view (NULL: the first), -1 where there is none.
SSDO_EXPORT int ssdo_find_layer(const ssdo_frame *f, const char *name, const char *view);
// Copies a layer into memory of the caller's with room for `count` floats. SSDO_USAGE where that is not width * height *
// channels.
SSDO_EXPORT ssdo_status ssdo_copy_layer(const ssdo_frame *f, int index, float *to, size_t count);

// Writes the file that the program would write of this frame: whole or not at all. Once for each frame, by the context that
// filtered it.
SSDO_EXPORT ssdo_status ssdo_write(ssdo_context *c, ssdo_frame *f, const char *path);
SSDO_EXPORT void ssdo_free_frame(ssdo_frame *f); // NULL is allowed; outlives its context

// The version of the library, as `ssdo-filter --version` says it.
SSDO_EXPORT const char *ssdo_version(void);

#ifdef __cplusplus
}
#endif
#endif
