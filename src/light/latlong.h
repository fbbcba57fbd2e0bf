// Reading the file of an environment map.
#ifndef SSDO_LIGHT_LATLONG_H
#define SSDO_LIGHT_LATLONG_H

#include "base/error.h"
#include "base/log.h"

// The map's primaries, where the file says (xy of red, green, blue, white).
typedef struct map_primaries {
    bool known;
    double xy[8];
} map_primaries;

// *rgb: 3 floats a texel, row-major, top row first, as stored (not repaired); the caller frees it. ERR_INPUT names what is
// missing.
bool latlong_read(const char *path, int threads, int *width, int *height, float **rgb, map_primaries *primaries, log_t *log,
                  error *e);

#endif
