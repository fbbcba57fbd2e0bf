// The OpenColorIO module: `extern "C"`, opened on demand (plugin/module.h).
#ifndef SSDO_PLUGIN_COLOUR_H
#define SSDO_PLUGIN_COLOUR_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"

// Converts n interleaved RGB pixels in place from colour space `from` to the config's scene_linear role. `config` is the path of
// an OCIO config; NULL takes the one $OCIO names. ERR_INPUT names the config and, for an unknown space, those it has.
bool colour_to_scene_linear(const char *config, const char *from, float *rgb, size_t n, error *e);

#endif
