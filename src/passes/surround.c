#include "passes/surround.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/threads.h"
#include "passes/openings.h"

// While it is made a map is lat-long, in the axes of the environment's.
enum { W = 512, H = 256, SIDE = SURROUND_SIDE, COARSE = SURROUND_COARSE, MOST_SPLAT = 4, FILL_ROUNDS = 3, FILL_LEAST = 4 };

// While the map is made: 0 unknown, EMPTY known to be empty, else a distance.
static const float EMPTY = INFINITY;

// Column and row of a direction, not rounded.
static void place_of(vec3 d, double *x, double *y)
{
    *x = (0.5 - atan2(d.y, d.x) / (2.0 * M_PI)) * W;
    *y = acos(fmin(1.0, fmax(-1.0, d.z))) / M_PI * H;
}

static int wrapped(int x) { return ((x % W) + W) % W; }

// Marks the texels within half an angle `size` of a direction: columns are narrower near the poles.
static void mark(float *shell, vec3 d, double size, float value)
{
    double x, y, half = 0.5 * size / M_PI * H;
    place_of(d, &x, &y);
    double sine = fmax(sqrt(fmax(0.0, 1.0 - d.z * d.z)), 1.0 / H);
    int down = (int)fmin(half, MOST_SPLAT), across = (int)fmin(half / sine, W / 2.0);
    for (int j = -down; j <= down; j++)
        for (int i = -across; i <= across; i++) {
            int row = (int)y + j;
            if (row < 0 || row >= H) continue;
            float *t = &shell[row * W + wrapped((int)x + i)];
            if (value == EMPTY ? *t == 0.0f : (*t == 0.0f || value < *t)) *t = value;
        }
}

static vec3 vector_at(const float *list, size_t i)
{
    return v3((double)list[3 * i], (double)list[3 * i + 1], (double)list[3 * i + 2]);
}

static void add_points(float *shell, mat3 map_from_world, vec3 eye, const world_view *v)
{
    for (size_t i = 0; i < v->point_count; i++) {
        vec3 p = m3_apply(map_from_world, v3_sub(vector_at(v->points, i), eye));
        double far = v3_length(p);
        if (far > 0.0) mark(shell, v3_scale(p, 1.0 / far), v->pixel, (float)far);
    }
}

static void add_empty(float *shell, mat3 map_from_world, const world_view *v)
{
    for (size_t i = 0; i < v->empty_count; i++) mark(shell, m3_apply(map_from_world, vector_at(v->empty, i)), v->pixel, EMPTY);
}

// Gaps of a few texels, as between the points of a perspective view, whose pixels are not the map's: the nearest of the
// neighbours.
static void fill(float *shell, float *scratch)
{
    for (int round = 0; round < FILL_ROUNDS; round++) {
        memcpy(scratch, shell, sizeof *shell * W * H);
        for (int y = 1; y + 1 < H; y++)
            for (int x = 0; x < W; x++) {
                int known = 0;
                float nearest = EMPTY;
                if (scratch[y * W + x] != 0.0f) continue;
                for (int k = 0; k < 9; k++) {
                    float v = scratch[(y + k / 3 - 1) * W + wrapped(x + k % 3 - 1)];
                    known += v != 0.0f;
                    if (v != 0.0f) nearest = fminf(nearest, v);
                }
                if (known >= FILL_LEAST) shell[y * W + x] = nearest;
            }
    }
}

// What shows the outdoors becomes an opening, with what is seen through it behind.
static bool find_openings(const float *shell, float (*out)[2], error *e)
{
    float *rim = mem_pixels((size_t)W * H, sizeof *rim, e);
    bool ok = rim && outdoors_find(shell, W, H, true, rim, e);
    for (int i = 0; ok && i < W * H; i++) {
        out[i][0] = rim[i] > 0.0f ? -rim[i] : shell[i];
        out[i][1] = shell[i] == EMPTY ? 0.0f : shell[i];
    }
    free(rim);
    return ok;
}

// ---- from lat-long to octahedral

vec3 surround_direction(double x, double y, int side)
{
    double u = 2.0 * x / side - 1.0, v = 2.0 * y / side - 1.0, z = 1.0 - fabs(u) - fabs(v);
    vec3 d = z >= 0.0 ? v3(u, v, z) : v3(copysign(1.0 - fabs(v), u), copysign(1.0 - fabs(u), v), z);
    return v3_scale(d, 1.0 / v3_length(d));
}

size_t surround_texel(vec3 d, int side)
{
    double sum = fabs(d.x) + fabs(d.y) + fabs(d.z), u = d.x / sum, v = d.y / sum;
    if (d.z < 0.0) {
        double folded = copysign(1.0 - fabs(v), u);
        v = copysign(1.0 - fabs(u), v), u = folded;
    }
    int x = (int)((0.5 * u + 0.5) * side), y = (int)((0.5 * v + 0.5) * side);
    return (size_t)(y < side ? y : side - 1) * (size_t)side + (size_t)(x < side ? x : side - 1);
}

static void fold(float (*latlong)[2], float (*to)[2])
{
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            double column, row;
            place_of(surround_direction(x + 0.5, y + 0.5, SIDE), &column, &row);
            memcpy(to[y * SIDE + x], latlong[(row < H ? (int)row : H - 1) * W + wrapped((int)column)], sizeof *to);
        }
}

// ---- the albedo of what is seen

// Points that lie farther from the map's surface than this share of its distance are seen by another eye only.
static const double ON_MAP = 0.1;

// The mean of the points in each coarse texel; the fourth number is their count, until it is made 1 or 0.
static void add_albedo(const surround_map *m, mat3 map_from_world, const world_view *v)
{
    for (size_t i = 0; v->albedo && i < v->point_count; i++) {
        vec3 p = m3_apply(map_from_world, v3_sub(vector_at(v->points, i), m->eye));
        double far = v3_length(p);
        if (!(far > 0.0)) continue;
        const float *seen = m->shell[surround_texel(p, SIDE)];
        double there = (double)(seen[0] > 0.0f ? seen[0] : seen[1]);
        if (!(fabs(far - there) < ON_MAP * there)) continue;
        float *to = m->albedo[surround_texel(p, COARSE)];
        for (int k = 0; k < 3; k++) to[k] += v->albedo[3 * i + (size_t)k];
        to[3] += 1.0f;
    }
}

static void average(float (*albedo)[4])
{
    for (int i = 0; i < COARSE * COARSE; i++)
        for (int k = 3; k >= 0; k--) albedo[i][k] /= fmaxf(albedo[i][3], 1.0f);
    for (int i = 0; i < COARSE * COARSE; i++) albedo[i][3] = albedo[i][3] > 0.0f ? 1.0f : 0.0f;
}

// ---- all maps

// Eyes nearer to each other than this share of the mean distance of what they see are one.
static const double ONE_EYE = 1e-3;

static double mean_distance(const world_view *v)
{
    double sum = 0.0;
    for (size_t i = 0; i < v->point_count; i++) sum += v3_length(v3_sub(vector_at(v->points, i), v->eye));
    return v->point_count > 0 ? sum / (double)v->point_count : 0.0;
}

static bool is_of(const surround_map *m, const world_view *v)
{
    return v3_length(v3_sub(v->eye, m->eye)) <= ONE_EYE * fmin(m->extent, mean_distance(v));
}

typedef struct surround_job {
    const world_view *views;
    int count;
    mat3 map_from_world;
    surround_map *maps;
    const int *map_of; // of each view
    error *e;          // one for each map
} surround_job;

static bool make_map(void *context, size_t i, int worker)
{
    (void)worker;
    const surround_job *j = context;
    surround_map *m = &j->maps[i];
    float *shell = mem_zero((size_t)2 * W * H, sizeof *shell, &j->e[i]);
    float(*latlong)[2] = shell ? mem_pixels((size_t)W * H, sizeof *latlong, &j->e[i]) : NULL;
    for (int k = 0; latlong && k < j->count; k++)
        if (j->map_of[k] == (int)i) add_points(shell, j->map_from_world, m->eye, &j->views[k]);
    for (int k = 0; latlong && k < j->count; k++)
        if (j->map_of[k] == (int)i) add_empty(shell, j->map_from_world, &j->views[k]);
    if (latlong) fill(shell, shell + W * H);
    bool ok = latlong && find_openings(shell, latlong, &j->e[i]);
    if (ok) fold(latlong, m->shell);
    for (int k = 0; ok && k < j->count; k++)
        if (j->map_of[k] == (int)i) add_albedo(m, j->map_from_world, &j->views[k]);
    if (ok) average(m->albedo);
    for (int k = 0; ok && k < SIDE * SIDE; k++) m->known += m->shell[k][0] != 0.0f;
    m->known /= SIDE * SIDE;
    free(latlong);
    free(shell);
    return ok;
}

int surround_maps(const world_view *views, int count, int map_of[MAX_FURTHER], surround_map maps[MAX_FURTHER])
{
    int n = 0;
    for (int i = 0; i < count; i++) {
        int k = 0;
        while (k < n && !is_of(&maps[k], &views[i])) k++;
        map_of[i] = k;
        if (k == n) maps[n++] = (surround_map){.eye = views[i].eye, .extent = mean_distance(&views[i])};
    }
    return n;
}

bool surround_make(const world_view *views, int count, mat3 map_from_world, int threads, const int map_of[MAX_FURTHER],
                   surround_map maps[MAX_FURTHER], int map_count, error *e)
{
    surround_job j = {views, count, map_from_world, maps, map_of, mem_zero((size_t)map_count, sizeof *j.e, e)};
    bool ok = j.e && threads_for(threads, (size_t)map_count, make_map, &j);
    for (int i = 0; j.e && i < map_count && !ok; i++)
        if (j.e[i].code != ERR_NONE) *e = j.e[i];
    free(j.e);
    return ok;
}
