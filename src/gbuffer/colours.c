// The colour layers as finite floats.
#include <float.h>

#include "base/mem.h"
#include "base/threads.h"
#include "gbuffer/build.h"

static const float most = 1e30f;

typedef struct job {
    plane from[4];
    float fill[4];
    int components; // of `to`
    bool unit;      // clamp to 0..1
    float *to;
    int width;
    atomic_size_t *bad; // counts samples that are NaN or infinite
} job;

static float tamed(double v, bool unit)
{
    double low = unit ? 0.0 : -(double)most, high = unit ? 1.0 : (double)most;
    if (v >= low && v <= high) return (float)v;
    if (v > high) return (float)high;
    return v >= -DBL_MAX && !unit ? -most : 0.0f; // NaN and -infinity are 0
}

static bool convert_row(void *context, size_t row, int worker)
{
    (void)worker;
    const job *j = context;
    const size_t step = (size_t)j->components;
    size_t bad = 0;
    for (int c = 0; c < j->components; c++) {
        const plane from = j->from[c];
        float *to = j->to + row * (size_t)j->width * step + (size_t)c;
        for (int x = 0; x < j->width; x++, to += step) {
            double v = from.data ? plane_get(&from, x, (int)row) : (double)j->fill[c];
            bad += !isfinite(v) && plane_holds(&from, x, (int)row);
            *to = tamed(v, j->unit && from.data);
        }
    }
    if (bad) atomic_fetch_add(j->bad, bad);
    return true;
}

static bool convert(build *b, job *j, float **out)
{
    j->width = b->g->width;
    j->bad = &b->bad_colours;
    for (int c = 0; c < j->components; c++) b->colour_samples += j->from[c].data ? (size_t)b->g->width * (size_t)b->g->height : 0;
    j->to = *out = mem_pixels((size_t)b->g->width * (size_t)b->g->height * (size_t)j->components, sizeof **out, b->e);
    return *out && threads_for(b->options->threads, (size_t)b->g->height, convert_row, j);
}

static bool colour(build *b, unsigned need, role r, float **out)
{
    if (!(b->options->need & need) || b->r->components[r] == 0) return true;
    job j = {.components = 4};
    for (int c = 0; c < 3; c++) j.from[c] = build_plane(b, r, c);
    if (r == ROLE_BEAUTY) j.from[3] = build_plane(b, ROLE_ALPHA, 0), j.fill[3] = 1.0f;
    return convert(b, &j, out);
}

static bool material(build *b)
{
    if (!(b->options->need & NEED_MATERIAL) || b->r->components[ROLE_ROUGHNESS] == 0) return true;
    job j = {.components = 2, .unit = true};
    j.from[0] = build_plane(b, ROLE_ROUGHNESS, 0), j.from[1] = build_plane(b, ROLE_METALLIC, 0);
    return convert(b, &j, &b->g->material);
}

bool colours_make(build *b)
{
    gbuffer *g = b->g;
    g->has_alpha = b->r->components[ROLE_ALPHA] > 0;
    g->has_diffuse_indirect = b->r->components[ROLE_DIFFUSE_INDIRECT] > 0;
    return colour(b, NEED_ALBEDO, ROLE_ALBEDO, &g->albedo) && colour(b, NEED_BEAUTY, ROLE_BEAUTY, &g->beauty) &&
           colour(b, NEED_EMISSION, ROLE_EMISSION, &g->emission) &&
           colour(b, NEED_DIFFUSE_LIGHT, ROLE_DIFFUSE_DIRECT, &g->diffuse_direct) && material(b);
}
