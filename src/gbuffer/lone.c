#include <stdlib.h>

#include "base/mem.h"
#include "base/threads.h"
#include "gbuffer/half_size.h"

// How far a small pixel may lie off a pixel's tangent plane, in pixels at its depth, and the least cosine of their normals, for
// its light to count.
static const double NEAR = 1.5, LIKE = 0.87;
// A pixel stands alone if the small pixels around it that count have less than this share of the bilinear weight.
static const double LEAST_SHARE = 0.3;

typedef struct search {
    const gbuffer *whole, *small;
    unsigned char *lone; // of each pixel
    size_t *count;       // of each row
} search;

static size_t at(const gbuffer *g, int x, int y) { return (size_t)y * (size_t)g->width + (size_t)x; }

static vec3 normal_at(const gbuffer *g, size_t i)
{
    const float *n = g->normal + 4 * i;
    return v3((double)n[0], (double)n[1], (double)n[2]);
}

// Whether the small pixel shows the surface that lies at `p` with normal `n`.
static bool shows(const gbuffer *small, int x, int y, vec3 p, vec3 n, double margin)
{
    if (x < 0 || y < 0 || x >= small->width || y >= small->height || !(small->depth[at(small, x, y)] > 0.0f)) return false;
    return v3_dot(n, normal_at(small, at(small, x, y))) >= LIKE &&
           fabs(v3_dot(n, v3_sub(gbuffer_position(small, x, y), p))) <= margin;
}

static bool is_lone(const search *s, int x, int y)
{
    const gbuffer *g = s->whole;
    vec3 p = gbuffer_position(g, x, y), n = normal_at(g, at(g, x, y));
    double margin = NEAR / fmin(g->camera.fx, g->camera.fy), share = 0.0;
    if (g->camera.kind == CAMERA_PERSPECTIVE) margin *= p.z;
    // The pixel's own block first: its share is enough.
    for (int k = 0; k < 4 && share < LEAST_SHARE; k++) {
        bool aside = k & 1, across = k >> 1;
        int sx = x / 2 + (aside ? 2 * (x % 2) - 1 : 0), sy = y / 2 + (across ? 2 * (y % 2) - 1 : 0);
        if (shows(s->small, sx, sy, p, n, margin)) share += (aside ? 0.25 : 0.75) * (across ? 0.25 : 0.75);
    }
    return share < LEAST_SHARE;
}

static bool search_row(void *context, size_t row, int worker)
{
    (void)worker;
    search *s = context;
    for (int x = 0; x < s->whole->width; x++) {
        size_t i = at(s->whole, x, (int)row);
        s->lone[i] = s->whole->depth[i] > 0.0f && is_lone(s, x, (int)row);
        s->count[row] += s->lone[i];
    }
    return true;
}

bool gbuffer_lone(const gbuffer *whole, const gbuffer *small, int threads, pixel_list *out, error *e)
{
    *out = (pixel_list){0};
    size_t pixels = (size_t)whole->width * (size_t)whole->height;
    search s = {whole, small, mem_zero(pixels, 1, e), NULL};
    bool ok = s.lone && (s.count = mem_zero((size_t)whole->height, sizeof *s.count, e));
    if (ok) threads_for(threads, (size_t)whole->height, search_row, &s);
    for (int y = 0; ok && y < whole->height; y++) out->count += s.count[y];
    ok = ok && (out->count == 0 || (out->pixels = mem_zero(out->count, sizeof *out->pixels, e)));
    size_t n = 0;
    for (size_t i = 0; ok && n < out->count; i++)
        if (s.lone[i]) out->pixels[n++] = (uint32_t)(i % (size_t)whole->width) | (uint32_t)(i / (size_t)whole->width) << 16;
    free(s.lone);
    free(s.count);
    return ok;
}

void pixel_list_free(pixel_list *l)
{
    free(l->pixels);
    *l = (pixel_list){0};
}
