#include "gbuffer/evidence.h"

#include <string.h>

enum { FACES = 6, CELLS = 3, BINS = FACES * CELLS * CELLS, LEAST = 30, LARGEST_STEP = 12 };
static const double same_plane = 0.95; // cosine between the planes of the neighbours on either side
static const double edge_on = 0.05;
static const double steepest_error = 0.03; // of a slope, by rounding

int evidence_step(const build *b, double rounding, double z)
{
    const camera *c = &b->g->camera;
    double pixel = (c->kind == CAMERA_PERSPECTIVE ? z : 1.0) / fmin(c->fx, c->fy);
    double step = ceil(rounding / (2.0 * steepest_error * pixel));
    return step >= 1.0 ? (step <= LARGEST_STEP ? (int)step : LARGEST_STEP) : 1;
}

static vec3 plane_of(vec3 here, vec3 across, vec3 down, vec3 ray)
{
    vec3 n = v3_normalize(v3_cross(v3_sub(across, here), v3_sub(down, here)));
    return v3_dot(n, ray) > 0.0 ? v3_scale(n, -1.0) : n;
}

// The normal at a smooth pixel.
static bool smooth_normal(const build *b, evidence_point point, const void *context, int step, int x, int y, vec3 *n)
{
    vec3 here, right, left, down, up, ray = build_ray(&b->g->camera, x, y);
    if (x < step || y < step || x + step >= b->g->width || y + step >= b->g->height) return false;
    if (!point(b, context, x, y, &here) || !point(b, context, x + step, y, &right) || !point(b, context, x - step, y, &left) ||
        !point(b, context, x, y + step, &down) || !point(b, context, x, y - step, &up))
        return false;
    vec3 ahead = plane_of(here, right, down, ray), behind = plane_of(here, left, up, ray);
    if (!(v3_dot(ahead, behind) > same_plane)) return false;
    *n = v3_normalize(v3_cross(v3_sub(right, left), v3_sub(down, up)));
    if (v3_dot(*n, ray) > 0.0) *n = v3_scale(*n, -1.0);
    return -v3_dot(*n, ray) > edge_on * v3_length(ray);
}

// A direction's cell among those of a cube whose faces are divided 3 by 3.
static int bin_of(vec3 n)
{
    double a[3] = {n.x, n.y, n.z};
    int axis = fabs(n.x) > fabs(n.y) ? 0 : 1;
    if (fabs(n.z) > fabs(a[axis])) axis = 2;
    int bin = axis * 2 + (a[axis] < 0.0);
    for (int k = 1; k < 3; k++) {
        int cell = (int)(CELLS * 0.5 * (1.0 + a[(axis + k) % 3] / fabs(a[axis])));
        bin = bin * CELLS + (cell < 0 ? 0 : cell >= CELLS ? CELLS - 1 : cell);
    }
    return bin;
}

static void weigh(evidence *v)
{
    size_t in_bin[BINS] = {0};
    double sum = 0.0;
    vec3 mean = {0};
    for (size_t i = 0; i < v->count; i++) in_bin[bin_of(v->surface[i])]++;
    for (size_t i = 0; i < v->count; i++) sum += v->weight[i] = 1.0 / sqrt((double)in_bin[bin_of(v->surface[i])]);
    for (size_t i = 0; i < v->count; i++) {
        v->weight[i] /= sum;
        mean = v3_add(mean, v3_scale(v->surface[i], v->weight[i]));
    }
    v->spread = v->count ? 1.0 - v3_dot(mean, mean) : 0.0;
}

static void add(const build *b, evidence *v, int x, int y, vec3 n)
{
    v->stored[v->count] =
        v3(plane_get(&b->normal.n[0], x, y), plane_get(&b->normal.n[1], x, y), plane_get(&b->normal.n[2], x, y));
    v->surface[v->count++] = n;
}

void evidence_gather(const build *b, evidence_point point, const void *context, int step, size_t most, evidence *v)
{
    size_t stride = b->sample.count / most + 1;
    v->count = 0;
    // In a picture of a few pixels or of leaves alone nothing may be smooth at the wanted step.
    for (; step >= 1 && LEAST > v->count; step = step > 1 ? 1 : 0) {
        v->count = 0;
        for (size_t i = 0; i < b->sample.count && v->count < most; i += stride) {
            int x = (int)b->sample.points[i].x, y = (int)b->sample.points[i].y;
            vec3 n;
            if (smooth_normal(b, point, context, step, x, y, &n)) add(b, v, x, y, n);
        }
    }
    weigh(v);
}
