// Modules of ours, opened with dlopen on demand, that hold the C++ libraries: nobody pays for what a run does not use.
//
// A module is looked for beside the executable, in ../lib/ssdo-filter beside the executable's folder, then in the installed
// folder (SSDO_LIBDIR at build time); the environment variable SSDO_PLUGIN_DIR comes first. No C++ exception crosses the border.
#ifndef SSDO_PLUGIN_MODULE_H
#define SSDO_PLUGIN_MODULE_H

#include "base/error.h"

typedef struct module {
    const char *file;    // "ssdo-images.so"
    const char *library; // what it wraps, as a user installs it
} module;

enum { MODULE_MESSAGE = 512 }; // room for a sentence from the other side

// Any function; whoever gets one casts it to the type that it has.
typedef void (*module_call)(void);

// The function `name` of the module, or NULL after filling *e with what needs it (`purpose`) and where it was looked for.
module_call module_function(const module *m, const char *name, const char *purpose, error_code code, const char *file, error *e);

#endif
