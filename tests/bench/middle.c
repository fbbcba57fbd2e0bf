// The middle third of a scene's picture, of which the camera no longer sees what stands beside it, and the spheres that stand for
// that (samples/render.py --export-proxies). Its truth is the whole scene's, cut out.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "bench.h"

typedef struct columns {
    int width, height, first, count;
} columns;

// `size` bytes a pixel. NULL stays NULL.
static void *cut(const void *from, size_t size, columns c, error *e)
{
    char *to = from ? mem_pixels((size_t)c.count * (size_t)c.height, size, e) : NULL;
    for (int y = 0; to && y < c.height; y++)
        memcpy(to + (size_t)y * (size_t)c.count * size, (const char *)from + (size_t)(y * c.width + c.first) * size,
               (size_t)c.count * size);
    return to;
}

// The mixed pixels whose neighbour lies inside, too.
static void cut_mixed(const gbuffer *from, columns c, gbuffer *out, error *e)
{
    out->mixed_count = 0;
    out->mixed = from->mixed ? mem_pixels(from->mixed_count, sizeof *out->mixed, e) : NULL;
    for (size_t i = 0; out->mixed && i < from->mixed_count; i++) {
        mixed_pixel m = from->mixed[i];
        int x = (int)(m.pixel & 0xffff) - c.first;
        if (x < 0 || x >= c.count || x + m.x < 0 || x + m.x >= c.count) continue;
        m.pixel = (m.pixel & 0xffff0000u) | (uint32_t)x;
        out->mixed[out->mixed_count++] = m;
    }
}

static void cut_gbuffer(const gbuffer *from, columns c, gbuffer *out, error *e)
{
    *out = *from;
    out->width = c.count;
    out->camera.cx -= c.first;
    out->depth = cut(from->depth, sizeof *from->depth, c, e);
    out->normal = cut(from->normal, 4 * sizeof *from->normal, c, e);
    out->albedo = cut(from->albedo, 4 * sizeof *from->albedo, c, e);
    out->beauty = out->material = out->emission = out->diffuse_direct = out->coverage = NULL;
    cut_mixed(from, c, out, e);
    out->valid = 0;
    for (int i = 0; out->depth && i < c.count * c.height; i++) out->valid += out->depth[i] > 0.0f;
}

static void cut_sample(const sample *from, columns c, sample *out, error *e)
{
    *out = *from;
    out->width = c.count;
    out->depth = out->beauty = out->alpha = out->albedo = out->normal = NULL;
    out->scored = cut(from->scored, sizeof *from->scored, c, e);
    for (int i = 0; i < 2; i++) {
        out->ao[i] = cut(from->ao[i], sizeof(float), c, e);
        out->direct[i] = cut(from->direct[i], 3 * sizeof(float), c, e);
        out->indirect[i] = cut(from->indirect[i], 3 * sizeof(float), c, e);
    }
}

bool bench_middle(bench_scene *b, const char *dir, error *e)
{
    char path[512];
    snprintf(path, sizeof path, "%s/proxies/%s.json", dir, b->s.name);
    if (access(path, R_OK) != 0) return true;
    columns c = {b->gb.width, b->gb.height, b->gb.width / 3, b->gb.width / 3};
    b->middle = mem_zero(1, sizeof *b->middle, e);
    if (!b->middle || !proxies_load(path, &b->proxies, e)) return false;
    b->middle->radius = b->radius;
    b->middle->env = b->env, b->middle->env_image = b->env_image, b->middle->sunless = b->sunless; // borrowed
    cut_gbuffer(&b->gb, c, &b->middle->gb, e);
    cut_sample(&b->s, c, &b->middle->s, e);
    return e->code == ERR_NONE;
}

void bench_middle_free(bench_scene *b)
{
    proxies_free(&b->proxies);
    if (!b->middle) return;
    sample_free(&b->middle->s);
    gbuffer_free(&b->middle->gb);
    free(b->middle);
}
