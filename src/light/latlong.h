// Reading the file of an environment map.
#ifndef SSDO_LIGHT_LATLONG_H
#define SSDO_LIGHT_LATLONG_H

#include <stddef.h>

#include "base/error.h"
#include "base/log.h"

// The map's primaries, where the file says (xy of red, green, blue, white).
typedef struct map_primaries {
    bool known;
    double xy[8];
} map_primaries;

typedef struct latlong_options {
    const char *path;
    int threads;
    // Turns n texels into linear light, in place; NULL: they are. Before a large map is made smaller.
    bool (*convert)(void *context, float *rgb, size_t n, error *e);
    void *context;
} latlong_options;

// *rgb: 3 floats a texel, row-major, top row first, not repaired; the caller frees it. A map of more than REDUCE_TEXELS texels
// (light/reduce.h) is made smaller while it is read. ERR_INPUT names what is missing, ERR_MEMORY a map that does not fit.
bool latlong_read(const latlong_options *options, int *width, int *height, float **rgb, map_primaries *primaries, log_t *log,
                  error *e);

#endif
