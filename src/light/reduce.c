#include "light/reduce.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "light/env_map.h"

// Bytes a texel from here on: this map, its levels, and both on the device, which may be this machine's memory.
static const double LATER = 12 + 2 * 16 * 4.0 / 3.0;

static int divided(int size, int by) { return (size + by - 1) / by; }

static bool fits_memory(const reduced_map *m, double stored, const char *path, error *e)
{
    const double gib = 1024.0 * 1024.0 * 1024.0;
    double needed = stored * m->from_width * m->from_height + LATER * m->width * m->height, available = (double)mem_available();
    if (needed <= available) return true;
    return err_set(e, ERR_MEMORY, path, NULL,
                   "the environment map of %d x %d texels needs about %.1f GiB and this machine has %.1f GiB free; scale it down",
                   m->from_width, m->from_height, needed / gib, available / gib);
}

bool reduce_begin(reduced_map *m, int width, int height, double stored, const char *path, error *e)
{
    *m = (reduced_map){.from_width = width, .from_height = height};
    if (width < 1 || height < 1 || width > ENV_MAX_SIZE || height > ENV_MAX_SIZE)
        return err_set(e, ERR_INPUT, path, NULL,
                       "the environment map has %d x %d texels, at most %d a side are taken; scale it down", width, height,
                       ENV_MAX_SIZE);
    int by = 1;
    while ((double)divided(width, by) * divided(height, by) > REDUCE_TEXELS) by++;
    m->width = divided(width, by);
    m->height = divided(height, by);
    if (!fits_memory(m, stored, path, e)) return false;
    m->rgb = mem_zero((size_t)m->width * (size_t)m->height, 3 * sizeof *m->rgb, e);
    if (by > 1 && m->rgb) m->weights = mem_zero((size_t)m->height, sizeof *m->weights, e);
    if (m->rgb && (by == 1 || m->weights)) return true;
    reduce_free(m);
    return false;
}

// Which one or two cells of `to` the i-th of `from` lies in, and its share of the first, in units of 1 / from of a cell.
typedef struct split {
    size_t first;
    int share, rest;
} split;

static split split_of(int i, int from, int to)
{
    long long begin = (long long)i * to, cell = begin / from, border = (cell + 1) * from;
    int share = border - begin < to ? (int)(border - begin) : to;
    return (split){(size_t)cell, share, to - share};
}

static void add_row(reduced_map *m, size_t row, double weight, const float *rgb)
{
    float *to = m->rgb + 3 * row * (size_t)m->width;
    m->weights[row] += weight;
    for (int x = 0; x < m->from_width; x++) {
        split s = split_of(x, m->from_width, m->width);
        for (size_t c = 0; c < 3; c++) {
            float v = rgb[3 * (size_t)x + c];
            to[3 * s.first + c] += (float)(weight * s.share / m->from_width) * v;
            if (s.rest > 0) to[3 * s.first + 3 + c] += (float)(weight * s.rest / m->from_width) * v;
        }
    }
}

void reduce_row(reduced_map *m, int y, const float *rgb)
{
    if (!m->weights) {
        memcpy(m->rgb + 3 * (size_t)y * (size_t)m->width, rgb, 3 * (size_t)m->width * sizeof *rgb);
        return;
    }
    split s = split_of(y, m->from_height, m->height);
    double whole = env_texel_solid_angle(m->from_width, m->from_height, y) * m->from_width; // 4 pi in all: of a handy size
    add_row(m, s.first, whole * s.share / m->height, rgb);
    if (s.rest > 0) add_row(m, s.first + 1, whole * s.rest / m->height, rgb);
}

void reduce_end(reduced_map *m)
{
    for (size_t row = 0; m->weights && row < (size_t)m->height; row++) {
        float *v = m->rgb + 3 * row * (size_t)m->width;
        for (size_t i = 0; i < 3 * (size_t)m->width; i++) v[i] = (float)((double)v[i] / m->weights[row]);
    }
}

void reduce_free(reduced_map *m)
{
    free(m->rgb);
    free(m->weights);
    *m = (reduced_map){0};
}
