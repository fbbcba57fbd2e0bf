#include "base/knobs.h"

#include <stddef.h>
#include <stdlib.h>

const knob knobs[] = {
    {.name = "SSDO_SHADER_DIR", .pixels = true, .path = true}, // shaders from a folder
    {.name = "SSDO_TILE", .pixels = true},                     // side of the GPU's tiles
    {.name = "SSDO_READ"},                                     // how shaders read pictures: the same values either way
    {.name = "SSDO_DRAW", .pixels = true},                     // whether passes draw or compute
    {.name = "SSDO_FAIL_ALLOC", .pixels = true},               // the allocation that fails
    {.name = "SSDO_TRANSFER"},                                 // how pictures come back from the GPU
    {.name = "SSDO_MEMORY"},                                   // free memory in bytes, for the check of a frame's size
    {.name = "SSDO_PLUGIN_DIR"},                               // folder of the modules
    {0},
};

const char *knob_value(const char *name)
{
    const char *value = getenv(name);
    return value && *value ? value : NULL;
}
