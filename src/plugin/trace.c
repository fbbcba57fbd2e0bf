#include "plugin/trace.h"

#include <stdlib.h>

#include "base/mem.h"
#include "base/threads.h"
#include "plugin/module.h"

static const module tracing = {"ssdo-trace.so", "Embree 3"};

struct trace_cpu {
    void *scene;
    trace_rays_fn rays;
    trace_close_fn close;
    int threads;
};

static module_call function(const char *name, error *e)
{
    return module_function(&tracing, name, "--trace embree", ERR_USAGE, NULL, e);
}

bool trace_cpu_open(const float *vertices, size_t vertex_count, const uint32_t *triangles, size_t triangle_count, int threads,
                    trace_cpu **out, error *e)
{
    char message[MODULE_MESSAGE] = "";
    *out = NULL;
    trace_open_fn open = (trace_open_fn)function("ssdo_trace_open", e);
    trace_cpu *t = open ? mem_zero(1, sizeof *t, e) : NULL;
    if (!t) return false;
    t->rays = (trace_rays_fn)function("ssdo_trace_rays", e);
    t->close = (trace_close_fn)function("ssdo_trace_close", e);
    t->threads = threads;
    if (t->rays && t->close) {
        t->scene = open(vertices, vertex_count, triangles, triangle_count, threads, message, sizeof message);
        if (!t->scene) err_set(e, ERR_MEMORY, NULL, NULL, "%s", message);
    }
    if (!t->scene) {
        free(t);
        return false;
    }
    *out = t;
    return true;
}

enum { PACKET = 2048 }; // rays a thread takes at a time

typedef struct work {
    const trace_cpu *t;
    const trace_ray *rays;
    trace_hit *hits;
    size_t count;
} work;

static bool trace_packet(void *context, size_t item, int worker)
{
    const work *w = context;
    (void)worker;
    size_t first = item * PACKET, left = w->count - first;
    w->t->rays(w->t->scene, w->rays + first, w->hits + first, left < PACKET ? left : PACKET);
    return true;
}

void trace_cpu_rays(const trace_cpu *t, const trace_ray *rays, trace_hit *hits, size_t count)
{
    work w = {t, rays, hits, count};
    threads_for(t->threads, (count + PACKET - 1) / PACKET, trace_packet, &w);
}

void trace_cpu_close(trace_cpu *t)
{
    if (!t) return;
    t->close(t->scene);
    free(t);
}
