// The OpenColorIO module: `extern "C"`, opened on demand (plugin/module.h).
#ifndef SSDO_PLUGIN_COLOUR_H
#define SSDO_PLUGIN_COLOUR_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"

// Converts n interleaved RGB pixels in place from colour space `from` to the config's scene_linear role. `config` is the path of
// an OCIO config; NULL takes the one $OCIO names. ERR_INPUT names the config and, for an unknown space, those it has.
bool colour_to_scene_linear(const char *config, const char *from, float *rgb, size_t n, error *e);

// Converts n interleaved scene-linear RGB pixels in place to what the display shows under the view, encoded; NULL: the config's
// default display, and that display's default view. ERR_INPUT names the config and, for an unknown name, those it has.
bool colour_to_display(const char *config, const char *display, const char *view, float *rgb, size_t n, error *e);

enum { COLOUR_IDENTITY = 512 };

// What a conversion computes, as a text that changes with the config, the look-up tables it names and the environment variables
// it reads: from `from` to scene_linear or, where that is NULL, from there to the display. Errors as those of the conversion.
bool colour_identity(const char *config, const char *from, const char *display, const char *view, char text[COLOUR_IDENTITY],
                     error *e);

// The config that would be used: `config`, else what $OCIO names, else NULL.
const char *colour_config(const char *config);

#endif
