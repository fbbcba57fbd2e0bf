// The pictures of a frame: one row each in passes/image_rows.h, of which making, freeing, upload, read-back, edges, upsampling,
// proxies, previews and reports are made.
#ifndef SSDO_PASSES_IMAGES_H
#define SSDO_PASSES_IMAGES_H

#include <epoxy/gl.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

struct pass_context;

typedef enum image_id {
#define IMAGE(id, ...) IMAGE_##id,
#define LAYER(id, ...) IMAGE_##id,
#define PASS_LAYER(id, pass, ...) IMAGE_##id,
#include "passes/image_rows.h"
#undef IMAGE
#undef LAYER
#undef PASS_LAYER
    IMAGE_COUNT
} image_id;

typedef enum layer_id {
#define IMAGE(id, ...)
#define LAYER(id, ...) LAYER_##id,
#define PASS_LAYER(id, pass, ...) LAYER_##id,
#include "passes/image_rows.h"
#undef IMAGE
#undef LAYER
#undef PASS_LAYER
    LAYER_COUNT
} layer_id;

// Bits 1 << image_id.
typedef uint64_t image_set;
_Static_assert(IMAGE_COUNT <= 64, "an image_set has no bit left");
#define IMAGE_BIT(id) ((uint64_t)1 << (id))

enum {
    LAYER_CHANNELS = 7, // of a layer, at most
    SH_IMAGES = 5       // from IMAGE_SH_0 on
};

// How an image comes from a frame of half the size.
typedef enum image_resampling {
    AS_NOTHING, // it is made at full size, if at all
    AS_SCALAR,
    AS_COLOUR,
    AS_OPEN_LIGHT, // as a colour; a pixel that finds no surface gets the light of an open hemisphere
} image_resampling;

// What happens to it later, bits.
enum {
    IMAGE_FILLED = 1 << 0,  // by pass_edges: in pixels that a surface covers in part but that have no position
    IMAGE_BLOCKED = 1 << 1, // by proxies
    IMAGE_VECTOR = 1 << 2,  // both, but in a run of its own: the images of the SH vector fill one program
};

// What a sample can be. NaN and infinity none can.
typedef enum layer_range {
    RANGE_ANY,
    RANGE_LIGHT,     // not negative
    RANGE_SHARE,     // 0 to 1
    RANGE_DIRECTION, // of unit length, in the space of the file's normals
} layer_range;

// How a preview shows it.
typedef enum layer_display {
    DISPLAY_SHARE,     // as it is
    DISPLAY_LIGHT,     // exposed, through the display's curve
    DISPLAY_PICTURE,   // light, and where there is no surface too
    DISPLAY_SIGNED,    // 0 as grey
    DISPLAY_DARKENING, // 0 as white
    DISPLAY_ERROR,     // twice the error that was asked for as white
} layer_display;

typedef struct image_row {
    const char *name; // in reports; of a layer, in files
    GLenum format;
    float neutral; // each component, until a pass fills it
    bool given;    // the G-buffer has it,
    size_t pixels; // there (offset of a float *, NULL where there is none)
    image_resampling resampled;
    unsigned groups;
    const char *word, *slot; // in the shaders of those groups: the word that says that it is there, and its name
    // Of layers.
    image_id image;       // this one; sh_3 goes on in the next
    image_id otherwise;   // what is written where it was not made; IMAGE_DEPTH: it must have been
    const char *channels; // one letter each, "RGB"
    layer_range range;
    layer_display display;
    bool by_default;
    bool (*pass)(struct pass_context *c, error *e); // that makes it and is run for nothing else; NULL: none
} image_row;

// The passes of those rows.
#define IMAGE(id, ...)
#define LAYER(id, ...)
#define PASS_LAYER(id, pass, ...) bool pass(struct pass_context *c, error *e);
#include "passes/image_rows.h"
#undef IMAGE
#undef LAYER
#undef PASS_LAYER

extern const image_row image_table[IMAGE_COUNT];
extern const image_row *const layer_table[LAYER_COUNT];

#endif
