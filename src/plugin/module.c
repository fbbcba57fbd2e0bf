#include "plugin/module.h"

#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/knobs.h"
#include "base/mem.h"

#ifndef SSDO_LIBDIR
#define SSDO_LIBDIR "/usr/local/lib/ssdo-filter"
#endif

enum { PLACES = 5 };

typedef struct places {
    char folder[PLACES][PATH_MAX];
    int count;
} places;

static void add_place(places *p, const char *folder, const char *below)
{
    int n = snprintf(p->folder[p->count], PATH_MAX, "%s%s", folder, below);
    if (n > 0 && n < PATH_MAX) p->count++;
}

// In the order in which they are tried.
static void list_places(places *p)
{
    char exe[PATH_MAX];
    p->count = 0;
    const char *chosen = knob_value("SSDO_PLUGIN_DIR");
    if (chosen && chosen[0]) add_place(p, chosen, "");
    ssize_t n = readlink("/proc/self/exe", exe, sizeof exe - 1);
    if (n > 0) {
        exe[n] = '\0';
        char *slash = strrchr(exe, '/');
        if (slash) {
            *slash = '\0';
            add_place(p, exe, "");
            add_place(p, exe, "/../lib/ssdo-filter");
        }
    }
    Dl_info self; // the library, in another program
    static const char here;
    if (dladdr(&here, &self) && self.dli_fname && snprintf(exe, sizeof exe, "%s", self.dli_fname) < (int)sizeof exe) {
        char *slash = strrchr(exe, '/');
        if (slash) {
            *slash = '\0';
            add_place(p, exe, "/ssdo-filter");
        }
    }
    add_place(p, SSDO_LIBDIR, "");
}

// Tries one folder. The module stays loaded for the rest of the process: unloading these libraries is neither safe nor cheap.
static void *open_module(const char *folder, const char *file, char *why, size_t why_size)
{
    char path[PATH_MAX + 64];
    snprintf(path, sizeof path, "%s/%s", folder, file);
    if (access(path, F_OK) != 0 && (errno == ENOENT || errno == ENOTDIR)) return NULL; // else loading says what is wrong
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!handle) snprintf(why, why_size, "%s", dlerror());
    return handle;
}

// dlsym gives the address of an object, which C does not convert to that of a function; POSIX has both of one form.
static module_call find(void *handle, const char *name)
{
    void *object = dlsym(handle, name);
    module_call function;
    _Static_assert(sizeof function == sizeof object, "POSIX");
    memcpy(&function, &object, sizeof function);
    return function;
}

module_call module_function(const module *m, const char *name, const char *purpose, error_code code, const char *file, error *e)
{
    places *p = mem_zero(1, sizeof *p, e);
    if (!p) return NULL;
    void *handle = NULL;
    module_call function = NULL;
    char folders[512] = "", why[256] = "";
    list_places(p);
    for (int i = 0; i < p->count && !handle; i++) {
        if (i) strncat(folders, ", ", sizeof folders - strlen(folders) - 1);
        strncat(folders, p->folder[i], sizeof folders - strlen(folders) - 1);
        handle = open_module(p->folder[i], m->file, why, sizeof why);
    }
    if (handle) function = find(handle, name);
    if (!handle && why[0])
        err_set(e, code, file, NULL, "%s needs the module %s, which cannot be loaded (%s); install %s", purpose, m->file, why,
                m->library);
    else if (!handle)
        err_set(e, code, file, NULL,
                "%s needs the module %s, which was not found in %s; install it there or name its folder in SSDO_PLUGIN_DIR",
                purpose, m->file, folders);
    else if (!function)
        err_set(e, code, file, NULL, "%s needs a module %s of the same version as the program; install both together", purpose,
                m->file);
    free(p);
    return function;
}
