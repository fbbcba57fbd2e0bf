// Pixels whose one ray went through a crack of a mesh: a single one, far behind the plane that all eight around it form.
#include <math.h>
#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/build.h"

static const double ONE_PLANE = 0.95;                      // least cosine between their normals and the mean
static const double FAR_BEHIND = 1.05, STEPS_BEHIND = 4.0; // times their depth; times the steps between them
// More pixels than this share are no accident but a pattern, such as a grille.
static const double MOST_CRACKS = 1e-3;

// What is linear on the screen along a plane: 1 / z under a perspective camera, else -z. The nearer the larger.
static double nearness(const gbuffer *g, double z) { return g->camera.kind == CAMERA_ORTHOGRAPHIC ? -z : 1.0 / z; }

static double depth_of(const gbuffer *g, double near) { return g->camera.kind == CAMERA_ORTHOGRAPHIC ? -near : 1.0 / near; }

static vec3 normal_at(const gbuffer *g, size_t i)
{
    const float *n = g->normal + 4 * i;
    return v3((double)n[0], (double)n[1], (double)n[2]);
}

// The eight around a pixel inside the frame, if they form one plane: depth and normal of that at the pixel.
static bool plane_around(const gbuffer *g, int x, int y, double *depth, vec3 *normal, double *largest_step)
{
    double near[BUILD_AROUND], mean = 0.0;
    vec3 n[BUILD_AROUND], sum = v3(0, 0, 0);
    for (int k = 0; k < BUILD_AROUND; k++) {
        size_t i = (size_t)(y + build_around[k][1]) * (size_t)g->width + (size_t)(x + build_around[k][0]);
        if (!(g->depth[i] > 0.0f)) return false;
        near[k] = nearness(g, (double)g->depth[i]), n[k] = normal_at(g, i);
        mean += near[k] / BUILD_AROUND, sum = v3_add(sum, n[k]);
    }
    double pixel = (g->camera.kind == CAMERA_ORTHOGRAPHIC ? 1.0 : fabs(mean)) / fmin(g->camera.fx, g->camera.fy);
    *largest_step = pixel;
    for (int k = 0; k < BUILD_AROUND; k++) {
        if (v3_dot(n[k], sum) < ONE_PLANE * v3_length(sum)) return false;
        if (fabs(0.5 * (near[k] + near[BUILD_AROUND - 1 - k]) - mean) > pixel) return false;
        *largest_step = fmax(*largest_step, fabs(near[k] - mean));
    }
    *depth = depth_of(g, mean), *normal = v3_scale(sum, 1.0 / v3_length(sum));
    return true;
}

static bool is_crack(const gbuffer *g, int x, int y, double *depth, vec3 *normal)
{
    const float *at = g->depth + (size_t)y * (size_t)g->width + (size_t)x;
    double largest_step;
    if (!(at[0] > at[-1] && at[0] > at[1] && at[-1] > 0.0f && at[1] > 0.0f)) return false; // most pixels end here
    if (!plane_around(g, x, y, depth, normal, &largest_step)) return false;
    double behind = nearness(g, *depth) - nearness(g, (double)at[0]);
    return (double)at[0] > FAR_BEHIND * *depth && behind > STEPS_BEHIND * largest_step;
}

bool cracks_mend(build *b)
{
    gbuffer *g = b->g;
    size_t most = (size_t)(MOST_CRACKS * (double)g->width * (double)g->height) + 1, count = 0;
    size_t *found = mem_pixels(most, sizeof *found, b->e);
    double depth;
    vec3 n;
    for (int y = 1; found && y < g->height - 1; y++)
        for (int x = 1; x < g->width - 1; x++)
            if (is_crack(g, x, y, &depth, &n) && count++ < most) found[count - 1] = (size_t)y * (size_t)g->width + (size_t)x;
    for (size_t k = 0; k < count && count <= most; k++) {
        size_t i = found[k];
        if (!is_crack(g, (int)(i % (size_t)g->width), (int)(i / (size_t)g->width), &depth, &n)) continue;
        g->depth[i] = (float)depth;
        g->normal[4 * i] = (float)n.x, g->normal[4 * i + 1] = (float)n.y, g->normal[4 * i + 2] = (float)n.z;
    }
    if (count > 0)
        build_note(b,
                   count <= most
                       ? "single pixels far behind the plane around them, as through a crack of a mesh, and put on it: %zu"
                       : "single pixels far behind the plane around them, so many that they are a pattern, and left: %zu",
                   count);
    free(found);
    return found != NULL;
}
