// Coverage k (src/gbuffer/README.md, Coverage).
#include <math.h>

#include "base/mem.h"
#include "gbuffer/build.h"

static const double SAME_COLOUR = 0.01; // of the sum of the components: what half floats and a little noise leave of equal chroma

static bool alpha_varies(const build *b)
{
    bool full = false, partial = false;
    for (int y = 0; y < b->g->height; y++)
        for (int x = 0; x < b->g->width; x++) {
            double a = plane_get(&b->alpha, x, y);
            full = full || a > 0.5;
            partial = partial || a < 0.999;
            if (full && partial) return true;
        }
    return false;
}

static bool near_background(const build *b, int x, int y)
{
    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++) {
            if (u < 0 || v < 0 || u >= b->g->width || v >= b->g->height) continue;
            if (!(b->g->depth[build_index(b, u, v)] > 0.0f)) return true;
        }
    return false;
}

// Where the renderer averages colours too, coverage is also a ratio: the pixel's albedo over the albedo of a whole pixel of the
// same material beside it. Unlike the length of the normal, it stays right where two faces meet in the pixel. 0 where there is no
// such pixel.
static double coverage_of_albedo(const build *b, int x, int y)
{
    enum { REACH = 2 };
    const float *own = b->g->albedo + 4 * build_index(b, x, y);
    double k = 0.0, sum = (double)own[0] + (double)own[1] + (double)own[2];
    int nearest = 2 * REACH * REACH + 1;
    for (int v = y - REACH; v <= y + REACH; v++)
        for (int u = x - REACH; u <= x + REACH; u++) {
            int squared = (u - x) * (u - x) + (v - y) * (v - y);
            if (squared >= nearest || u < 0 || v < 0 || u >= b->g->width || v >= b->g->height || near_background(b, u, v))
                continue;
            const float *other = b->g->albedo + 4 * build_index(b, u, v);
            double whole = (double)other[0] + (double)other[1] + (double)other[2], off = 0.0;
            if (!(whole > 0.0)) continue;
            for (int c = 0; c < 3; c++) off = fmax(off, fabs((double)own[c] - (double)other[c] * sum / whole));
            if (off > SAME_COLOUR * sum) continue;
            nearest = squared;
            k = sum / whole;
        }
    return k;
}

// near_background of a row's n pixels from x on. Not pixel by pixel: of most frames every pixel is asked about.
static void near_background_row(const build *b, int x, int y, int n, bool *near)
{
    bool empty[PLANE_BLOCK + 2] = {false}; // of the columns from x - 1 to x + n
    int first = x > 0 ? 0 : 1, last = x + n < b->g->width ? n + 2 : n + 1;
    for (int v = y > 0 ? y - 1 : 0; v <= y + 1 && v < b->g->height; v++) {
        const float *depth = b->g->depth + (size_t)v * (size_t)b->g->width;
        for (int k = first; k < last; k++) empty[k] |= !(depth[x - 1 + k] > 0.0f);
    }
    for (int k = 0; k < n; k++) near[k] = empty[k] | empty[k + 1] | empty[k + 2];
}

// Away from the background neither is coverage: alpha there is the material's (glass), and a bump map changes |N|.
static void coverage_row(build *b, int y)
{
    bool near[PLANE_BLOCK];
    for (int x = 0; x < b->g->width; x++) {
        size_t i = build_index(b, x, y);
        if (x % PLANE_BLOCK == 0)
            near_background_row(b, x, y, b->g->width - x < PLANE_BLOCK ? b->g->width - x : PLANE_BLOCK, near);
        bool solid = b->g->depth[i] > 0.0f;
        double k = solid ? 1.0 : 0.0;
        if (near[x % PLANE_BLOCK]) {
            double stored = k;
            if (b->alpha.data)
                stored = plane_get(&b->alpha, x, y);
            else if (b->normal.there && b->row->normals_averaged && b->normal.encoding == NORMAL_SIGNED)
                stored = fmax(normals_length(b, x, y), b->g->albedo ? coverage_of_albedo(b, x, y) : 0.0);
            if (isfinite(stored)) k = fmin(fmax(stored, 0.0), 1.0);
        }
        b->g->coverage[i] = (float)k;
        vec3 n;
        if (solid || !(k > 0.0) || !normals_read(b, x, y, &n)) continue;
        if (v3_dot(n, v3_normalize(build_ray(&b->g->camera, x, y))) > 0.1) n = v3_scale(n, -1.0);
        float *out = b->g->normal + 4 * i;
        out[0] = (float)n.x, out[1] = (float)n.y, out[2] = (float)n.z;
    }
}

bool coverage_make(build *b)
{
    if (!(b->options->need & NEED_COVERAGE)) return true;
    b->g->coverage = mem_pixels((size_t)b->g->width * (size_t)b->g->height, sizeof *b->g->coverage, b->e);
    if (!b->g->coverage) return false;
    if (b->alpha.data && !alpha_varies(b)) b->alpha.data = NULL;
    bool from_normals = !b->alpha.data && b->normal.there && b->row->normals_averaged && b->normal.encoding == NORMAL_SIGNED;
    build_note(b, "coverage at edges: from %s",
               b->alpha.data  ? "alpha"
               : from_normals ? "the length of the normals and the albedo"
                              : "depth alone");
    build_rows(b, coverage_row);
    return true;
}
