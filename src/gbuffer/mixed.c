// Pixels whose stored normal is a mean over the surfaces in them, while their depth is one sample's (src/gbuffer/README.md, Mixed
// pixels). Each gets the normal of its own surface. Together with that of one neighbour, the mean then tells how much of the
// pixel is the neighbour's surface.
#include <stdlib.h>

#include "base/mem.h"
#include "base/threads.h"
#include "gbuffer/build.h"

static const double distance[BUILD_AROUND] = {1.4142, 1, 1.4142, 1, 1, 1.4142, 1, 1.4142};

// A neighbour's normal is taken for the pixel's own if it is nearer to unit length by more than the pixel lies off the
// neighbour's tangent plane, in pixels, and than it lies away, by these weights. Both planes may lie this many pixels apart at
// most.
static const double per_offset = 0.5, per_step = 0.03, most_offset = 1.0;
// What a neighbour's surface must explain of the mean for each pixel that it lies away, squared; and how far the two normals
// differ at least, squared, for the mean to tell how much of each it holds.
static const double per_step_of_mix = 0.01, least_turn = 1e-4;
static const double least_coverage = 0.05; // below, what alpha leaves of a normal is too coarse

typedef struct mixing {
    build *b;
    uint8_t *own;  // of every pixel: 0 it is whole, 1 mixed, 2 + k mixed with the normal of neighbour k
    size_t *first; // of every row: its mixed pixels in `items`
    mixed_pixel *items;
    vec3 *normals; // of the items
    float *lacks;  // how much shorter than 1 their means are
} mixing;

static bool inside(const build *b, int x, int y) { return x >= 0 && y >= 0 && x < b->g->width && y < b->g->height; }

static bool has_surface(const build *b, int x, int y) { return inside(b, x, y) && b->g->depth[build_index(b, x, y)] > 0.0f; }

static vec3 made_normal(const build *b, int x, int y)
{
    const float *n = b->g->normal + 4 * build_index(b, x, y);
    return v3((double)n[0], (double)n[1], (double)n[2]);
}

static bool near_background(const build *b, int x, int y)
{
    for (int k = 0; k < BUILD_AROUND; k++)
        if (inside(b, x + build_around[k][0], y + build_around[k][1]) &&
            !has_surface(b, x + build_around[k][0], y + build_around[k][1]))
            return true;
    return false;
}

// The mean normal over the surfaces of a pixel; the background's share is taken out. It looks to the side of the normal that was
// made. False where that share is not known.
static bool mean_of(const build *b, int x, int y, vec3 *mean)
{
    double covered = 1.0;
    if (near_background(b, x, y)) {
        if (!b->alpha.data) return false;
        covered = plane_get(&b->alpha, x, y);
        if (!(covered >= least_coverage)) return false;
        covered = fmin(covered, 1.0);
    }
    *mean = v3_scale(normals_decode(b, normals_code(b, x, y)), 1.0 / covered);
    if (v3_dot(*mean, made_normal(b, x, y)) < 0.0) *mean = v3_scale(*mean, -1.0);
    return true;
}

// How much shorter than 1 it is.
static double shortness(const build *b, int x, int y)
{
    vec3 mean;
    if (b->normal.lengths[build_index(b, x, y)] & LENGTH_WHOLE) return 0.0;
    return mean_of(b, x, y, &mean) ? fmax(1.0 - v3_length(mean), 0.0) : 1.0;
}

static bool is_mixed(const build *b, int x, int y, double *lacks)
{
    const size_t i = build_index(b, x, y);
    if (!(b->g->depth[i] > 0.0f) || b->normal.lengths[i] & LENGTH_NEARLY) return false;
    *lacks = shortness(b, x, y);
    return *lacks > 0.02 && *lacks < 0.95;
}

static double pixel_size(const camera *c, double z)
{
    const double size = 1.0 / fmin(c->fx, c->fy);
    return c->kind == CAMERA_PERSPECTIVE ? size * z : size;
}

static uint8_t find_own(const build *b, int x, int y, double lacks)
{
    const vec3 p = gbuffer_position(b->g, x, y);
    const double per_unit = 1.0 / pixel_size(&b->g->camera, p.z);
    uint8_t own = 1;
    for (int k = 0; k < BUILD_AROUND; k++) {
        const int u = x + build_around[k][0], v = y + build_around[k][1];
        if (!has_surface(b, u, v)) continue;
        const double off = fabs(v3_dot(made_normal(b, u, v), v3_sub(p, gbuffer_position(b->g, u, v)))) * per_unit;
        const double cost = per_offset * off + per_step * distance[k];
        if (!(off < most_offset) || !(cost < lacks)) continue;
        const double whole = cost + shortness(b, u, v);
        if (!(whole < lacks)) continue;
        lacks = whole;
        own = (uint8_t)(2 + k);
    }
    return own;
}

static bool find_row(void *context, size_t row, int worker)
{
    (void)worker;
    const mixing *m = context;
    const int y = (int)row;
    double lacks;
    for (int x = 0; x < m->b->g->width; x++) {
        if (!is_mixed(m->b, x, y, &lacks)) continue;
        m->own[build_index(m->b, x, y)] = find_own(m->b, x, y, lacks);
        m->first[row + 1]++;
    }
    return true;
}

static vec3 own_normal(const mixing *m, int x, int y)
{
    const int own = m->own[build_index(m->b, x, y)] - 2;
    return own < 0 ? made_normal(m->b, x, y) : made_normal(m->b, x + build_around[own][0], y + build_around[own][1]);
}

// The neighbour whose surface, mixed into the pixel's own, comes nearest to the mean.
static mixed_pixel mix(const mixing *m, int x, int y, vec3 own)
{
    mixed_pixel out = {.pixel = (uint32_t)x | (uint32_t)y << 16};
    vec3 mean;
    if (!mean_of(m->b, x, y, &mean)) return out;
    double least = v3_dot(v3_sub(own, mean), v3_sub(own, mean));
    for (int k = 0; k < BUILD_AROUND; k++) {
        const int u = x + build_around[k][0], v = y + build_around[k][1];
        if (!has_surface(m->b, u, v)) continue;
        const vec3 turn = v3_sub(own_normal(m, u, v), own);
        const double square = v3_dot(turn, turn);
        if (!(square > least_turn)) continue;
        const double share = fmin(fmax(v3_dot(v3_sub(mean, own), turn) / square, 0.0), 1.0);
        const vec3 off = v3_sub(v3_add(own, v3_scale(turn, share)), mean);
        const double rest = v3_dot(off, off) + per_step_of_mix * share * distance[k];
        if (!(rest < least)) continue;
        least = rest;
        out.x = (int8_t)build_around[k][0], out.y = (int8_t)build_around[k][1], out.share = (float)share;
    }
    return out;
}

static bool mix_row(void *context, size_t row, int worker)
{
    (void)worker;
    const mixing *m = context;
    const int y = (int)row;
    for (size_t i = m->first[row], x = 0; i < m->first[row + 1]; x++) {
        if (!m->own[build_index(m->b, (int)x, y)]) continue;
        m->normals[i] = own_normal(m, (int)x, y);
        m->lacks[i] = (float)shortness(m->b, (int)x, y);
        m->items[i] = mix(m, (int)x, y, m->normals[i]);
        i++;
    }
    return true;
}

// Puts the normals in place and keeps the pixels that hold something of a neighbour's surface. Returns how many normals changed.
static size_t settle(const mixing *m, size_t count)
{
    gbuffer *g = m->b->g;
    size_t changed = 0;
    for (size_t i = 0; i < count; i++) {
        const mixed_pixel item = m->items[i];
        const size_t at = build_index(m->b, (int)(item.pixel & 0xffff), (int)(item.pixel >> 16));
        float *n = g->normal + 4 * at;
        n[0] = (float)m->normals[i].x, n[1] = (float)m->normals[i].y, n[2] = (float)m->normals[i].z;
        n[3] = -m->lacks[i];
        changed += m->own[at] > 1;
        if (item.share > 0.0f) m->items[g->mixed_count++] = item;
    }
    return changed;
}

bool mixed_asked(const build *b) { return b->row->normals_averaged && b->normal.there && !filtered_asked(b); }

bool mixed_make(build *b)
{
    if (!mixed_asked(b)) return true;
    const size_t rows = (size_t)b->g->height;
    mixing m = {.b = b,
                .own = mem_zero((size_t)b->g->width * rows, sizeof *m.own, b->e),
                .first = mem_zero(rows + 1, sizeof *m.first, b->e)};
    bool ok = m.own && m.first;
    if (ok) threads_for(b->options->threads, rows, find_row, &m);
    for (size_t y = 0; ok && y < rows; y++) m.first[y + 1] += m.first[y];
    const size_t count = ok ? m.first[rows] : 0;
    if (count > 0) {
        m.items = mem_pixels(count, sizeof *m.items, b->e), m.normals = mem_pixels(count, sizeof *m.normals, b->e);
        m.lacks = mem_pixels(count, sizeof *m.lacks, b->e);
        ok = m.items && m.normals && m.lacks;
        if (ok) threads_for(b->options->threads, rows, mix_row, &m);
        const size_t changed = ok ? settle(&m, count) : 0;
        if (ok)
            build_note(b,
                       "%zu pixels have a mean of several normals: %zu got their own surface's, %zu are mixed with a neighbour",
                       count, changed, b->g->mixed_count);
    }
    b->g->mixed = m.items;
    free(m.own);
    free(m.first);
    free(m.normals);
    free(m.lacks);
    return ok;
}
