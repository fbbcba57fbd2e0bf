// Scenes made here, with truth by ray casting: what Blender's samples do not have (closed forms live in tests/unit), and a check
// that nothing is tuned to one renderer.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/threads.h"
#include "bench.h"

enum { WIDTH = 320, HEIGHT = 180, AO_RAYS = 144, LIGHT_RAYS = 81, ROCKS = 5, SUBDIVISIONS = 3 };

// ---- rocks: spheres of triangles, bent by a few sines

typedef struct rock {
    vec3 *vertices;
    int (*triangles)[3];
    int vertex_count, triangle_count;
} rock;

static int middle(rock *r, int a, int b)
{
    vec3 m = v3_normalize(v3_add(r->vertices[a], r->vertices[b]));
    for (int i = 0; i < r->vertex_count; i++)
        if (v3_length(v3_sub(r->vertices[i], m)) < 1e-9) return i;
    r->vertices[r->vertex_count] = m;
    return r->vertex_count++;
}

static void subdivide(rock *r, int (*out)[3])
{
    for (int i = 0; i < r->triangle_count; i++) {
        const int *t = r->triangles[i];
        int m[3] = {middle(r, t[0], t[1]), middle(r, t[1], t[2]), middle(r, t[2], t[0])};
        const int four[4][3] = {{t[0], m[0], m[2]}, {m[0], t[1], m[1]}, {m[2], m[1], t[2]}, {m[0], m[1], m[2]}};
        memcpy(out + 4 * i, four, sizeof four);
    }
    memcpy(r->triangles, out, sizeof *out * 4 * (size_t)r->triangle_count);
    r->triangle_count *= 4;
}

static bool rock_make(rock *r, vec3 at, double size, double phase, error *e)
{
    static const int octahedron[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    size_t most = 8u << (2 * SUBDIVISIONS);
    int(*scratch)[3] = mem_zero(most, sizeof *scratch, e);
    r->triangles = mem_zero(most, sizeof *r->triangles, e);
    r->vertices = mem_zero(most, sizeof *r->vertices, e);
    if (!scratch || !r->triangles || !r->vertices) {
        free(scratch);
        return false;
    }
    for (int i = 0; i < 6; i++) {
        double sign = i % 2 ? -1.0 : 1.0;
        r->vertices[i] = i < 2 ? v3(sign, 0, 0) : i < 4 ? v3(0, sign, 0) : v3(0, 0, sign);
    }
    r->vertex_count = 6, r->triangle_count = 8;
    memcpy(r->triangles, octahedron, sizeof octahedron);
    for (int i = 0; i < SUBDIVISIONS; i++) subdivide(r, scratch);
    free(scratch);
    for (int i = 0; i < r->vertex_count; i++) {
        vec3 d = r->vertices[i];
        double bump =
            1.0 + 0.18 * sin(5.0 * d.x + phase) * sin(4.0 * d.y + 2.0 * phase) + 0.1 * sin(9.0 * d.z + 7.0 * d.x + phase);
        r->vertices[i] = v3_add(at, v3_scale(v3(d.x, 0.8 * d.y, 0.6 * d.z), size * bump));
    }
    return true;
}

static bool rocks_build(scene *s, rock *rocks, error *e)
{
    *s = (scene){.eye = v3(0.5, -6, 3.2), .target = v3(0, 0.2, 0.3), .radius = 1.0};
    scene_add_plane(s, v3(0, 0, 0), v3(0, 0, 1), v3(0.45, 0.4, 0.35));
    for (int i = 0; i < ROCKS; i++) {
        double turn = 2.4 * i;
        vec3 at = v3(0.75 * sqrt(i) * cos(turn), 0.9 * sqrt(i) * sin(turn), 0.25);
        if (!rock_make(&rocks[i], at, 0.9 - 0.11 * i, 1.7 * i, e)) return false;
        mesh m = {rocks[i].vertices, rocks[i].vertex_count, (const int(*)[3])rocks[i].triangles, rocks[i].triangle_count};
        scene_add_mesh(s, m, v3(0.5 + 0.08 * i, 0.5, 0.55 - 0.08 * i));
    }
    return true;
}

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
    bool known = cache_load(cache, k, blob, total * sizeof *blob);
    if (!known) threads_for(threads_default(), (size_t)s->height, truth_row, j);
    for (int i = 0; i < 6; at += sizes[i], i++) memcpy(known ? *parts[i] : at, known ? at : *parts[i], sizes[i] * sizeof(float));
    if (!known) cache_store(cache, k, blob, total * sizeof *blob);
    free(blob);
    return true;
}

static bool generate(bench_scene *b, const char *name, const scene *s, bool orthographic, const char *sky, const char *cache,
                     rig *r, error *e)
{
    view v = orthographic ? view_orthographic(WIDTH, HEIGHT, 6.0, 1.0) : view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&v, s);
    *b = (bench_scene){.generated = true, .radius = s->radius};
    snprintf(b->s.name, sizeof b->s.name, "%s", name);
    b->s.width = WIDTH, b->s.height = HEIGHT;
    size_t n = (size_t)WIDTH * HEIGHT;
    if (!scene_gbuffer(s, &v, &b->gb, e) || !bench_light(b, sky, 0.0, r, e)) return false;
    b->s.depth = mem_pixels(n, sizeof(float), e);
    if (!b->s.depth) return false;
    memcpy(b->s.depth, b->gb.depth, n * sizeof(float));
    b->s.scored = mem_zero(n, sizeof *b->s.scored, e);
    if (!b->s.scored) return false;
    for (size_t i = 0; i < n; i++) b->s.scored[i] = b->gb.depth[i] > 0.0f;
    bool meshes = s->shape_count > 0 && s->shapes[s->shape_count - 1].kind == SHAPE_MESH;
    embree *m = meshes ? embree_open(s, e) : NULL;
    truth_job work = {b, s, &v, m ? embree_tracer(m) : scene_tracer(s), m ? 2e-4 : 0.0};
    bool ok = (m || !meshes) && truth_make(&work, cache, e) && bench_prepare(b, e);
    embree_close(m);
    return ok;
}

static void build_sphere(scene *s) { scene_sphere(s, 1.0, 1.3, 1.5); }
static void build_slit(scene *s) { scene_slit(s, 1.0, 1.0); }
static void build_corner(scene *s) { scene_corner(s, 0.4); }
static void build_bar(scene *s) { scene_bar(s, 0.3, 0.2, 0.8, 0.0); }

int bench_generated(const char *sky, const char *cache, rig *r, bench_scene *list, int max, error *e)
{
    static const struct {
        const char *name;
        void (*build)(scene *s);
        bool orthographic;
    } simple[] = {{"clutter", scene_clutter, false}, {"clutter-ortho", scene_clutter, true},
                  {"corner", build_corner, false},   {"sphere", build_sphere, false},
                  {"slit", build_slit, false},       {"bar", build_bar, false}};
    static scene s;
    rock rocks[ROCKS] = {0};
    int n = 0;
    bool ok = true;
    for (size_t i = 0; ok && i < sizeof simple / sizeof *simple && n < max; i++) {
        simple[i].build(&s);
        ok = generate(&list[n], simple[i].name, &s, simple[i].orthographic, sky, cache, r, e);
        n += ok;
    }
    ok = ok && n < max && rocks_build(&s, rocks, e) && generate(&list[n], "rocks", &s, false, sky, cache, r, e);
    n += ok;
    for (int i = 0; i < ROCKS; i++) {
        free(rocks[i].vertices);
        free(rocks[i].triangles);
    }
    return ok ? n : 0;
}
