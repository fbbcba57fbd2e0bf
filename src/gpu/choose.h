// Which EGL device to take, as pure functions over what EGL and the machine say, so that machines we do not have can be tested.
#ifndef SSDO_GPU_CHOOSE_H
#define SSDO_GPU_CHOOSE_H

#include <stdbool.h>
#include <stddef.h>

// An EGL device, in EGL's order.
typedef struct gpu_candidate {
    bool software;          // EGL_MESA_device_software
    bool nvidia;            // EGL_NV_device_cuda: has a CUDA number, unless CUDA is kept from it
    int cuda;               // EGL_CUDA_DEVICE_NV, -1 for none
    bool has_uuid;          //
    unsigned char uuid[16]; // EGL_DEVICE_UUID_EXT
} gpu_candidate;

// The devices to try, best first, as indices into `list`; returns how many. Hardware comes before software, else in EGL's order.
//
// `visible` is the value of CUDA_VISIBLE_DEVICES, by which farms assign GPUs, or NULL: numbers, or UUIDs from their beginning
// ("GPU-8f6a"), separated by commas; what follows a -1, an empty item or one that cannot be read is hidden. The devices it names
// come first, in its order; other devices of NVIDIA are left out. Whether a driver numbers its devices before or after the
// variable is applied is not documented: a device of NVIDIA without a number, beside one with, tells that it was applied, and
// then the numbers are taken as places in the list. A list that cannot be compared (MIG names, UUIDs that EGL does not tell)
// leaves out nothing.
int gpu_choose(const gpu_candidate *list, int count, const char *visible, int *order);

// What is around on a machine whose GPU may be without its GL driver.
typedef struct gpu_surroundings {
    bool node;          // the kernel driver of NVIDIA is there: /dev/nvidia0 or /dev/nvidiactl
    bool node_denied;   // one of them that is there cannot be opened
    bool module;        // the kernel has NVIDIA's driver (/sys/module/nvidia), whatever is in /dev
    bool listed;        // EGL lists a device of NVIDIA
    bool hidden;        // CUDA_VISIBLE_DEVICES is set
    bool vendor;        // a file of NVIDIA in glvnd's egl_vendor.d
    bool library;       // libEGL_nvidia.so.0 can be loaded
    bool render;        // a render node in /dev/dri
    bool render_denied; // and none of them can be opened
    bool card;          // the kernel has a render node (/sys/class/drm), whatever is in /dev
} gpu_surroundings;

// Looks below `root` ("" for the machine itself, where the library is tried too); `listed` and `hidden` stay false.
gpu_surroundings gpu_look_around(const char *root);

// The likely reason why no GPU is used, with its remedy; never NULL.
const char *gpu_why_software(const gpu_surroundings *s);

// The likely reason why there is an NVIDIA GPU that EGL does not list, with its remedy, or NULL if nothing is missing.
const char *gpu_missing_vendor(const gpu_surroundings *s);

// GL_RENDERER without what stands in brackets ("llvmpipe (LLVM 15.0.6, 256 bits)": llvmpipe): the device, whatever the width of
// its vectors or the version of the kernel.
void gpu_device_name(const char *renderer, char *out, size_t size);

#endif
