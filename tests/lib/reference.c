#include "reference.h"

#include <stdlib.h>

#include "base/mem.h"

// Direction of the view ray through (x, y): per unit of depth for a perspective camera, a point at z = 0 for an orthographic one.
static vec3 screen_point(const camera *c, double x, double y)
{
    return v3((x - c->cx) / c->fx, (y - c->cy) / c->fy, c->kind == CAMERA_PERSPECTIVE ? 1.0 : 0.0);
}

static vec3 at_depth(const camera *c, double x, double y, double z)
{
    vec3 s = screen_point(c, x, y);
    return c->kind == CAMERA_PERSPECTIVE ? v3_scale(s, z) : v3(s.x, s.y, z);
}

const surfel *layer_at(const layer *l, int x, int y)
{
    if (x < 0 || y < 0 || x >= l->width || y >= l->height) return NULL;
    const surfel *s = &l->surfels[(size_t)y * (size_t)l->width + (size_t)x];
    return s->slack >= 0.0 ? s : NULL;
}

bool layer_project(const layer *l, vec3 p, double *x, double *y)
{
    const camera *c = &l->camera;
    if (c->kind == CAMERA_PERSPECTIVE && p.z <= 0.0) return false;
    double scale = c->kind == CAMERA_PERSPECTIVE ? 1.0 / p.z : 1.0;
    *x = c->cx + c->fx * p.x * scale;
    *y = c->cy + c->fy * p.y * scale;
    return true;
}

vec3 layer_to_eye(const layer *l, vec3 p)
{
    return l->camera.kind == CAMERA_PERSPECTIVE ? v3_normalize(v3_scale(p, -1.0)) : v3(0, 0, -1);
}

vec3 layer_surface(const layer *l, const surfel *s, double x, double y)
{
    const camera *c = &l->camera;
    bool perspective = c->kind == CAMERA_PERSPECTIVE;
    vec3 ray = screen_point(c, x, y);
    double facing = perspective ? v3_dot(s->normal, ray) : s->normal.z;
    double z = s->position.z + s->slack; // where the plane turns away inside the pixel, it runs off to the back
    if (facing < 0.0) {
        z = perspective ? v3_dot(s->normal, s->position) / facing : v3_dot(s->normal, v3_sub(s->position, ray)) / facing;
        z = fmin(fmax(z, s->position.z - s->slack), s->position.z + s->slack);
    }
    return at_depth(c, x, y, z);
}

const surfel *layer_sample(const layer *l, double x, double y, vec3 *point)
{
    if (!(x >= 0.0 && y >= 0.0 && x < l->width && y < l->height)) return NULL;
    const surfel *s = layer_at(l, (int)x, (int)y);
    if (s) *point = layer_surface(l, s, x, y);
    return s;
}

// The smaller depth step to the two neighbours along an axis: across a silhouette the other one is not this surface. Without
// neighbours, a footprint.
static double axis_step(const layer *l, const surfel *s, const surfel *a, const surfel *b)
{
    double da = a ? fabs(a->position.z - s->position.z) : INFINITY, db = b ? fabs(b->position.z - s->position.z) : INFINITY;
    double step = fmin(da, db);
    double footprint = (l->camera.kind == CAMERA_PERSPECTIVE ? s->position.z : 1.0) / fmin(l->camera.fx, l->camera.fy);
    return isfinite(step) ? step : footprint;
}

// A whole pixel step on both axes is twice what a plane needs between its centre and its corner: room for perspective.
static void find_slack(layer *l, int x, int y)
{
    surfel *s = &l->surfels[(size_t)y * (size_t)l->width + (size_t)x];
    if (s->slack < 0.0) return;
    s->slack = axis_step(l, s, layer_at(l, x - 1, y), layer_at(l, x + 1, y)) +
               axis_step(l, s, layer_at(l, x, y - 1), layer_at(l, x, y + 1)) + 1e-6 * fabs(s->position.z);
}

bool layer_build(const gbuffer *g, layer *out, error *e)
{
    *out = (layer){.width = g->width, .height = g->height, .camera = g->camera, .albedo = g->albedo};
    size_t n = (size_t)g->width * (size_t)g->height;
    out->surfels = mem_zero(n, sizeof *out->surfels, e);
    if (!out->surfels) return false;
    for (size_t i = 0; i < n; i++) {
        double x = (double)(i % (size_t)g->width) + 0.5, y = (double)(i / (size_t)g->width) + 0.5;
        surfel *s = &out->surfels[i];
        s->slack = g->depth[i] > 0.0f ? 0.0 : -1.0;
        if (s->slack < 0.0) continue;
        s->position = at_depth(&g->camera, x, y, g->depth[i]);
        s->normal = v3_normalize(v3(g->normal[4 * i], g->normal[4 * i + 1], g->normal[4 * i + 2]));
    }
    for (int y = 0; y < g->height; y++)
        for (int x = 0; x < g->width; x++) find_slack(out, x, y);
    return true;
}

void layer_free(layer *l)
{
    free(l->surfels);
    *l = (layer){0};
}

static unsigned hash(unsigned a)
{
    a = (a ^ 61u) ^ (a >> 16);
    a *= 9u;
    a = (a ^ (a >> 4)) * 0x27d4eb2du;
    return a ^ (a >> 15);
}

// The first valid pixel of the cell [x0, x1) x [y0, y1), counted from a hashed start.
static bool pick(const layer *l, int x0, int y0, int x1, int y1, unsigned cell, pixel *out)
{
    int w = x1 - x0, count = w * (y1 - y0);
    for (int i = 0; i < count; i++) {
        int k = (int)((hash(cell) + (unsigned)i) % (unsigned)count);
        *out = (pixel){x0 + k % w, y0 + k / w};
        if (layer_at(l, out->x, out->y)) return true;
    }
    return false;
}

int reference_pixels(const layer *l, int max, pixel *out)
{
    int columns = (int)sqrt((double)max * l->width / l->height);
    columns = columns < 1 ? 1 : columns > l->width ? l->width : columns;
    int rows = max / columns;
    rows = rows < 1 ? 1 : rows > l->height ? l->height : rows;
    if (columns > max) columns = max;
    int found = 0;
    for (int r = 0; r < rows; r++) {
        for (int c = 0; c < columns; c++) {
            int x0 = (int)((long)c * l->width / columns), x1 = (int)((long)(c + 1) * l->width / columns);
            int y0 = (int)((long)r * l->height / rows), y1 = (int)((long)(r + 1) * l->height / rows);
            if (pick(l, x0, y0, x1, y1, (unsigned)(r * columns + c), &out[found])) found++;
        }
    }
    return found;
}
