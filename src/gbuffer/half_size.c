#include "gbuffer/half_size.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/threads.h"

typedef struct halving {
    const gbuffer *g;
    gbuffer *out;
    size_t *valid; // of each row
} halving;

// How far a pixel may lie off the chosen one's tangent plane, in pixels at its depth, for its colour to count.
static const double SAME_SURFACE = 2.0;
// Cosine below which a surface is seen edge-on.
static const double EDGE_ON = 0.05;

static size_t at(const gbuffer *g, int x, int y) { return (size_t)y * (size_t)g->width + (size_t)x; }

static vec3 normal_at(const gbuffer *g, size_t i)
{
    const float *n = g->normal + 4 * i;
    return v3((double)n[0], (double)n[1], (double)n[2]);
}

// Pixels of the block that hold a surface, nearest first, in a fixed order where depths are equal.
static int members(const gbuffer *g, int bx, int by, int px[4], int py[4])
{
    int n = 0;
    for (int k = 0; k < 4; k++) {
        int x = 2 * bx + (k & 1), y = 2 * by + (k >> 1), place = n;
        if (x >= g->width || y >= g->height || !(g->depth[at(g, x, y)] > 0.0f)) continue;
        for (; place > 0 && g->depth[at(g, x, y)] < g->depth[at(g, px[place - 1], py[place - 1])]; place--)
            px[place] = px[place - 1], py[place] = py[place - 1];
        px[place] = x, py[place] = y, n++;
    }
    return n;
}

// Planar depth of the tangent plane of pixel (x, y) on the ray through data-window position (sx, sy); 0 where they do not meet.
static double plane_depth(const gbuffer *g, int x, int y, double sx, double sy)
{
    const camera *c = &g->camera;
    double z = (double)g->depth[at(g, x, y)], ax = (x + 0.5 - c->cx) / c->fx, ay = (y + 0.5 - c->cy) / c->fy;
    double bx = (sx - c->cx) / c->fx, by = (sy - c->cy) / c->fy;
    vec3 n = normal_at(g, at(g, x, y));
    if (c->kind == CAMERA_ORTHOGRAPHIC) return fabs(n.z) > 1e-4 ? z + (n.x * (ax - bx) + n.y * (ay - by)) / n.z : 0.0;
    double t = z * v3_dot(n, v3(ax, ay, 1)) / v3_dot(n, v3(bx, by, 1));
    return t > 0.0 && t < 1e30 ? t : 0.0;
}

static bool in_range(const gbuffer *g, int x, int y, double depth)
{
    double low = INFINITY, high = 0.0;
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++) {
            if (i < 0 || j < 0 || i >= g->width || j >= g->height || !(g->depth[at(g, i, j)] > 0.0f)) continue;
            low = fmin(low, (double)g->depth[at(g, i, j)]), high = fmax(high, (double)g->depth[at(g, i, j)]);
        }
    double margin = high - low; // twice what the last, odd row of a plane needs
    return depth >= low - margin && depth <= high + margin;
}

// Cosine between a pixel's normal and its view ray.
static double facing(const gbuffer *g, int x, int y)
{
    vec3 n = normal_at(g, at(g, x, y)), p = gbuffer_position(g, x, y);
    return fabs(g->camera.kind == CAMERA_ORTHOGRAPHIC ? n.z : v3_dot(n, p) / v3_length(p));
}

// Chooses the member that represents the block, and its depth at the block's centre. The median comes first; another is taken
// only where the median's plane says nothing about the centre. If no plane does, the median keeps its own depth; or it gets depth
// 0 if it is seen nearly edge-on (the last row below a horizon), because there its own depth would be far off the surface at the
// centre.
static int choose(const gbuffer *g, int bx, int by, int n, const int px[4], const int py[4], double *depth, bool *own)
{
    int middle = (n - 1) / 2;
    *own = false;
    for (int k = 0; k < n; k++) {
        int i = (middle + k) % n;
        *depth = plane_depth(g, px[i], py[i], 2.0 * bx + 1.0, 2.0 * by + 1.0);
        if (*depth > 0.0 && in_range(g, px[i], py[i], *depth)) return i;
    }
    *own = true;
    bool edge_on = facing(g, px[middle], py[middle]) < EDGE_ON;
    *depth = edge_on ? 0.0 : (double)g->depth[at(g, px[middle], py[middle])];
    return middle;
}

// Four floats a pixel: the mean over the members that lie on the chosen one's surface.
static void mean_colour(const gbuffer *g, const float *from, int n, const int px[4], const int py[4], int chosen, float *to)
{
    vec3 p = gbuffer_position(g, px[chosen], py[chosen]), normal = normal_at(g, at(g, px[chosen], py[chosen]));
    double pixel = 1.0 / fmin(g->camera.fx, g->camera.fy), sum[4] = {0}, count = 0.0;
    if (g->camera.kind == CAMERA_PERSPECTIVE) pixel *= p.z;
    for (int k = 0; k < n; k++) {
        size_t i = at(g, px[k], py[k]);
        double off = fabs(v3_dot(normal, v3_sub(gbuffer_position(g, px[k], py[k]), p)));
        if (k != chosen && (off > SAME_SURFACE * pixel || v3_dot(normal, normal_at(g, i)) < 0.7)) continue;
        for (size_t c = 0; c < 4; c++) sum[c] += (double)from[4 * i + c];
        count += 1.0;
    }
    for (int c = 0; c < 4; c++) to[c] = (float)(sum[c] / count);
}

static bool halve_row(void *context, size_t row, int worker)
{
    (void)worker;
    halving *h = context;
    const gbuffer *g = h->g;
    gbuffer *out = h->out;
    for (int x = 0; x < out->width; x++) {
        int px[4], py[4], y = (int)row, n = members(g, x, y, px, py);
        if (n == 0) continue;
        double depth;
        bool own;
        int k = choose(g, x, y, n, px, py, &depth, &own);
        if (depth == 0.0) continue;
        size_t to = at(out, x, y), from = at(g, px[k], py[k]);
        out->depth[to] = (float)depth;
        memcpy(out->normal + 4 * to, g->normal + 4 * from, 3 * sizeof(float));
        out->normal[4 * to + 3] = (float)(px[k] - 2 * x + 2 * (py[k] - 2 * y) + (own ? 4 : 0));
        if (out->albedo) mean_colour(g, g->albedo, n, px, py, k, out->albedo + 4 * to);
        if (out->beauty) mean_colour(g, g->beauty, n, px, py, k, out->beauty + 4 * to);
        h->valid[row]++;
    }
    return true;
}

bool gbuffer_halve(const gbuffer *g, int threads, gbuffer *out, error *e)
{
    *out = *g;
    out->width = (g->width + 1) / 2, out->height = (g->height + 1) / 2;
    out->data_window = (box2){0, 0, out->width - 1, out->height - 1};
    out->display_window = out->data_window;
    out->camera.fx *= 0.5, out->camera.fy *= 0.5, out->camera.cx *= 0.5, out->camera.cy *= 0.5;
    out->depth = out->normal = out->albedo = out->beauty = NULL;
    out->material = out->emission = out->diffuse_direct = out->coverage = NULL;
    out->mixed = NULL, out->mixed_count = 0;
    size_t pixels = (size_t)out->width * (size_t)out->height;
    halving h = {g, out, mem_zero((size_t)out->height, sizeof *h.valid, e)};
    bool ok = h.valid && (out->depth = mem_zero(pixels, sizeof(float), e)) &&
              (out->normal = mem_zero(4 * pixels, sizeof(float), e)) &&
              (!g->albedo || (out->albedo = mem_zero(4 * pixels, sizeof(float), e))) &&
              (!g->beauty || (out->beauty = mem_zero(4 * pixels, sizeof(float), e)));
    if (ok) threads_for(threads, (size_t)out->height, halve_row, &h);
    out->valid = 0;
    for (int y = 0; ok && y < out->height; y++) out->valid += h.valid[y];
    free(h.valid);
    if (!ok) gbuffer_free(out);
    return ok;
}

void gbuffer_quarter_places(const gbuffer *half, gbuffer *quarter)
{
    for (int y = 0; y < quarter->height; y++)
        for (int x = 0; x < quarter->width; x++) {
            float *place = &quarter->normal[4 * at(quarter, x, y) + 3];
            if (quarter->depth[at(quarter, x, y)] == 0.0f) continue;
            int outer = (int)*place, dx = outer & 1, dy = (outer >> 1) & 1;
            int inner = (int)half->normal[4 * at(half, 2 * x + dx, 2 * y + dy) + 3];
            dx = 2 * dx + (inner & 1), dy = 2 * dy + ((inner >> 1) & 1);
            *place = (float)(dx + 4 * dy + (outer >= 4 ? 16 : 0));
        }
}
