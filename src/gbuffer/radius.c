#include "gbuffer/radius.h"

#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/solve.h"

enum { SAMPLES = 40000 };
// Share of the extent. The five samples' own occlusion distances lie at 0.26 to 0.41 of it; a third is in the middle.
static const double radius_share = 0.33;
static const double farthest = 4.0; // in median depths

// Pixels on a regular grid, coarse enough for about SAMPLES of them.
static int grid_step(const gbuffer *g)
{
    double pixels = (double)g->width * (double)g->height;
    int step = (int)sqrt(pixels / SAMPLES);
    return step > 1 ? step : 1;
}

static size_t gather(const gbuffer *g, vec3 *points)
{
    size_t n = 0;
    int step = grid_step(g);
    for (int y = step / 2; y < g->height; y += step)
        for (int x = step / 2; x < g->width; x += step) {
            vec3 p = gbuffer_position(g, x, y);
            if (p.z > 0.0) points[n++] = p;
        }
    return n;
}

static double component(vec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

static double median_component(const vec3 *points, size_t n, int axis, double *scratch)
{
    for (size_t i = 0; i < n; i++) scratch[i] = component(points[i], axis);
    return solve_median(scratch, n);
}

bool gbuffer_extent(const gbuffer *g, double *extent, error *e)
{
    int step = grid_step(g);
    size_t most = ((size_t)g->width / (size_t)step + 1) * ((size_t)g->height / (size_t)step + 1);
    vec3 *points = mem_pixels(most, sizeof *points, e);
    double *scratch = mem_pixels(most, sizeof *scratch, e);
    bool done = false;
    *extent = 0.0;
    if (!points || !scratch) goto out;
    done = true;
    size_t n = gather(g, points);
    if (n == 0) goto out;
    double limit = farthest * median_component(points, n, 2, scratch);
    for (size_t i = 0; i < n && g->camera.kind == CAMERA_PERSPECTIVE; i++)
        if (points[i].z > limit) points[i] = v3_scale(points[i], limit / points[i].z);
    vec3 middle;
    middle.x = median_component(points, n, 0, scratch);
    middle.y = median_component(points, n, 1, scratch);
    middle.z = median_component(points, n, 2, scratch);
    for (size_t i = 0; i < n; i++) scratch[i] = v3_length(v3_sub(points[i], middle));
    *extent = solve_median(scratch, n);
out:
    free(points);
    free(scratch);
    return done;
}

double gbuffer_auto_radius(const gbuffer *g) { return radius_share * g->extent; }
