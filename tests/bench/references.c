// The references of the rows, and their cache.
#include <stdlib.h>

#include "base/mem.h"
#include "base/threads.h"
#include "bench.h"

typedef struct reference_job {
    const bench_scene *b;
    method_reference_options options;
    const float *radiance;
    double *out;
} reference_job;

static void put3(double *to, vec3 v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

static bool one_pixel(void *context, size_t i, int worker)
{
    (void)worker;
    reference_job *j = context;
    method_reference_value v = method_reference(&j->b->layer, j->b->pixels[i], &j->options);
    j->out[4 * i] = v.occlusion;
    put3(j->out + 4 * i + 1, v.radiance);
    return true;
}

static cache_key add_scene(cache_key k, const bench_scene *b)
{
    static const char *sources[] = {"tests/lib/reference.c", "tests/lib/reference_points.c", "tests/lib/reference_slices.c",
                                    "tests/lib/reference_kernel.c", "tests/lib/method_reference.c"};
    const gbuffer *gb = &b->gb;
    const camera *c = &gb->camera;
    size_t n = (size_t)gb->width * (size_t)gb->height;
    double numbers[] = {c->kind, c->fx, c->fy, c->cx, c->cy, gb->width, gb->height};
    for (size_t i = 0; i < sizeof sources / sizeof *sources; i++) k = cache_add_file(k, sources[i]);
    k = cache_add(k, numbers, sizeof numbers);
    k = cache_add(k, gb->depth, n * sizeof(float));
    k = cache_add(k, gb->normal, 4 * n * sizeof(float));
    return cache_add(k, b->pixels, (size_t)b->pixel_count * sizeof *b->pixels);
}

static cache_key key_of(const reference_job *j)
{
    const pass_settings *s = j->options.set;
    const environment *env = &j->b->env;
    double numbers[] = {s->radius, s->thickness, s->angle_bias, s->sh_sigma, s->scale, s->contrast};
    cache_key k = add_scene(cache_start(j->options.method->name), j->b);
    if (!method_references_light(j->options.method)) return cache_add(k, numbers, sizeof numbers);
    k = cache_add(cache_add(k, env->sh, sizeof env->sh), &env->map_from_world, sizeof env->map_from_world);
    return cache_add(k, numbers, sizeof numbers);
}

double *bench_reference(const bench_scene *b, const bench_row *row, const char *cache, error *e)
{
    if (row->kind != ROW_METHOD || !method_has_reference(row->m)) return NULL;
    pass_settings set = bench_settings(row, b);
    reference_job j = {.b = b, .options = {.method = row->m, .set = &set, .env = &b->env}};
    size_t size = 4 * (size_t)b->pixel_count * sizeof *j.out;
    j.out = mem_pixels((size_t)b->pixel_count, 4 * sizeof *j.out, e);
    if (!j.out) return NULL;
    cache_key k = key_of(&j);
    if (!bench_cache_load(cache, k, j.out, size)) {
        threads_for(threads_default(), (size_t)b->pixel_count, one_pixel, &j);
        bench_cache_store(cache, k, j.out, size);
    }
    return j.out;
}

static bool one_receiver(void *context, size_t i, int worker)
{
    (void)worker;
    reference_job *j = context;
    put3(j->out + 3 * i, reference_vpl(&j->b->layer, bench_vpl_pixel(j->b, (int)i), j->radiance));
    return true;
}

double *bench_reference_vpl(const bench_scene *b, const float *radiance, const char *cache, error *e)
{
    size_t n = (size_t)b->gb.width * (size_t)b->gb.height, size = 3 * BENCH_VPL_PIXELS * sizeof(double);
    reference_job j = {.b = b, .radiance = radiance, .out = mem_pixels(BENCH_VPL_PIXELS, 3 * sizeof(double), e)};
    if (!j.out) return NULL;
    cache_key k = add_scene(cache_start("vpl"), b);
    k = cache_add(cache_add(k, radiance, 3 * n * sizeof *radiance), b->gb.albedo, 4 * n * sizeof(float));
    if (!bench_cache_load(cache, k, j.out, size)) {
        threads_for(threads_default(), BENCH_VPL_PIXELS, one_receiver, &j);
        bench_cache_store(cache, k, j.out, size);
    }
    return j.out;
}
