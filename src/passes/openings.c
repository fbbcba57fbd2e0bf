#include "passes/openings.h"

#include <math.h>
#include <stdlib.h>

#include "base/mem.h"

// A surface is part of a roof if its normal is within 60 degrees of straight down.
static const double FACES_DOWN = -0.5;
enum { ROOF_SAMPLES = 20000 }; // about so many pixels are looked at

// The nearest surface on one side of a pixel; depth 0: none. `at`: its row or column.
typedef struct side {
    float depth;
    int at;
} side;

static bool is_empty(const gbuffer *gb, int x, int y)
{
    if (x < 0 || y < 0 || x >= gb->width || y >= gb->height) return true;
    size_t i = (size_t)y * (size_t)gb->width + (size_t)x;
    return gb->depth[i] == 0.0f && (!gb->coverage || gb->coverage[i] == 0.0f);
}

static bool all_empty_around(const gbuffer *gb, int x, int y)
{
    bool empty = true;
    for (int k = 0; k < 9; k++) empty = empty && is_empty(gb, x + k % 3 - 1, y + k / 3 - 1);
    return empty;
}

// Part of an opening of at least 3 x 3 pixels. What is narrower may be a crack between two surfaces.
static bool shows_nothing(const gbuffer *gb, int x, int y)
{
    bool shows = false;
    for (int k = 0; k < 9; k++) shows = shows || all_empty_around(gb, x + k % 3 - 1, y + k / 3 - 1);
    return shows && is_empty(gb, x, y);
}

static double between(const gbuffer *gb, side a, side b, int at)
{
    if (a.depth == 0.0f || b.depth == 0.0f) return (double)fmaxf(a.depth, b.depth);
    double t = (double)(at - a.at) / (double)(b.at - a.at), p = (double)a.depth, q = (double)b.depth;
    return gb->camera.kind == CAMERA_ORTHOGRAPHIC ? p + t * (q - p) : 1.0 / ((1.0 - t) / p + t / q);
}

static void look(const gbuffer *gb, int x, int y, int at, side *last)
{
    float depth = gb->depth[(size_t)y * (size_t)gb->width + (size_t)x];
    if (depth > 0.0f) *last = (side){depth, at};
}

bool openings_find(const gbuffer *gb, float *rim, error *e)
{
    size_t width = (size_t)gb->width, most = width > (size_t)gb->height ? width : (size_t)gb->height;
    side *before = mem_zero(most + width, sizeof *before, e), *below = before ? before + most : NULL;
    float *down = before ? mem_pixels(width * (size_t)gb->height, sizeof *down, e) : NULL;
    int *down_at = down ? mem_pixels(width * (size_t)gb->height, sizeof *down_at, e) : NULL;
    float farthest = 0.0f;
    if (!down_at) goto out;
    // Downwards: what is above each pixel.
    for (int y = 0; y < gb->height; y++)
        for (int x = 0; x < gb->width; x++) {
            size_t i = (size_t)y * width + (size_t)x;
            look(gb, x, y, y, &below[x]);
            down[i] = below[x].depth, down_at[i] = below[x].at;
            farthest = fmaxf(farthest, gb->depth[i]);
        }
    for (size_t x = 0; x < width; x++) below[x] = (side){0};
    // Upwards, with what is below; and in each row what is to the left and to the right.
    for (int y = gb->height - 1; y >= 0; y--) {
        side left = {0}, right = {0};
        for (int x = 0; x < gb->width; x++) look(gb, x, y, x, &left), before[x] = left;
        for (int x = gb->width - 1; x >= 0; x--) {
            size_t i = (size_t)y * width + (size_t)x;
            look(gb, x, y, x, &right);
            look(gb, x, y, y, &below[x]);
            rim[i] = 0.0f;
            if (!shows_nothing(gb, x, y)) continue;
            double depth = fmax(between(gb, before[x], right, x), between(gb, (side){down[i], down_at[i]}, below[x], y));
            rim[i] = depth > 0.0 ? (float)depth : farthest;
        }
    }
out:
    free(down_at);
    free(down);
    free(before);
    return e->code == ERR_NONE;
}

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
        if (is_empty(gb, (int)at_x, (int)at_y)) return true;
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
