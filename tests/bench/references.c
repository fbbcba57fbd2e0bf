// Which brute-force reference belongs to which row, and their cache.
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/threads.h"
#include "bench.h"

// Points of the references' quadratures: enough that what is left is well below the error of 1024 samples.
enum { ELEVATIONS = 24, AZIMUTHS = 36, DISTANCES = 12, DISC = 64, KERNEL = 20, DIRECTIONS = 48, STEPS = 128, SLICES = 48 };

typedef enum reference_kind {
    REF_NONE,
    REF_SSDO,
    REF_ALCHEMY,
    REF_HORIZON,
    REF_BITMASK,
    REF_HEMISPHERE,
    REF_HBAO
} reference_kind;

typedef struct reference_job {
    const bench_scene *b;
    const bench_row *row;
    reference_kind kind;
    double radius, thickness, bias;
    double *out;
} reference_job;

static reference_kind kind_of(const bench_row *row)
{
    if (row->kind != ROW_METHOD) return REF_NONE;
    if (strcmp(row->m->name, "ssdo") == 0 || strcmp(row->m->name, "s3ho") == 0) return REF_SSDO; // the same point test
    if (strcmp(row->m->name, "alchemy") == 0) return REF_ALCHEMY;
    if (strcmp(row->m->name, "gtao") == 0) return REF_HORIZON;
    if (strcmp(row->m->name, "bitmask") == 0) return REF_BITMASK;
    if (strcmp(row->m->name, "hemisphere") == 0) return REF_HEMISPHERE;
    if (strcmp(row->m->name, "hbao") == 0) return REF_HBAO;
    return REF_NONE;
}

static bool one_pixel(void *context, size_t i, int worker)
{
    (void)worker;
    reference_job *j = context;
    const layer *l = &j->b->layer;
    pixel p = j->b->pixels[i];
    reference_ssdo_options so = {
        .radius = j->radius, .thickness = j->thickness, .elevations = ELEVATIONS, .azimuths = AZIMUTHS, .distances = DISTANCES};
    reference_alchemy_options ao = {.radius = j->radius, .measure = TAPS_UNIFORM_IN_RADIUS, .radii = DISC, .angles = DISC};
    reference_slice_options co = {.radius = j->radius, .thickness = j->thickness, .slices = SLICES};
    if (j->kind == REF_SSDO) j->out[i] = reference_ssdo(l, p, &so).occlusion;
    if (j->kind == REF_ALCHEMY) j->out[i] = reference_alchemy(l, p, &ao);
    if (j->kind == REF_HORIZON) j->out[i] = reference_horizon(l, p, &co);
    reference_hemisphere_options ho = {.radius = j->radius, .elevations = KERNEL, .azimuths = KERNEL, .distances = KERNEL};
    reference_hbao_options bo = {.radius = j->radius, .bias = j->bias, .directions = DIRECTIONS, .steps = STEPS};
    if (j->kind == REF_HEMISPHERE) j->out[i] = reference_hemisphere(l, p, &ho);
    if (j->kind == REF_HBAO) j->out[i] = fmax(0.0, reference_hbao(l, p, &bo));
    if (j->kind == REF_BITMASK) j->out[i] = reference_bitmask(l, p, &co);
    return true;
}

static cache_key key_of(const reference_job *j)
{
    static const char *sources[] = {"tests/lib/reference.c", "tests/lib/reference_points.c", "tests/lib/reference_slices.c",
                                    "tests/bench/references.c"};
    const gbuffer *gb = &j->b->gb;
    const camera *c = &gb->camera;
    size_t n = (size_t)gb->width * (size_t)gb->height;
    double numbers[] = {j->kind, j->radius, j->thickness, j->bias, c->kind, c->fx, c->fy, c->cx, c->cy, gb->width, gb->height};
    cache_key k = cache_add(cache_start("reference"), numbers, sizeof numbers);
    for (size_t i = 0; i < sizeof sources / sizeof *sources; i++) k = cache_add_file(k, sources[i]);
    k = cache_add(k, gb->depth, n * sizeof(float));
    k = cache_add(k, gb->normal, 4 * n * sizeof(float));
    return cache_add(k, j->b->pixels, (size_t)j->b->pixel_count * sizeof *j->b->pixels);
}

double *bench_reference(const bench_scene *b, const bench_row *row, const char *cache, error *e)
{
    if (row->kind != ROW_METHOD) return NULL;
    pass_settings set = bench_settings(row, b);
    reference_job j = {b, row, kind_of(row), set.radius, set.thickness, set.angle_bias * M_PI / 180.0, NULL};
    if (j.kind == REF_NONE) return NULL;
    if (j.kind != REF_SSDO && j.kind != REF_BITMASK) j.thickness = INFINITY; // the others have none
    size_t size = (size_t)b->pixel_count * sizeof *j.out;
    j.out = mem_pixels((size_t)b->pixel_count, sizeof *j.out, e);
    if (!j.out) return NULL;
    cache_key k = key_of(&j);
    if (!cache_load(cache, k, j.out, size)) {
        threads_for(threads_default(), (size_t)b->pixel_count, one_pixel, &j);
        cache_store(cache, k, j.out, size);
    }
    if (j.kind == REF_ALCHEMY) // the blocked measure itself: the look is the row's
        for (int i = 0; i < b->pixel_count; i++) j.out[i] = pow(fmax(0.0, 1.0 - row->scale * j.out[i]), row->contrast);
    return j.out;
}
