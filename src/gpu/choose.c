#include "gpu/choose.h"

#include <ctype.h>
#include <dirent.h>
#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LEFT_OUT = INT_MAX, UNKNOWN = 1 << 16, OTHER = 1 << 17, SOFTWARE = 1 << 18 }; // ranks; below them a place in the list

// "GPU-8f6a2b..." against the bytes, as far as it goes.
static bool uuid_begins(const unsigned char uuid[16], const char *text, size_t length)
{
    size_t digit = 0;
    for (size_t i = 4; i < length; i++) {
        if (text[i] == '-') continue;
        unsigned nibble = digit < 32 ? uuid[digit / 2] >> (digit % 2 ? 0 : 4) & 15u : 16u;
        if (nibble > 15u || tolower((unsigned char)text[i]) != "0123456789abcdef"[nibble]) return false;
        digit++;
    }
    return digit > 0;
}

// The place of a device in CUDA_VISIBLE_DEVICES, LEFT_OUT, or UNKNOWN when an item cannot be compared with it.
static int place_in(const char *visible, const gpu_candidate *c)
{
    int place = 0;
    for (const char *p = visible;; place++) {
        size_t n = strcspn(p, ",");
        char *end;
        if (n >= 4 && strncmp(p, "MIG-", 4) == 0) return UNKNOWN;
        if (n > 4 && strncmp(p, "GPU-", 4) == 0) {
            if (!c->has_uuid) return UNKNOWN;
            if (uuid_begins(c->uuid, p, n)) return place;
        } else {
            long number = strtol(p, &end, 10);
            if (end == p || end != p + n || number < 0) return LEFT_OUT;
            if (number == c->cuda) return place;
        }
        if (!p[n]) return LEFT_OUT;
        p += n + 1;
    }
}

static int rank_of(const gpu_candidate *c, const char *visible, bool applied)
{
    if (c->software) return SOFTWARE;
    if (!visible || !c->nvidia) return OTHER;
    if (applied) return c->cuda >= 0 ? c->cuda : LEFT_OUT;
    return place_in(visible, c);
}

int gpu_choose(const gpu_candidate *list, int count, const char *visible, int *order)
{
    bool with = false, without = false;
    for (int i = 0; i < count; i++) {
        with |= list[i].nvidia && list[i].cuda >= 0;
        without |= list[i].nvidia && list[i].cuda < 0;
    }
    int n = 0;
    for (int i = 0; i < count; i++) {
        int rank = rank_of(&list[i], visible, with && without), at = n;
        if (rank == LEFT_OUT) continue;
        while (at > 0 && rank_of(&list[order[at - 1]], visible, with && without) > rank) {
            order[at] = order[at - 1];
            at--;
        }
        order[at] = i;
        n++;
    }
    return n;
}

static bool exists(const char *root, const char *path)
{
    char full[PATH_MAX];
    snprintf(full, sizeof full, "%s%s", root, path);
    return access(full, F_OK) == 0;
}

static bool names_nvidia(const char *root, const char *folder)
{
    char full[PATH_MAX];
    snprintf(full, sizeof full, "%s%s", root, folder);
    DIR *d = opendir(full);
    bool found = false;
    for (struct dirent *entry; d && !found && (entry = readdir(d));) found = strstr(entry->d_name, "nvidia") != NULL;
    if (d) closedir(d);
    return found;
}

gpu_surroundings gpu_look_around(const char *root)
{
    gpu_surroundings s = {.node = exists(root, "/dev/nvidia0") || exists(root, "/dev/nvidiactl")};
    if (!s.node) return s;
    s.vendor = names_nvidia(root, "/usr/share/glvnd/egl_vendor.d") || names_nvidia(root, "/etc/glvnd/egl_vendor.d");
    void *library = root[0] ? NULL : dlopen("libEGL_nvidia.so.0", RTLD_LAZY | RTLD_LOCAL);
    s.library = library != NULL;
    if (library) dlclose(library);
    return s;
}

const char *gpu_missing_vendor(const gpu_surroundings *s)
{
    if (!s->node || s->listed) return NULL;
    if (!s->library)
        return "there is an NVIDIA GPU, but its EGL library libEGL_nvidia.so.0 cannot be loaded; install the driver's GL "
               "libraries "
               "(Debian: libegl-nvidia0), or give the container NVIDIA_DRIVER_CAPABILITIES=all";
    if (!s->vendor)
        return "there is an NVIDIA GPU, but no file in /usr/share/glvnd/egl_vendor.d names its EGL library; add the driver's "
               "10_nvidia.json there";
    return "there is an NVIDIA GPU with its EGL library, but EGL lists no device of it; the library and the kernel driver may be "
           "of "
           "different versions, see nvidia-smi";
}

void gpu_device_name(const char *renderer, char *out, size_t size)
{
    size_t n = strcspn(renderer, "(");
    while (n > 0 && renderer[n - 1] == ' ') n--;
    snprintf(out, size, "%.*s", (int)n, renderer);
}
