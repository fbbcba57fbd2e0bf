#include "modules.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void use_built_modules(void)
{
    char folder[PATH_MAX];
    ssize_t n = readlink("/proc/self/exe", folder, sizeof folder - 1);
    folder[n > 0 ? n : 0] = 0;
    for (int up = 0; up < 2; up++)
        if (strrchr(folder, '/')) *strrchr(folder, '/') = 0;
    setenv("SSDO_PLUGIN_DIR", folder, 0);
}
