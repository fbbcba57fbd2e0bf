// The OpenEXR that runs against the OpenEXR that the program was compiled for.
#ifndef SSDO_EXR_LIBRARY_H
#define SSDO_EXR_LIBRARY_H

#include "base/error.h"

// Within one minor version OpenEXR keeps its layout; between two, contexts have another size and every file would be refused as
// damaged. ERR_INPUT, since no file can be read, naming both versions and the library's file.
bool exrio_library_check(error *e);

// Whether the library that the program was compiled for decodes this compression itself. DWA it does from 3.4 on: 3.1 cannot, and
// with 3.2 and 3.3 it was not tried.
bool exrio_library_decodes(int compression);

#endif
