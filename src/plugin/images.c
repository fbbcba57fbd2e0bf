#include "plugin/images.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "base/outfile.h"
#include "plugin/images_abi.h"

#ifndef SSDO_LIBDIR
#define SSDO_LIBDIR "/usr/local/lib/ssdo-filter"
#endif

enum { PLACES = 4, MESSAGE = 512 };

static const char module_name[] = "ssdo-images.so";

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
    const char *chosen = getenv("SSDO_PLUGIN_DIR");
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
    add_place(p, SSDO_LIBDIR, "");
}

// Tries one folder. The module stays loaded for the rest of the process: unloading OpenImageIO is neither safe nor cheap.
static void *open_module(const char *folder, char *why, size_t why_size)
{
    char path[PATH_MAX + sizeof module_name + 1];
    snprintf(path, sizeof path, "%s/%s", folder, module_name);
    if (access(path, R_OK) != 0) return NULL;
    void *module = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!module) snprintf(why, why_size, "%s", dlerror());
    return module;
}

// The function `name` of the module, or NULL after filling *e.
static void *find_function(const char *name, const char *purpose, error_code code, const char *file, error *e)
{
    places *p = mem_zero(1, sizeof *p, e);
    if (!p) return NULL;
    void *module = NULL, *function = NULL;
    char folders[512] = "", why[256] = "";
    list_places(p);
    for (int i = 0; i < p->count && !module; i++) {
        if (i) strncat(folders, ", ", sizeof folders - strlen(folders) - 1);
        strncat(folders, p->folder[i], sizeof folders - strlen(folders) - 1);
        module = open_module(p->folder[i], why, sizeof why);
    }
    if (module) function = dlsym(module, name);
    if (!module && why[0])
        err_set(e, code, file, NULL, "%s needs the module %s, which cannot be loaded (%s); install OpenImageIO", purpose,
                module_name, why);
    else if (!module)
        err_set(e, code, file, NULL,
                "%s needs the module %s, which was not found in %s; install it there or name its folder in SSDO_PLUGIN_DIR",
                purpose, module_name, folders);
    else if (!function)
        err_set(e, code, file, NULL, "%s needs a module %s of the same version as the program; install both together", purpose,
                module_name);
    free(p);
    return function;
}

bool images_read_float(const char *path, int part, int *width, int *height, int *channels, float **pixels, error *e)
{
    char message[MESSAGE] = "";
    *pixels = NULL;
    images_read_float_fn read =
        (images_read_float_fn)find_function("ssdo_images_read_float", "reading this kind of image", ERR_INPUT, path, e);
    if (!read) return false;
    if (read(path, part, width, height, channels, pixels, message, sizeof message)) return true;
    return err_set(e, ERR_INPUT, path, NULL, "cannot be read as an image: %s; check the file or convert it to EXR", message);
}

bool images_read_exr_native(const char *path, int part, int count, const char *const *names, const int *types, void **data,
                            error *e)
{
    char message[MESSAGE] = "";
    images_read_native_fn read = (images_read_native_fn)find_function(
        "ssdo_images_read_native", "reading DWAA or DWAB compression (ZIP needs no module)", ERR_INPUT, path, e);
    if (!read) return false;
    if (read(path, part, count, names, types, data, message, sizeof message)) return true;
    return err_set(e, ERR_INPUT, path, NULL, "is truncated or damaged: %s; render it or copy it again", message);
}

bool images_write_png(const char *path, int width, int height, const uint8_t *rgb, error *e)
{
    char message[MESSAGE] = "";
    images_write_png_fn write = (images_write_png_fn)find_function("ssdo_images_write_png", "writing a PNG", ERR_OUTPUT, path, e);
    outfile file = OUTFILE_NONE;
    if (!write || !outfile_begin(path, &file, e)) return false;
    if (write(file.temp, width, height, rgb, message, sizeof message)) return outfile_commit(&file, e);
    outfile_abort(&file);
    return err_set(e, ERR_OUTPUT, path, NULL, "cannot be written as PNG: %s; free some space or choose another output", message);
}
