// The OpenImageIO module: `extern "C"`, opened with dlopen on demand, because linking it costs every run 290 ms.
//
// Where it is looked for: plugin/module.h.
#ifndef SSDO_PLUGIN_IMAGES_H
#define SSDO_PLUGIN_IMAGES_H

#include <stdbool.h>
#include <stdint.h>

#include "base/error.h"
#include "plugin/images_abi.h"

// All channels of sub-image `part` (level 0) of an image file as float, interleaved, a band of rows of its data window after the
// other (images_abi.h says how), so that the whole is never in memory. False with e->code ERR_NONE if `take` stopped. Used for
// environments that are not EXR.
bool images_read_rows(const char *path, int part, images_take_fn take, void *context, error *e);

// Writes 8-bit RGB, top row first, whole or not at all (base/outfile.h). label: a text that the file carries as `key`.
bool images_write_png(const char *path, int width, int height, const uint8_t *rgb, const char *key, const char *label, error *e);

// Whether images_write_png has its module; path: for the error alone.
bool images_check_png(const char *path, error *e);

#endif
