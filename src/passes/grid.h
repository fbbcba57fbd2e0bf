// A uniform grid over triangles, as the shader trace_grid.comp walks it.
//
// Scenes often stand on a ground that reaches the horizon, or have something small far away, and one grid around all of that
// would have everything of interest in one cell. So there may be several: one around the crowd, the next around the crowd of
// what is left, and so on; a ray walks them all.
#ifndef SSDO_PASSES_GRID_H
#define SSDO_PASSES_GRID_H

#include <stddef.h>
#include <stdint.h>

#include "base/error.h"

enum { GRID_LEVELS = 6, GRID_SIDE = 256 };

// Cell (x, y, z) of a level is offset first + (z * size[1] + y) * size[0] + x; its triangles are items[offsets[i]] up to
// items[offsets[i + 1]], end exclusive.
typedef struct grid_level {
    float low[3], cell[3]; // corner and size of a cell, units of the vertices
    int size[3];           // in cells; 0: the level is empty
    uint32_t first;
} grid_level;

typedef struct grid {
    grid_level level[GRID_LEVELS];
    uint32_t *offsets, *items; // owned
    size_t offset_count, item_count;
} grid;

// 3 floats a vertex, 3 indices a triangle.
bool grid_make(const float *vertices, const uint32_t *triangles, size_t triangle_count, grid *out, error *e);
void grid_free(grid *g);

#endif
