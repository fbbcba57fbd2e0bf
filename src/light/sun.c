#include "light/sun.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"

static const double BRIGHT = 10.0;   // times the mean luminance
static const double LARGEST = 0.02;  // sr
static const double SMALLEST = 0.01; // of the map's flux

typedef struct finder {
    const env_level *map;
    unsigned char *seen;
    int *stack, *members; // texel indices
    int member_count;
    double threshold, total; // luminance; flux
} finder;

static double luminance_of(const float *c) { return luminance((double)c[0], (double)c[1], (double)c[2]); }

static bool bright(const finder *f, int i) { return luminance_of(f->map->rgba + 4 * (size_t)i) > f->threshold; }

// The connected bright texels around one, the map's sides joined.
static void grow(finder *f, int start)
{
    int w = f->map->width, h = f->map->height, top = 0;
    f->member_count = 0;
    f->stack[top++] = start;
    f->seen[start] = 1;
    while (top > 0) {
        int i = f->stack[--top], x = i % w, y = i / w;
        f->members[f->member_count++] = i;
        const int next[4] = {y * w + (x + 1) % w, y * w + (x + w - 1) % w, y > 0 ? i - w : i, y + 1 < h ? i + w : i};
        for (int k = 0; k < 4; k++)
            if (!f->seen[next[k]] && bright(f, next[k])) f->seen[next[k]] = 1, f->stack[top++] = next[k];
    }
}

static vec3 direction_of(const env_level *map, int i)
{
    double u = (i % map->width + 0.5) / map->width, v = (i / map->width + 0.5) / map->height;
    double phi = (0.5 - u) * 2.0 * M_PI, theta = v * M_PI;
    return v3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
}

// What exceeds the threshold in the members.
static sun measure(const finder *f)
{
    sun s = {0};
    vec3 sum = v3(0, 0, 0);
    for (int m = 0; m < f->member_count; m++) {
        int i = f->members[m];
        const float *c = f->map->rgba + 4 * (size_t)i;
        double y = luminance_of(c), w = env_texel_solid_angle(f->map->width, f->map->height, i / f->map->width);
        double share = 1.0 - f->threshold / y;
        for (int k = 0; k < 3; k++) s.flux[k] += (double)c[k] * share * w;
        s.solid_angle += w;
        sum = v3_add(sum, v3_scale(direction_of(f->map, i), y * share * w));
    }
    s.direction = v3_normalize(sum);
    return s;
}

static double flux_of(const sun *s) { return luminance(s->flux[0], s->flux[1], s->flux[2]); }

typedef struct candidate {
    sun s;
    int start;
} candidate;

// Keeps the brightest SUNS_MAX, in order. Returns the new count.
static int keep(candidate *list, int count, candidate c)
{
    int at = count;
    while (at > 0 && flux_of(&list[at - 1].s) < flux_of(&c.s)) at--;
    for (int i = count < SUNS_MAX ? count : SUNS_MAX - 1; i > at; i--) list[i] = list[i - 1];
    if (at < SUNS_MAX) list[at] = c;
    return count < SUNS_MAX ? count + 1 : count;
}

static int find(finder *f, candidate list[SUNS_MAX])
{
    int texels = f->map->width * f->map->height, count = 0;
    for (int i = 0; i < texels; i++) {
        if (f->seen[i] || !bright(f, i)) continue;
        grow(f, i);
        candidate c = {measure(f), i};
        if (c.s.solid_angle <= LARGEST && flux_of(&c.s) >= SMALLEST * f->total) count = keep(list, count, c);
    }
    memset(f->seen, 0, (size_t)f->map->width * (size_t)f->map->height);
    return count;
}

// Leaves the threshold in the texels around a start.
static void take_out(finder *f, int start, float *rgb)
{
    grow(f, start);
    for (int m = 0; m < f->member_count; m++) {
        size_t i = (size_t)f->members[m];
        double share = f->threshold / luminance_of(f->map->rgba + 4 * i);
        for (size_t k = 0; k < 3; k++) rgb[3 * i + k] = (float)((double)f->map->rgba[4 * i + k] * share);
    }
}

bool sun_split(const environment *env, int threads, sun_set *suns, environment *rest, log_t *log, error *e)
{
    bool ok = false;
    const env_level *map = &env->levels[0];
    size_t texels = (size_t)map->width * (size_t)map->height;
    double mean = luminance(env->mean[0], env->mean[1], env->mean[2]);
    finder f = {.map = map, .threshold = BRIGHT * mean, .total = 4.0 * M_PI * mean};
    float *rgb = mem_pixels(texels, 3 * sizeof *rgb, e);
    *suns = (sun_set){0};
    *rest = (environment){0};
    f.seen = mem_zero(texels, 1, e);
    f.stack = mem_zero(texels, sizeof *f.stack, e);
    f.members = mem_zero(texels, sizeof *f.members, e);
    if (!rgb || !f.seen || !f.stack || !f.members) goto out;
    for (size_t i = 0; i < texels; i++)
        for (size_t k = 0; k < 3; k++) rgb[3 * i + k] = map->rgba[4 * i + k];
    candidate list[SUNS_MAX];
    suns->count = find(&f, list);
    for (int i = 0; i < suns->count; i++) {
        suns->suns[i] = list[i].s;
        take_out(&f, list[i].start, rgb);
    }
    env_options same = {.path = "environment without its suns", .up_z = true, .scale = 1.0, .threads = threads};
    ok = suns->count == 0 || environment_prepare(rgb, map->width, map->height, &same, rest, log, e);
    rest->map_from_world = env->map_from_world;
out:
    free(f.members);
    free(f.stack);
    free(f.seen);
    free(rgb);
    return ok;
}
