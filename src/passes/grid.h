// A uniform grid over triangles, as the shader trace_grid.comp walks it.
//
// A scene often stands on a ground that reaches the horizon, or has something small far away. One grid around all of it would
// hold everything of interest in one cell. So there may be several grids: one around most of the triangles (the crowd), the next
// around most of the rest, and so on. A ray walks all of them.
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
