// A lat-long map made smaller while it is read, so that the whole is never in memory.
//
// Every texel of the smaller map is the mean, weighted by solid angle, of what it covers: the light that comes from each part of
// the sky stays the same. A map of at most REDUCE_TEXELS texels stays as it is, bit for bit.
#ifndef SSDO_LIGHT_REDUCE_H
#define SSDO_LIGHT_REDUCE_H

#include <stdbool.h>

#include "base/error.h"

enum { REDUCE_TEXELS = 1 << 25 }; // 8192 x 4096

typedef struct reduced_map {
    int from_width, from_height;
    int width, height;
    float *rgb;      // 3 a texel, row-major, top row first; owned until it is taken away
    double *weights; // of each row, what it has of solid angle so far; NULL where nothing is reduced
} reduced_map;

// ERR_MEMORY, before anything is read, if this machine cannot hold the map's way through the program; `stored` is what reading
// itself takes a texel.
bool reduce_begin(reduced_map *m, int width, int height, double stored, const char *path, error *e);

// Row y of the original: 3 floats a texel. NaN and infinities go into the texels they are part of.
void reduce_row(reduced_map *m, int y, const float *rgb);

// Once every row has been given.
void reduce_end(reduced_map *m);

void reduce_free(reduced_map *m);

#endif
