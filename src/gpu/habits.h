// What a device allows and what is fast on it, as a pure function, so that devices we do not have can be tested.
#ifndef SSDO_GPU_HABITS_H
#define SSDO_GPU_HABITS_H

#include <stdbool.h>

// How read-only pictures are read: as image loads, which a software device does faster, or by texel fetches, of which every
// device has enough (shaders/include/images.glsl). And whether a pass that can be drawn is: software devices store what is drawn
// faster, hardware made for computing has few units that draw. Neither changes a value.
typedef struct gpu_habits {
    bool read_images, draw;
} gpu_habits;

// What the device allows one program, as it says itself.
typedef struct gpu_limits {
    int image_units, images, storage_blocks,
        outputs;             // images: a compute or fragment stage's; outputs: images, blocks and targets
    long long storage_bytes; // of one block
} gpu_limits;

// Image loads only on a software device that allows more images than GL 4.5 promises and whose `version` (GL_VERSION) is of no
// Mesa that fails at them; drawing only on a software device. `read` ("image", "texture") and `draw` ("0", "1") are what
// SSDO_READ and SSDO_DRAW say, for tests, or NULL.
gpu_habits gpu_choose_habits(bool software, const char *version, const gpu_limits *l, const char *read, const char *draw);

#endif
