// The OpenEXR that runs against the OpenEXR that the program was compiled for.
#ifndef SSDO_EXR_LIBRARY_H
#define SSDO_EXR_LIBRARY_H

#include "base/error.h"

// Within one minor version OpenEXR keeps its layout; between two, contexts have another size and every file would be refused as
// damaged. ERR_INPUT, since no file can be read, naming both versions and the library's file.
bool exrio_library_check(error *e);

#endif
