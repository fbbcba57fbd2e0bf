#include "exr/library.h"

#include <OpenEXRConfig.h>
#include <dlfcn.h>
#include <openexr.h>

bool exrio_library_decodes(int compression)
{
    const bool dwa = OPENEXR_VERSION_MAJOR > 3 || (OPENEXR_VERSION_MAJOR == 3 && OPENEXR_VERSION_MINOR >= 4);
    return dwa || (compression != EXR_COMPRESSION_DWAA && compression != EXR_COMPRESSION_DWAB);
}

bool exrio_library_check(error *e)
{
    int major, minor, patch;
    const char *extra;
    exr_get_library_version(&major, &minor, &patch, &extra);
    if (major == OPENEXR_VERSION_MAJOR && minor == OPENEXR_VERSION_MINOR) return true;
    // The function itself may be asked for by the program's own jump table; one of the library's texts lies in the library.
    Dl_info where = {0};
    dladdr(exr_get_default_error_message(EXR_ERR_SUCCESS), &where);
    return err_set(e, ERR_INPUT, where.dli_fname, NULL,
                   "is OpenEXR %d.%d.%d, and this program was built for OpenEXR %d.%d; let the loader find that one "
                   "(LD_LIBRARY_PATH), or build the program again",
                   major, minor, patch, OPENEXR_VERSION_MAJOR, OPENEXR_VERSION_MINOR);
}
