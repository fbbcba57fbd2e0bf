// DWA compression by OpenEXR's C++ library, for an OpenEXRCore that lacks it (exr/library.h): a module, opened on demand. Where
// it is looked for: plugin/module.h.
#ifndef SSDO_PLUGIN_DWA_H
#define SSDO_PLUGIN_DWA_H

#include <stdbool.h>

#include "base/error.h"
#include "plugin/dwa_abi.h"

typedef struct dwa_module {
    dwa_open_fn open;
    dwa_decode_fn decode;
    dwa_close_fn close;
} dwa_module;

// path: the file that needs it, for the error, which is ERR_INPUT.
bool dwa_module_open(const char *path, dwa_module *out, error *e);

#endif
