#include "passes/trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/mem.h"
#include "base/sort.h"
#include "gbuffer/mesh.h"

_Static_assert(GRID_COUNT == GRID_LEVELS && HIT_NOTHING == TRACE_MISS && HIT_NO_RAY == TRACE_NO_RAY,
               "shaders/include/constants.glsl");

enum { FIRST_CHUNK = 1024, SMALLEST_CHUNK = 64, LARGEST_CHUNK = 1 << 20 };
static const double WANTED_MS = 15.0; // of a dispatch: far below what any watchdog minds

// ---- opening

// The median of a few thousand vertices.
static vec3 middle_of(const obj_mesh *m)
{
    enum { MOST = 4096 };
    double v[3][MOST];
    size_t stride = m->vertex_count / MOST + 1, n = 0;
    for (size_t i = 0; i < m->vertex_count && n < MOST; i += stride, n++)
        v[0][n] = m->vertices[i].x, v[1][n] = m->vertices[i].y, v[2][n] = m->vertices[i].z;
    for (int k = 0; k < 3; k++) sort_doubles(v[k], n);
    return v3(v[0][n / 2], v[1][n / 2], v[2][n / 2]);
}

static float *shifted_vertices(const obj_mesh *m, vec3 origin, error *e)
{
    float *v = mem_pixels(3 * m->vertex_count, sizeof *v, e);
    for (size_t i = 0; v && i < m->vertex_count; i++) {
        vec3 p = v3_sub(m->vertices[i], origin);
        v[3 * i] = (float)p.x, v[3 * i + 1] = (float)p.y, v[3 * i + 2] = (float)p.z;
    }
    return v;
}

static bool upload_triangles(trace_scene *s, gpu *g, const obj_mesh *m, const float *vertices, error *e)
{
    float(*t)[3][4] = mem_pixels(m->triangle_count, sizeof *t, e);
    if (!t) return false;
    for (size_t i = 0; i < m->triangle_count; i++) {
        const float *corner = vertices + 3 * (size_t)m->triangles[i][0];
        for (size_t c = 0; c < 3; c++) {
            const float *v = vertices + 3 * (size_t)m->triangles[i][c];
            for (size_t k = 0; k < 3; k++) t[i][c][k] = c ? v[k] - corner[k] : v[k];
            t[i][c][3] = m->albedo[i][c];
        }
    }
    bool ok = gpu_buffer_make(g, &s->triangles, t, m->triangle_count * sizeof *t, "the mesh", e);
    free(t);
    return ok;
}

static bool open_grid(trace_scene *s, gpu *g, const float *vertices, const obj_mesh *m, error *e)
{
    grid made;
    if (!grid_make(vertices, m->triangles[0], m->triangle_count, &made, e)) return false;
    for (int l = 0; l < GRID_LEVELS; l++) {
        const grid_level *level = &made.level[l];
        memcpy(s->grid.low[l], level->low, sizeof level->low);
        memcpy(s->grid.cell[l], level->cell, sizeof level->cell);
        memcpy(s->grid.size[l], level->size, sizeof level->size);
        s->grid.size[l][3] = (int)level->first;
    }
    s->chunk = FIRST_CHUNK;
    bool ok =
        gpu_buffer_make(g, &s->offsets, made.offsets, (made.offset_count + 1) * sizeof *made.offsets, "the mesh's grid", e) &&
        gpu_buffer_make(g, &s->items, made.items, (made.item_count + 1) * sizeof *made.items, "the mesh's grid", e);
    grid_free(&made);
    return ok;
}

static bool open_tracer(trace_scene *s, gpu *g, trace_backend backend, const float *vertices, const obj_mesh *m, int threads,
                        log_t *log, error *e)
{
    error missing = {0};
    if (backend != TRACE_GPU) {
        if (trace_cpu_open(vertices, m->vertex_count, m->triangles[0], m->triangle_count, threads, &s->cpu, &missing)) {
            log_info(log, "mesh: %zu triangles, traced by Embree", m->triangle_count);
            return true;
        }
        if (backend == TRACE_EMBREE) return err_set(e, missing.code, NULL, NULL, "%s", missing.message);
        log_info(log, "%s", missing.message);
    }
    log_info(log, "mesh: %zu triangles, traced in a grid on %s", m->triangle_count, g->renderer);
    return open_grid(s, g, vertices, m, e);
}

bool trace_scene_open(trace_scene *s, gpu *g, const char *path, trace_backend backend, int threads, log_t *log, error *e)
{
    if (s->path && strcmp(s->path, path) == 0) return true;
    trace_scene_close(s);
    obj_mesh m;
    if (!mesh_read_obj(path, &m, log, e)) return false;
    s->origin = middle_of(&m);
    s->coloured = m.coloured;
    s->triangle_count = m.triangle_count;
    float *vertices = shifted_vertices(&m, s->origin, e);
    bool ok = vertices && upload_triangles(s, g, &m, vertices, e) && open_tracer(s, g, backend, vertices, &m, threads, log, e) &&
              (s->path = mem_string(path, e)) != NULL;
    free(vertices);
    mesh_free(&m);
    if (!ok) trace_scene_close(s);
    return ok;
}

void trace_scene_close(trace_scene *s)
{
    trace_cpu_close(s->cpu);
    gpu_buffer_free(&s->triangles);
    gpu_buffer_free(&s->offsets);
    gpu_buffer_free(&s->items);
    gpu_buffer_free(&s->alias_table);
    free(s->rays);
    free(s->hits);
    free(s->path);
    *s = (trace_scene){0};
}

// ---- tracing

static bool send_to_embree(trace_scene *s, gpu *g, const gpu_buffer *rays, gpu_buffer *hits, size_t count, error *e)
{
    if (count > s->capacity) {
        free(s->rays), free(s->hits);
        s->capacity = 0;
        s->rays = mem_pixels(count, sizeof *s->rays, e);
        s->hits = mem_pixels(count, sizeof *s->hits, e);
        if (!s->rays || !s->hits) return false;
        s->capacity = count;
    }
    gpu_buffer_read(g, rays, s->rays, count * sizeof *s->rays);
    trace_cpu_rays(s->cpu, s->rays, s->hits, count);
    gpu_buffer_write(g, hits, s->hits, count * sizeof *s->hits);
    return true;
}

// At most twice as many rays at a time: the next ones may be longer.
static size_t next_chunk(size_t n, double took)
{
    double chunk = (double)n * fmin(2.0, WANTED_MS / fmax(took, 1e-3));
    return chunk < SMALLEST_CHUNK ? SMALLEST_CHUNK : chunk > LARGEST_CHUNK ? LARGEST_CHUNK : (size_t)chunk;
}

static bool send_to_grid(trace_scene *s, pass_context *c, const gpu_buffer *rays, gpu_buffer *hits, size_t count, error *e)
{
    for (size_t first = 0, n; first < count; first += n) {
        double start = clock_wall_ms();
        n = count - first < s->chunk ? count - first : s->chunk;
        const pass_call call = {
            .program = "trace_grid",
            .untimed = true,
            .groups = {(int)((n + 63) / 64), 1},
            .range = {(int)first, (int)(first + n)},
            PASS_PARAMS(s->grid),
            .buffers =
                {{"Rays", rays}, {"Hits", hits}, {"Triangles", &s->triangles}, {"Offsets", &s->offsets}, {"Items", &s->items}},
        };
        if (!pass_run(c, &call, e)) return false;
        glFinish();
        double took = clock_wall_ms() - start;
        if (n == s->chunk || took > WANTED_MS) s->chunk = next_chunk(n, took);
    }
    return true;
}

void trace_longer_rays(trace_scene *s) { s->chunk = FIRST_CHUNK; }

bool trace_send(trace_scene *s, pass_context *c, const gpu_buffer *rays, gpu_buffer *hits, size_t count, error *e)
{
    return s->cpu ? send_to_embree(s, c->g, rays, hits, count, e) : send_to_grid(s, c, rays, hits, count, e);
}
