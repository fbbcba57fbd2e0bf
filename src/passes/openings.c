#include "passes/openings.h"

#include <math.h>
#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/world_view.h"

// A surface is part of a roof if its normal is within 60 degrees of straight down.
static const double FACES_DOWN = -0.5;
enum { ROOF_SAMPLES = 20000 }; // about so many pixels are looked at

// ---- the outdoors

static const float BEYOND = 1.5f; // a surface is outdoors if it lies this many times as far as the rim,
// and its inverse depth changes by no more than this share of the rim's from one cell to the next. On the screen the inverse
// depth of a plane is linear.
static const float ALONG = 0.1f;
static const float ALIKE = 2.0f; // two sides of one opening differ by no more than this factor

typedef struct grid {
    const float *depth;
    int width, height;
    bool wraps;
    float *rim;
} grid;

static bool is_surface(float depth) { return depth > 0.0f && depth < INFINITY; }

// The cell beside (x, y), or -1.
static long beside(const grid *g, int x, int y, int k)
{
    static const int dx[] = {-1, 1, 0, 0}, dy[] = {0, 0, -1, 1};
    x += dx[k], y += dy[k];
    if (g->wraps) x = (x + g->width) % g->width;
    return x < 0 || y < 0 || x >= g->width || y >= g->height ? -1 : (long)y * g->width + x;
}

// The nearest surface on one side of a cell; depth 0: none.
typedef struct side {
    float depth;
    int steps;
} side;

// The rim between two opposite sides. The inverse depth of a plane is linear on the screen. Where one side is much farther it is
// not of the same opening, but ground that is seen through it.
static float between(side a, side b)
{
    if (a.depth == 0.0f || b.depth == 0.0f) return fmaxf(a.depth, b.depth);
    float near = fminf(a.depth, b.depth), far = fmaxf(a.depth, b.depth), t = (float)a.steps / (float)(a.steps + b.steps);
    return far > ALIKE * near ? near : 1.0f / ((1.0f - t) / a.depth + t / b.depth);
}

// Along a row or a column, both ways.
static void sweep(const grid *g, long start, long step, int count, side *ahead, side *behind)
{
    int turns = g->wraps && step == 1 ? 2 : 1; // what the border hides is found in the second turn
    for (int way = 0; way < 2; way++) {
        side last = {0};
        for (int i = 0; i < turns * count; i++) {
            long at = start + step * (way ? count - 1 - i % count : i % count);
            last.steps++;
            if (is_surface(g->depth[at])) last = (side){g->depth[at], 0};
            (way ? behind : ahead)[at] = last;
        }
    }
}

static void rims_of_empty(const grid *g, side *const sides[4])
{
    float farthest = 1.0f;
    long cells = (long)g->width * g->height;
    for (int y = 0; y < g->height; y++) sweep(g, (long)y * g->width, 1, g->width, sides[0], sides[1]);
    for (int x = 0; x < g->width; x++) sweep(g, x, g->width, g->height, sides[2], sides[3]);
    for (long i = 0; i < cells; i++) farthest = is_surface(g->depth[i]) ? fmaxf(farthest, g->depth[i]) : farthest;
    for (long i = 0; i < cells; i++) {
        float rim = fmaxf(between(sides[0][i], sides[1][i]), between(sides[2][i], sides[3][i]));
        g->rim[i] = g->depth[i] != INFINITY ? 0.0f : rim > 0.0f ? rim : farthest;
    }
}

// Takes a surface cell with a rim, if it is outdoors and not taken yet.
static void take(const grid *g, long cell, float rim, float from, long *queue, long *count)
{
    float depth = g->depth[cell];
    if (!is_surface(depth) || g->rim[cell] > 0.0f || depth <= BEYOND * rim) return;
    if (from > 0.0f && fabsf(1.0f / depth - 1.0f / from) > ALONG / rim) return;
    g->rim[cell] = rim;
    queue[(*count)++] = cell;
}

// The cell beside (x, y), past pixels of which nothing is known, such as those that a horizon crosses: two at most.
static long known_beside(const grid *g, long cell, int k)
{
    for (int i = 0; i < 3 && cell >= 0; i++) {
        cell = beside(g, (int)(cell % g->width), (int)(cell / g->width), k);
        if (cell >= 0 && g->depth[cell] != 0.0f) return cell;
    }
    return -1;
}

static void spread(const grid *g, long *queue)
{
    long count = 0, cells = (long)g->width * g->height;
    for (long i = 0; i < cells; i++)
        for (int k = 0; k < 4 && g->depth[i] == INFINITY; k++) {
            long other = known_beside(g, i, k);
            if (other >= 0) take(g, other, g->rim[i], 0.0f, queue, &count);
        }
    for (long i = 0; i < count; i++)
        for (int k = 0; k < 4; k++) {
            long other = beside(g, (int)(queue[i] % g->width), (int)(queue[i] / g->width), k);
            if (other >= 0) take(g, other, g->rim[queue[i]], g->depth[queue[i]], queue, &count);
        }
}

bool outdoors_find(const float *depth, int width, int height, bool wraps, float *rim, error *e)
{
    size_t cells = (size_t)width * (size_t)height;
    const grid g = {depth, width, height, wraps, rim};
    side *sides = mem_pixels(4 * cells, sizeof *sides, e);
    long *queue = sides ? mem_pixels(cells, sizeof *queue, e) : NULL;
    if (queue) {
        side *const all[4] = {sides, sides + cells, sides + 2 * cells, sides + 3 * cells};
        rims_of_empty(&g, all);
        spread(&g, queue);
        // Once more, now that ground which is seen through an opening is known and no longer taken for its rim.
        float *indoors = (float *)queue;
        for (size_t i = 0; i < cells; i++) indoors[i] = rim[i] > 0.0f ? INFINITY : depth[i];
        rims_of_empty(&(grid){indoors, width, height, wraps, rim}, all);
    }
    free(queue);
    free(sides);
    return queue != NULL;
}

bool openings_find(const gbuffer *gb, float *rim, error *e)
{
    float *depth = mem_pixels((size_t)gb->width * (size_t)gb->height, sizeof *depth, e), *to = depth;
    if (!depth) return false;
    for (int y = 0; y < gb->height; y++)
        for (int x = 0; x < gb->width; x++) {
            float z = gb->depth[(size_t)y * (size_t)gb->width + (size_t)x];
            *to++ = z > 0.0f ? z : shows_nothing(gbuffer_pixel_empty, gb, x, y) ? INFINITY : 0.0f;
        }
    bool ok = outdoors_find(depth, gb->width, gb->height, false, rim, e);
    free(depth);
    return ok;
}

// ---- the roof

// Screen position of a direction in front of the eye.
static void project(const camera *c, vec3 d, double *x, double *y)
{
    *x = c->fx * d.x / d.z + c->cx;
    *y = c->fy * d.y / d.z + c->cy;
}

// Whether the picture shows the background between a point and the place straight above the eye. The way there is a great circle,
// so a straight line on the screen.
static bool ends_under_sky(const gbuffer *gb, vec3 point, vec3 up)
{
    double x, y, to_x, to_y;
    vec3 from = v3_scale(point, 1.0 / v3_length(point));
    project(&gb->camera, from, &x, &y);
    project(&gb->camera, v3_add(from, v3_scale(up, 0.01)), &to_x, &to_y);
    double dx = to_x - x, dy = to_y - y, size = fmax(fabs(dx), fabs(dy));
    double reach = gb->width + gb->height;
    if (!(size > 1e-9)) return false;
    if (up.z > 1e-6) { // straight above lies in front of the eye
        double top_x, top_y;
        project(&gb->camera, up, &top_x, &top_y);
        reach = fmax(fabs(top_x - x), fabs(top_y - y));
    }
    for (int i = 1; i < reach; i++) {
        double at_x = x + i * dx / size, at_y = y + i * dy / size;
        if (!(at_x >= 0.0 && at_y >= 0.0 && at_x < gb->width && at_y < gb->height)) return false;
        if (gbuffer_pixel_empty(gb, (int)at_x, (int)at_y)) return true;
    }
    return false;
}

static bool is_roof(const gbuffer *gb, int x, int y, vec3 up)
{
    size_t i = (size_t)y * (size_t)gb->width + (size_t)x;
    const float *n = gb->normal + 4 * i;
    if (gb->depth[i] == 0.0f || v3_dot(v3((double)n[0], (double)n[1], (double)n[2]), up) > FACES_DOWN) return false;
    vec3 point = gbuffer_position(gb, x, y);
    return v3_dot(point, up) > 0.0 && !ends_under_sky(gb, point, up);
}

double openings_roof(const gbuffer *gb, vec3 up)
{
    int step = (int)sqrt((double)gb->width * (double)gb->height / ROOF_SAMPLES) + 1;
    double roof = 0.0, all = 0.0;
    if (gb->camera.kind == CAMERA_ORTHOGRAPHIC) return 0.0;
    for (int y = step / 2; y < gb->height; y += step)
        for (int x = step / 2; x < gb->width; x += step) roof += is_roof(gb, x, y, up), all += 1.0;
    return all > 0.0 ? roof / all : 0.0;
}
