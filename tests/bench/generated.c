// Scenes made here, with truth by ray casting: what Blender's samples do not have (closed forms live in tests/unit), and a check
// that nothing is tuned to one renderer.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/threads.h"
#include "bench.h"
#include "scene_list.h"

enum { WIDTH = 320, HEIGHT = 180, AO_RAYS = 144, LIGHT_RAYS = 81 };

// ---- truth

typedef struct truth_job {
    bench_scene *b;
    const scene *s;
    const view *v;
    tracer t;
    double offset;
} truth_job;

static void put3(float *to, vec3 v) { to[0] = (float)v.x, to[1] = (float)v.y, to[2] = (float)v.z; }

static bool truth_row(void *context, size_t row, int worker)
{
    (void)worker;
    truth_job *j = context;
    sample *s = &j->b->s;
    for (int x = 0; x < s->width; x++) {
        hit h;
        size_t i = row * (size_t)s->width + (size_t)x;
        if (s->depth[i] <= 0.0f || !scene_at_pixel(j->s, j->v, x, (int)row, &h)) continue;
        for (int half = 0; half < 2; half++) {
            uint32_t seed = (uint32_t)(2 * i + (size_t)half) * 2654435761u + 1u;
            truth_options o = {.radius = j->b->radius, .rays = AO_RAYS, .seed = seed, .offset = j->offset, .bounce_rays = 1};
            s->ao[half][i] = (float)truth_occlusion(&j->t, h.position, h.normal, &o);
            o.radius = 0.0, o.rays = LIGHT_RAYS, o.sky = truth_environment_sky, o.sky_data = &j->b->env, o.seed += 77u;
            put3(s->direct[half] + 3 * i, truth_radiance(&j->t, h.position, h.normal, &o));
            o.seed += 77u;
            put3(s->indirect[half] + 3 * i, truth_indirect(&j->t, h.position, h.normal, &o));
        }
    }
    return true;
}

static cache_key truth_key(const bench_scene *b, const scene *s)
{
    static const int counts[] = {AO_RAYS, LIGHT_RAYS};
    static const char *sources[] = {"tests/lib/truth.c", "tests/lib/scene.c", "tests/bench/embree.c", "tests/bench/generated.c"};
    size_t n = (size_t)b->gb.width * (size_t)b->gb.height;
    cache_key k = cache_add(cache_start("truth"), counts, sizeof counts);
    for (size_t i = 0; i < sizeof sources / sizeof *sources; i++) k = cache_add_file(k, sources[i]);
    k = cache_add(k, b->gb.depth, n * sizeof(float));
    k = cache_add(k, b->gb.normal, 4 * n * sizeof(float));
    k = cache_add(k, &b->radius, sizeof b->radius);
    for (int i = 0; i < s->shape_count; i++) k = cache_add(k, &s->shapes[i].albedo, sizeof(vec3));
    return cache_add(k, b->env.levels[0].rgba,
                     sizeof(float) * 4 * (size_t)b->env.levels[0].width * (size_t)b->env.levels[0].height);
}

// The six pictures lie in one block, so that the cache keeps them as one blob; sample_free frees the parts.
static bool truth_make(truth_job *j, const char *cache, error *e)
{
    sample *s = &j->b->s;
    size_t n = (size_t)s->width * (size_t)s->height, sizes[6] = {n, n, 3 * n, 3 * n, 3 * n, 3 * n}, total = 14 * n;
    float **parts[6] = {&s->ao[0], &s->ao[1], &s->direct[0], &s->direct[1], &s->indirect[0], &s->indirect[1]};
    float *blob = mem_zero(total, sizeof *blob, e), *at = blob;
    cache_key k = truth_key(j->b, j->s);
    for (int i = 0; i < 6; i++) *parts[i] = mem_zero(sizes[i], sizeof(float), e);
    if (e->code != ERR_NONE) return false;
    bool known = bench_cache_load(cache, k, blob, total * sizeof *blob);
    if (!known) threads_for(threads_default(), (size_t)s->height, truth_row, j);
    for (int i = 0; i < 6; at += sizes[i], i++) memcpy(known ? *parts[i] : at, known ? at : *parts[i], sizes[i] * sizeof(float));
    if (!known) bench_cache_store(cache, k, blob, total * sizeof *blob);
    free(blob);
    return true;
}

static bool generate(bench_scene *b, const listed_scene *from, const char *sky, const char *cache, rig *r, error *e)
{
    static scene s;
    from->build(&s);
    view v = listed_view(from, &s, WIDTH, HEIGHT);
    *b = (bench_scene){.generated = true, .radius = s.radius};
    snprintf(b->s.name, sizeof b->s.name, "%s", from->name);
    b->s.width = WIDTH, b->s.height = HEIGHT;
    size_t n = (size_t)WIDTH * HEIGHT;
    if (!scene_gbuffer(&s, &v, &b->gb, e) || !bench_light(b, sky, 0.0, r, e)) return false;
    b->s.depth = mem_pixels(n, sizeof(float), e);
    if (!b->s.depth) return false;
    memcpy(b->s.depth, b->gb.depth, n * sizeof(float));
    b->s.scored = mem_zero(n, sizeof *b->s.scored, e);
    if (!b->s.scored) return false;
    for (size_t i = 0; i < n; i++) b->s.scored[i] = b->gb.depth[i] > 0.0f;
    bool meshes = s.shape_count > 0 && s.shapes[s.shape_count - 1].kind == SHAPE_MESH;
    embree *m = meshes ? embree_open(&s, e) : NULL;
    truth_job work = {b, &s, &v, m ? embree_tracer(m) : scene_tracer(&s), m ? 2e-4 : 0.0};
    bool ok = (m || !meshes) && truth_make(&work, cache, e) && bench_prepare(b, e);
    embree_close(m);
    return ok;
}

int bench_generated(const char *sky, const char *cache, rig *r, bench_scene *list, int max, error *e)
{
    int n = 0;
    for (const listed_scene *l = scene_list; l->name && n < max; l++, n++)
        if (!generate(&list[n], l, sky, cache, r, e)) return 0;
    return n;
}
