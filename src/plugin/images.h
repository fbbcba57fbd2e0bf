// The OpenImageIO module: `extern "C"`, opened with dlopen on demand, because linking it costs every run 290 ms.
//
// Where it is looked for: plugin/module.h.
#ifndef SSDO_PLUGIN_IMAGES_H
#define SSDO_PLUGIN_IMAGES_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"

// All channels of sub-image `part` (level 0) of an image file as float, interleaved, top row first, over its data window. *pixels
// is malloc'ed, the caller frees it. Used for environments that are not EXR.
bool images_read_float(const char *path, int part, int *width, int *height, int *channels, float **pixels, error *e);

// The channels of an EXR part in their stored types (DWA): for each of `count` channel names, data[i] receives malloc'ed samples
// (2 bytes for half, 4 for float and uint) or NULL where names[i] was not wanted (a NULL name).
// The part must be width x height pixels: the file is opened again by its name, and another may have taken its place since.
bool images_read_exr_native(const char *path, int part, int width, int height, int count, const char *const *names,
                            const int *types, void **data, error *e);

// Writes 8-bit RGB, top row first, whole or not at all (base/outfile.h). label: a text that the file carries as `key`.
bool images_write_png(const char *path, int width, int height, const uint8_t *rgb, const char *key, const char *label, error *e);

#endif
