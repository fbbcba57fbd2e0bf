#include "passes/grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/sort.h"

static const double DENSITY = 3.0;  // cells for a triangle
static const double SHARE = 0.25;   // of the triangles may lie off the crowd on each side of it
static const double LONELY = 4.0;   // a further grid, if the whole is as many times larger than the crowd
static const double MARGIN = 1e-4f; // of a cell: what rounding in the shader may be off by

typedef struct bounds {
    double low[3], high[3];
} bounds;

typedef struct builder {
    const float *vertices;
    const uint32_t *triangles;
    size_t count;
    unsigned char *level_of; // of each triangle
    grid *g;
} builder;

static const float *corner(const builder *b, size_t t, int c)
{
    return b->vertices + 3 * (size_t)b->triangles[3 * t + (size_t)c];
}

static bounds bounds_of(const builder *b, size_t t)
{
    bounds o;
    for (int k = 0; k < 3; k++) {
        double p = (double)corner(b, t, 0)[k], q = (double)corner(b, t, 1)[k], r = (double)corner(b, t, 2)[k];
        o.low[k] = fmin(p, fmin(q, r));
        o.high[k] = fmax(p, fmax(q, r));
    }
    return o;
}

static bounds bounds_of_level(const builder *b, int level)
{
    bounds all = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t t = 0; t < b->count; t++) {
        if (b->level_of[t] != level) continue;
        bounds o = bounds_of(b, t);
        for (int k = 0; k < 3; k++) all.low[k] = fmin(all.low[k], o.low[k]), all.high[k] = fmax(all.high[k], o.high[k]);
    }
    return all;
}

static size_t count_of_level(const builder *b, int level)
{
    size_t n = 0;
    for (size_t t = 0; t < b->count; t++) n += b->level_of[t] == level;
    return n;
}

static double diagonal(const bounds *b)
{
    return sqrt(pow(b->high[0] - b->low[0], 2) + pow(b->high[1] - b->low[1], 2) + pow(b->high[2] - b->low[2], 2));
}

// Where most of a level's triangles are: between two quantiles of their middles, with as much again around it.
static bounds crowd(const builder *b, int level)
{
    enum { MOST = 4096 };
    double middle[MOST];
    bounds box = {{0}, {0}};
    size_t stride = count_of_level(b, level) / MOST + 1;
    for (int k = 0; k < 3; k++) {
        size_t n = 0, seen = 0;
        for (size_t t = 0; t < b->count && n < MOST; t++) {
            if (b->level_of[t] != level || seen++ % stride) continue;
            bounds o = bounds_of(b, t);
            middle[n++] = 0.5 * (o.low[k] + o.high[k]);
        }
        sort_doubles(middle, n);
        double low = middle[(size_t)(SHARE * (double)(n - 1))], high = middle[(size_t)((1.0 - SHARE) * (double)(n - 1))];
        box.low[k] = low - 0.5 * (high - low), box.high[k] = high + 0.5 * (high - low);
    }
    // A flat crowd is given some height, or what stands on it would not belong to it.
    double margin = 0.05 * diagonal(&box);
    for (int k = 0; k < 3; k++) box.low[k] -= margin, box.high[k] += margin;
    return box;
}

// What does not fit into the level's crowd goes to the next. False if nothing does.
static bool split_level(builder *b, int level)
{
    if (count_of_level(b, level) == 0) return false;
    bounds whole = bounds_of_level(b, level), box = crowd(b, level);
    if (!(diagonal(&whole) > LONELY * diagonal(&box))) return false;
    for (size_t t = 0; t < b->count; t++) {
        if (b->level_of[t] != level) continue;
        bounds o = bounds_of(b, t);
        for (int k = 0; k < 3; k++)
            if (o.low[k] < box.low[k] || o.high[k] > box.high[k]) b->level_of[t] = (unsigned char)(level + 1);
    }
    return true;
}

static void size_level(builder *b, int level)
{
    grid_level *l = &b->g->level[level];
    size_t n = count_of_level(b, level);
    if (n == 0) return;
    bounds box = bounds_of_level(b, level);
    double least = 1e-3 * diagonal(&box), side[3], volume = 1.0;
    for (int k = 0; k < 3; k++) {
        side[k] = fmax(box.high[k] - box.low[k], least) * 1.001;
        volume *= side[k];
    }
    double per_unit = cbrt(DENSITY * (double)n / volume);
    for (int k = 0; k < 3; k++) {
        double cells = ceil(side[k] * per_unit);
        l->size[k] = cells < 1.0 ? 1 : cells > GRID_SIDE ? GRID_SIDE : (int)cells;
        l->low[k] = (float)(0.5 * (box.low[k] + box.high[k]) - 0.5 * side[k]);
        l->cell[k] = (float)(side[k] / l->size[k]);
    }
    l->first = (uint32_t)b->g->offset_count;
    b->g->offset_count += (size_t)l->size[0] * (size_t)l->size[1] * (size_t)l->size[2];
}

static void range_of(const grid_level *l, const bounds *o, int from[3], int to[3])
{
    for (int k = 0; k < 3; k++) {
        double low = floor((o->low[k] - (double)l->low[k]) / (double)l->cell[k] - MARGIN);
        double high = floor((o->high[k] - (double)l->low[k]) / (double)l->cell[k] + MARGIN);
        from[k] = low < 0.0 ? 0 : low >= l->size[k] ? l->size[k] - 1 : (int)low;
        to[k] = high < 0.0 ? 0 : high >= l->size[k] ? l->size[k] - 1 : (int)high;
    }
}

typedef struct slab {
    double normal[3], offset;
} slab;

static slab plane_of(const builder *b, size_t t)
{
    double u[3], v[3];
    slab s;
    for (int k = 0; k < 3; k++) {
        u[k] = (double)corner(b, t, 1)[k] - (double)corner(b, t, 0)[k];
        v[k] = (double)corner(b, t, 2)[k] - (double)corner(b, t, 0)[k];
    }
    for (int k = 0; k < 3; k++) s.normal[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
    s.offset = 0.0;
    for (int k = 0; k < 3; k++) s.offset += s.normal[k] * (double)corner(b, t, 0)[k];
    return s;
}

// Whether a triangle's plane passes through a cell: without it, a large slanting triangle would be in every cell of its box.
static bool crosses(const grid_level *l, const slab *s, const int at[3])
{
    double distance = -s->offset, reach = 0.0;
    for (int k = 0; k < 3; k++) {
        double half = 0.5 * (double)l->cell[k];
        distance += s->normal[k] * ((double)l->low[k] + (2.0 * at[k] + 1.0) * half);
        reach += fabs(s->normal[k]) * half * (1.0 + 20.0 * MARGIN);
    }
    return fabs(distance) <= reach;
}

// Counts the triangles of every cell (items NULL), or writes them where the counts have made margin.
static void enter_all(builder *b, uint32_t *items)
{
    for (size_t t = 0; t < b->count; t++) {
        const grid_level *l = &b->g->level[b->level_of[t]];
        bounds o = bounds_of(b, t);
        slab s = plane_of(b, t);
        int from[3], to[3], at[3];
        range_of(l, &o, from, to);
        for (at[2] = from[2]; at[2] <= to[2]; at[2]++)
            for (at[1] = from[1]; at[1] <= to[1]; at[1]++)
                for (at[0] = from[0]; at[0] <= to[0]; at[0]++) {
                    if (!crosses(l, &s, at)) continue;
                    size_t i =
                        l->first + ((size_t)at[2] * (size_t)l->size[1] + (size_t)at[1]) * (size_t)l->size[0] + (size_t)at[0];
                    uint32_t place = b->g->offsets[i]++;
                    if (items) items[place] = (uint32_t)t;
                }
    }
}

bool grid_make(const float *vertices, const uint32_t *triangles, size_t triangle_count, grid *out, error *e)
{
    *out = (grid){0};
    builder b = {vertices, triangles, triangle_count, mem_zero(triangle_count, 1, e), out};
    bool ok = false;
    if (!b.level_of) goto out;
    for (int level = 0; level + 1 < GRID_LEVELS && split_level(&b, level);) level++;
    for (int level = 0; level < GRID_LEVELS; level++) size_level(&b, level);
    out->offsets = mem_zero(out->offset_count + 1, sizeof *out->offsets, e);
    if (!out->offsets) goto out;
    enter_all(&b, NULL);
    uint64_t sum = 0;
    for (size_t i = 0; i <= out->offset_count; i++) {
        uint32_t n = out->offsets[i];
        out->offsets[i] = (uint32_t)sum;
        sum += n;
    }
    out->item_count = (size_t)sum;
    out->items = sum < UINT32_MAX ? mem_pixels(out->item_count + 1, sizeof *out->items, e) : NULL;
    if (!out->items) {
        err_set(e, ERR_MEMORY, NULL, NULL, "the mesh is too large for the grid of --trace gpu; use --trace embree");
        goto out;
    }
    enter_all(&b, out->items);
    // Writing has moved every offset to its cell's end, which is the next one's beginning.
    memmove(out->offsets + 1, out->offsets, out->offset_count * sizeof *out->offsets);
    out->offsets[0] = 0;
    ok = true;
out:
    free(b.level_of);
    if (!ok) grid_free(out);
    return ok;
}

void grid_free(grid *g)
{
    free(g->offsets);
    free(g->items);
    *g = (grid){0};
}
