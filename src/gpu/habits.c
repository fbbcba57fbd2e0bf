#include "gpu/habits.h"

#include <stdio.h>
#include <string.h>

// llvmpipe of Mesa 20.3 ends the process where an image is read beyond its edge; that of 21.3 gives the zero that GL promises.
static bool reads_beyond_edges(const char *version)
{
    int major = 0, minor = 0;
    const char *mesa = strstr(version, "Mesa ");
    return !mesa || sscanf(mesa, "Mesa %d.%d", &major, &minor) != 2 || major > 21 || (major == 21 && minor >= 3);
}

gpu_habits gpu_choose_habits(bool software, const char *version, const gpu_limits *l, const char *read, const char *draw)
{
    // As many as the largest program names when it reads by images: the composite, and s3ho's filter of 16 coefficients.
    enum { ENOUGH = 16 };
    bool enough = l->image_units >= ENOUGH && l->images >= ENOUGH && l->outputs >= ENOUGH;
    gpu_habits h = {.read_images = software && enough && reads_beyond_edges(version), .draw = software};
    if (read && strcmp(read, "image") == 0) h.read_images = enough;
    if (read && strcmp(read, "texture") == 0) h.read_images = false;
    if (draw) h.draw = strcmp(draw, "0") != 0;
    return h;
}
