#include "light/mips.h"

#include <stdlib.h>

#include "base/mem.h"
#include "base/threads.h"

// One step of the pyramid. The source is kept in double, so that rounding to float does not add up over the levels.
typedef struct step {
    int from_width, from_height, width, height;
    const double *from; // 3 a texel; NULL: level 0, in floats
    const float *from_rgba;
    double *to; // 3 a texel
    float *to_rgba;
    double *scratch; // 3 * from_width for each worker
} step;

// Which source cells texel i of n covers, of m equal ones: cells first .. last, the outer two in part. 64 bits: i * m is exact.
typedef struct cover {
    int first, last;
    double begin, end; // in cells
} cover;

static cover cover_of(int i, int n, int m)
{
    long long a = (long long)i * m, b = (long long)(i + 1) * m;
    return (cover){(int)(a / n), (int)((b + n - 1) / n) - 1, (double)a / n, (double)b / n};
}

static double overlap_begin(const cover *c, int cell) { return c->begin > cell ? c->begin : cell; }
static double overlap_end(const cover *c, int cell) { return c->end < cell + 1 ? c->end : cell + 1; }

// Solid angle of the band between two row coordinates, over 2 pi. cos a - cos b = 2 sin((a + b) / 2) sin((b - a) / 2): no
// cancellation near the poles.
static double band(double row0, double row1, int rows)
{
    return 2 * sin(0.5 * M_PI * (row0 + row1) / rows) * sin(0.5 * M_PI * (row1 - row0) / rows);
}

// The weight is a product of a row's and a column's, so a row of the new level is made in two sweeps: down, then across.
static void sum_rows(const step *s, const cover *rows, double *sums)
{
    int n = 3 * s->from_width;
    double total = band(rows->begin, rows->end, s->from_height);
    for (int k = 0; k < n; k++) sums[k] = 0;
    for (int j = rows->first; j <= rows->last; j++) {
        double weight = band(overlap_begin(rows, j), overlap_end(rows, j), s->from_height) / total;
        if (s->from) {
            const double *row = s->from + (size_t)j * (size_t)n;
            for (int k = 0; k < n; k++) sums[k] += weight * row[k];
        } else {
            const float *row = s->from_rgba + 4 * (size_t)j * (size_t)s->from_width;
            for (int i = 0; i < s->from_width; i++)
                for (int c = 0; c < 3; c++) sums[3 * i + c] += weight * (double)row[4 * i + c];
        }
    }
}

static bool average_row(void *context, size_t item, int worker)
{
    const step *s = context;
    double *sums = s->scratch + 3 * (size_t)worker * (size_t)s->from_width;
    cover rows = cover_of((int)item, s->height, s->from_height);
    sum_rows(s, &rows, sums);
    for (int x = 0; x < s->width; x++) {
        cover columns = cover_of(x, s->width, s->from_width);
        double mean[3] = {0, 0, 0};
        size_t index = item * (size_t)s->width + (size_t)x;
        for (int i = columns.first; i <= columns.last; i++) {
            double weight = (overlap_end(&columns, i) - overlap_begin(&columns, i)) * s->width / s->from_width;
            for (int c = 0; c < 3; c++) mean[c] += weight * sums[3 * i + c];
        }
        for (size_t c = 0; c < 3; c++) {
            s->to[3 * index + c] = mean[c];
            s->to_rgba[4 * index + c] = (float)mean[c];
        }
        s->to_rgba[4 * index + 3] = 0;
    }
    return true;
}

static int half(int size) { return size > 1 ? size / 2 : 1; }

bool mips_build(environment *env, int threads, error *e)
{
    bool ok = false;
    size_t workers = threads > 1 ? (size_t)threads : 1;
    double *from = NULL, *to = NULL;
    double *scratch = mem_pixels(workers * (size_t)env->levels[0].width, 3 * sizeof *scratch, e);
    if (!scratch) goto out;
    while (env->level_count < ENV_MAX_LEVELS) {
        const env_level *last = &env->levels[env->level_count - 1];
        if (last->width == 1 && last->height == 1) break;
        env_level next = {.width = half(last->width), .height = half(last->height)};
        size_t texels = (size_t)next.width * (size_t)next.height;
        to = mem_pixels(texels, 3 * sizeof *to, e);
        next.rgba = mem_pixels(texels, 4 * sizeof *next.rgba, e);
        if (!to || !next.rgba) {
            free(next.rgba);
            goto out;
        }
        env->levels[env->level_count++] = next;
        step s = {last->width, last->height, next.width, next.height, from, last->rgba, to, next.rgba, scratch};
        threads_for(threads, (size_t)next.height, average_row, &s);
        free(from);
        from = to;
        to = NULL;
    }
    ok = true;
out:
    free(scratch);
    free(from);
    free(to);
    return ok;
}
