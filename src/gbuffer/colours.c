// The colour layers as finite floats.
#include <float.h>
#include <string.h>

#include "base/mem.h"
#include "base/threads.h"
#include "gbuffer/build.h"

static const float most = 1e30f;

typedef struct job {
    plane from[4];
    float fill[4];
    int components;  // of `to`
    float low, high; // what is beyond is brought here
    float *to;
    int width;
    atomic_size_t *bad;      // counts samples that are NaN or infinite
    atomic_size_t *negative; // and those below 0, where that has no meaning; NULL: it has
} job;

// NaN and -infinity are 0.
static float tamed(float v, float low, float high)
{
    if (v >= low && v <= high) return v;
    if (v > high) return high;
    return v >= -FLT_MAX ? low : 0.0f;
}

static void count_negative(const job *j, const float *values, int n)
{
    size_t count = 0;
    for (int i = 0; i < n; i++) count += values[i] < 0.0f;
    if (count) atomic_fetch_add(j->negative, count);
}

static void convert_block(const job *j, int x, int y, int n, size_t *bad)
{
    const size_t step = (size_t)j->components;
    float values[PLANE_BLOCK];
    for (int c = 0; c < j->components; c++) {
        float *to = j->to + ((size_t)y * (size_t)j->width + (size_t)x) * step + (size_t)c;
        if (j->from[c].data) *bad += plane_fetch(&j->from[c], x, y, n, values);
        if (j->negative && j->from[c].data) count_negative(j, values, n);
        for (int i = 0; i < n; i++, to += step) *to = j->from[c].data ? tamed(values[i], j->low, j->high) : j->fill[c];
    }
}

static bool convert_row(void *context, size_t row, int worker)
{
    (void)worker;
    const job *j = context;
    size_t bad = 0;
    for (int x = 0; x < j->width; x += PLANE_BLOCK)
        convert_block(j, x, (int)row, j->width - x < PLANE_BLOCK ? j->width - x : PLANE_BLOCK, &bad);
    if (bad) atomic_fetch_add(j->bad, bad);
    return true;
}

static bool convert(build *b, job *j, float **out)
{
    j->width = b->g->width;
    j->bad = &b->defects.colours;
    for (int c = 0; c < j->components; c++)
        b->defects.colour_samples += j->from[c].data ? (size_t)b->g->width * (size_t)b->g->height : 0;
    j->to = *out = mem_pixels((size_t)b->g->width * (size_t)b->g->height * (size_t)j->components, sizeof **out, b->e);
    return *out && threads_for(b->options->threads, (size_t)b->g->height, convert_row, j);
}

static bool colour(build *b, unsigned need, role r, float **out)
{
    if (!(b->options->need & need) || b->r->components[r] == 0) return true;
    job j = {.components = 4, .low = -most, .high = most};
    if (r == ROLE_ALBEDO) j.low = 0.0f, j.negative = &b->defects.negative_albedo; // no surface reflects less than nothing
    for (int c = 0; c < 3; c++) j.from[c] = build_plane(b, r, c);
    if (r == ROLE_BEAUTY) j.from[3] = build_plane(b, ROLE_ALPHA, 0), j.fill[3] = 1.0f;
    return convert(b, &j, out);
}

static bool material(build *b)
{
    if (!(b->options->need & NEED_MATERIAL) || b->r->components[ROLE_ROUGHNESS] == 0) return true;
    job j = {.components = 2, .high = 1.0f};
    j.from[0] = build_plane(b, ROLE_ROUGHNESS, 0), j.from[1] = build_plane(b, ROLE_METALLIC, 0);
    return convert(b, &j, &b->g->material);
}

// Without coverage: true, for nobody knows.
static bool sees_background(const gbuffer *g)
{
    size_t pixels = (size_t)g->width * (size_t)g->height;
    for (size_t i = 0; g->coverage && i < pixels; i++)
        if (g->coverage[i] < 1.0f) return true;
    return !g->coverage;
}

bool albedo_make(build *b) { return colour(b, NEED_ALBEDO, ROLE_ALBEDO, &b->g->albedo); }

bool colours_make(build *b)
{
    gbuffer *g = b->g;
    unsigned beauty = NEED_BEAUTY;
    if (b->options->need & NEED_BACKGROUND && sees_background(g)) beauty |= NEED_BACKGROUND;
    g->has_alpha = b->r->components[ROLE_ALPHA] > 0;
    g->has_diffuse_indirect = b->r->components[ROLE_DIFFUSE_INDIRECT] > 0;
    return colour(b, beauty, ROLE_BEAUTY, &g->beauty) && colour(b, NEED_EMISSION, ROLE_EMISSION, &g->emission) &&
           colour(b, NEED_DIFFUSE_LIGHT, ROLE_DIFFUSE_DIRECT, &g->diffuse_direct) && material(b);
}
