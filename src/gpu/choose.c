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
        unsigned nibble = digit < 32 ? (unsigned)(uuid[digit / 2] >> (digit % 2 ? 0 : 4)) & 15u : 16u;
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

// Counts the folder's entries whose names hold `part`, and those of them that can be opened for reading and writing.
static int count_entries(const char *root, const char *folder, const char *part, int *open)
{
    char full[PATH_MAX];
    int found = 0;
    *open = 0;
    snprintf(full, sizeof full, "%s%s", root, folder);
    DIR *d = opendir(full);
    for (struct dirent *entry; d && (entry = readdir(d));) {
        if (!strstr(entry->d_name, part)) continue;
        found++;
        *open += faccessat(dirfd(d), entry->d_name, R_OK | W_OK, 0) == 0;
    }
    if (d) closedir(d);
    return found;
}

static bool names_nvidia(const char *root, const char *folder)
{
    int open;
    return count_entries(root, folder, "nvidia", &open) > 0;
}

static bool denied(const char *root, const char *path)
{
    char full[PATH_MAX];
    snprintf(full, sizeof full, "%s%s", root, path);
    return exists(root, path) && access(full, R_OK | W_OK) != 0;
}

gpu_surroundings gpu_look_around(const char *root)
{
    int open;
    gpu_surroundings s = {.node = exists(root, "/dev/nvidia0") || exists(root, "/dev/nvidiactl"),
                          .node_denied = denied(root, "/dev/nvidia0") || denied(root, "/dev/nvidiactl"),
                          .module = exists(root, "/sys/module/nvidia")};
    s.render = count_entries(root, "/dev/dri", "renderD", &open) > 0;
    s.render_denied = s.render && open == 0;
    s.card = count_entries(root, "/sys/class/drm", "renderD", &open) > 0;
    if (!s.node) return s;
    s.vendor = names_nvidia(root, "/usr/share/glvnd/egl_vendor.d") || names_nvidia(root, "/etc/glvnd/egl_vendor.d");
    void *library = root[0] ? NULL : dlopen("libEGL_nvidia.so.0", RTLD_LAZY | RTLD_LOCAL);
    s.library = library != NULL;
    if (library) dlclose(library);
    return s;
}

const char *gpu_why_software(const gpu_surroundings *s)
{
    if (s->node_denied)
        return "there is an NVIDIA GPU, but this user may not open /dev/nvidia0 or /dev/nvidiactl; join the group that owns them";
    if (gpu_missing_vendor(s)) return gpu_missing_vendor(s);
    if (!s->node && s->module)
        return "the kernel has NVIDIA's driver, but there is no /dev/nvidia0; give the container the GPU (docker run --gpus all, "
               "apptainer --nv), or run nvidia-modprobe";
    if (s->listed && s->hidden)
        return "CUDA_VISIBLE_DEVICES hides the NVIDIA GPU, or its driver gives no OpenGL 4.5 core context";
    if (s->listed) return "the NVIDIA GPU gives no OpenGL 4.5 core context; --list-devices shows the devices";
    if (s->render_denied)
        return "there is a GPU, but this user may not open /dev/dri/renderD*; join the group that owns it (Debian: render)";
    if (s->render)
        return "there is a GPU in /dev/dri, but no driver gives an OpenGL 4.5 core context on it; install it (Debian: "
               "libgl1-mesa-dri)";
    if (s->card)
        return "the kernel has a GPU, but there is no /dev/dri/renderD*; give the container the GPU (docker run --device "
               "/dev/dri)";
    return "there is no GPU: neither /dev/nvidia0 nor /dev/dri/renderD*";
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
