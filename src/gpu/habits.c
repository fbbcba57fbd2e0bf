#include "gpu/habits.h"

#include <string.h>

gpu_habits gpu_choose_habits(bool software, const gpu_limits *l, const char *read, const char *draw)
{
    // As many as the largest program names when it reads by images: the composite, and s3ho's filter of 16 coefficients.
    enum { ENOUGH = 16 };
    bool room = l->image_units >= ENOUGH && l->images >= ENOUGH && l->outputs >= ENOUGH;
    gpu_habits h = {.read_images = software && room, .draw = software};
    if (read && strcmp(read, "image") == 0) h.read_images = room;
    if (read && strcmp(read, "texture") == 0) h.read_images = false;
    if (draw) h.draw = strcmp(draw, "0") != 0;
    return h;
}
