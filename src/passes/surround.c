#include "passes/surround.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/threads.h"
#include "passes/openings.h"

enum { W = SURROUND_WIDTH, H = SURROUND_HEIGHT, MOST_SPLAT = 4, FILL_ROUNDS = 3, FILL_LEAST = 4 };

// While the map is made: 0 unknown, EMPTY known to be empty, else a distance.
static const float EMPTY = INFINITY;

typedef struct maker {
    float *shell;
    mat3 map_from_camera;
    mat3 camera_from_world;
} maker;

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

static vec3 direction_of(const maker *m, vec3 world)
{
    return m3_apply(m->map_from_camera, m3_apply(m->camera_from_world, world));
}

static void add_view(const maker *m, const world_view *v)
{
    for (size_t i = 0; i < v->point_count; i++) {
        vec3 p = direction_of(m, v3_sub(vector_at(v->points, i), v->eye));
        double far = v3_length(p);
        if (far > 0.0) mark(m->shell, v3_scale(p, 1.0 / far), v->pixel, (float)far);
    }
}

static void add_empty(const maker *m, const world_view *v)
{
    for (size_t i = 0; i < v->empty_count; i++) mark(m->shell, direction_of(m, vector_at(v->empty, i)), v->pixel, EMPTY);
}

// The frame's own: its surfaces and its background.
static void add_frame(const maker *m, const gbuffer *gb)
{
    double pixel = 1.0 / gb->camera.fx;
    for (int y = 0; y < gb->height; y++)
        for (int x = 0; x < gb->width; x++) {
            vec3 p = gbuffer_position(gb, x, y);
            vec3 ray = v3((x + 0.5 - gb->camera.cx) / gb->camera.fx, (y + 0.5 - gb->camera.cy) / gb->camera.fy, 1.0);
            double far = v3_length(p);
            if (p.z == 0.0 && !shows_nothing(gbuffer_pixel_empty, gb, x, y)) continue;
            vec3 d = p.z > 0.0 ? v3_scale(p, 1.0 / far) : v3_scale(ray, 1.0 / v3_length(ray));
            mark(m->shell, m3_apply(m->map_from_camera, d), pixel, p.z > 0.0 ? (float)far : EMPTY);
        }
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

// Eyes nearer to each other than this share of the frame's extent are one.
static const double ONE_EYE = 1e-3;

typedef struct surround_job {
    const world_view *views;
    int count;
    const gbuffer *gb;
    mat3 map_from_camera;
    float (*out)[2];
    error *e; // one for each view
} surround_job;

static bool make_map(void *context, size_t i, int worker)
{
    (void)worker;
    const surround_job *j = context;
    const world_view *v = &j->views[i];
    float *shell = mem_zero((size_t)2 * W * H, sizeof *shell, &j->e[i]), (*out)[2] = j->out + i * W * H;
    if (!shell) return false;
    const maker m = {shell, j->map_from_camera, m3_transpose(j->gb->camera.world_from_camera)};
    vec3 eye = m3_apply(m.camera_from_world, v3_sub(v->eye, j->gb->camera.origin));
    float(*row)[2] = j->out + (size_t)j->count * W * H;
    row[2 * i][0] = (float)eye.x, row[2 * i][1] = (float)eye.y, row[2 * i + 1][0] = (float)eye.z;
    add_view(&m, v);
    if (v3_length(eye) <= ONE_EYE * j->gb->extent) add_frame(&m, j->gb);
    add_empty(&m, v);
    fill(shell, shell + W * H);
    bool ok = find_openings(shell, out, &j->e[i]);
    free(shell);
    return ok;
}

bool surround_make(const world_view *views, int count, const gbuffer *gb, mat3 map_from_camera, int threads, float (*out)[2],
                   error *e)
{
    surround_job j = {views, count, gb, map_from_camera, out, mem_zero((size_t)count, sizeof *j.e, e)};
    bool ok = j.e && threads_for(threads, (size_t)count, make_map, &j);
    for (int i = 0; j.e && i < count && !ok; i++)
        if (j.e[i].code != ERR_NONE) *e = j.e[i];
    free(j.e);
    return ok;
}
