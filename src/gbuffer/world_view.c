#include "gbuffer/world_view.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "gbuffer/build.h"
#include "gbuffer/solve.h"

// ---- lat-long cameras

// Pixels: a renderer samples positions anywhere within theirs.
static const double MOST_ERROR = 0.75;
enum { FIT_POINTS = 2048, FIT_LEAST = 50 };

static vec3 point_at(const float *positions, int width, size_t x, size_t y)
{
    const float *p = positions + 3 * (y * (size_t)width + x);
    return v3((double)p[0], (double)p[1], (double)p[2]);
}

static bool is_point(vec3 p) { return isfinite(p.x + p.y + p.z) && (p.x != 0.0 || p.y != 0.0 || p.z != 0.0); }

// Axes (a, b, up) that turn counter-clockwise: x y z with z up, z x y with y up.
static void split(vec3 p, int up, double to[3])
{
    to[0] = up == 2 ? p.x : p.z, to[1] = up == 2 ? p.y : p.x, to[2] = up == 2 ? p.z : p.y;
}

static vec3 joined(const double from[3], int up)
{
    return up == 2 ? v3(from[0], from[1], from[2]) : v3(from[1], from[2], from[0]);
}

vec3 latlong_direction(const latlong_camera *c, int width, int height, double x, double y)
{
    double phi = c->start + c->sense * 2.0 * M_PI * x / width, theta = M_PI * y / height;
    const double d[3] = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
    return joined(d, c->up);
}

typedef struct fit_point {
    double at[3], x, y; // place by the axes above, pixel
} fit_point;

// Of the pixels with a position evenly many.
static int take_points(const float *positions, int width, int height, int up, fit_point *points)
{
    int n = 0;
    size_t pixels = (size_t)width * (size_t)height, there = 0, seen = 0;
    for (size_t i = 0; i < pixels; i++) there += is_point(point_at(positions, width, i, 0));
    for (size_t i = 0; i < pixels && n < FIT_POINTS; i++) {
        vec3 p = point_at(positions, width, i, 0);
        if (!is_point(p) || seen++ % (there / FIT_POINTS + 1) != 0) continue;
        split(p, up, points[n].at);
        points[n].x = (double)(i % (size_t)width) + 0.5, points[n].y = (double)(i / (size_t)width) + 0.5;
        n++;
    }
    return n;
}

// For a start and a sense the direction of each pixel is known, and the eye is the point nearest to all lines through the points
// along their directions: sum (I - d d^T) (p - eye) = 0. Far points do not weigh more: their lines are as exact as near ones'.
static bool find_eye(const fit_point *points, int n, int width, int height, latlong_camera *c)
{
    double m[3][3] = {{0}}, b[3] = {0};
    for (int i = 0; i < n; i++) {
        vec3 direction = latlong_direction(c, width, height, points[i].x, points[i].y);
        double d[3], size = 0.0;
        split(direction, c->up, d);
        for (int k = 0; k < 3; k++) size += points[i].at[k] * points[i].at[k];
        double w = 1.0 / (1e-12 + size);
        for (int r = 0; r < 3; r++)
            for (int k = 0; k < 3; k++) {
                double q = w * ((r == k) - d[r] * d[k]);
                m[r][k] += q;
                b[r] += q * points[i].at[k];
            }
    }
    if (!solve_linear(3, m[0], b)) return false;
    c->eye = joined(b, c->up);
    return true;
}

// The median angle, in pixels of the picture's rows.
static double error_of(const fit_point *points, int n, int width, int height, const latlong_camera *c, double *scratch)
{
    for (int i = 0; i < n; i++) {
        vec3 d = v3_sub(joined(points[i].at, c->up), c->eye), w = latlong_direction(c, width, height, points[i].x, points[i].y);
        double size = v3_length(d);
        scratch[i] = size > 0.0 ? acos(fmin(1.0, fmax(-1.0, v3_dot(d, w) / size))) * height / M_PI : 1e9;
    }
    return solve_median(scratch, (size_t)n);
}

// The eye moves with the start, so the start is searched: coarsely, then by golden steps around the best.
static bool fit_turn(const fit_point *points, int n, int width, int height, latlong_camera *c, double *scratch)
{
    enum { COARSE = 72, STEPS = 40 };
    latlong_camera best = *c;
    best.error = INFINITY;
    for (int i = 0; i < COARSE; i++) {
        latlong_camera t = *c;
        t.start = 2.0 * M_PI * i / COARSE;
        if (!find_eye(points, n, width, height, &t)) continue;
        t.error = error_of(points, n, width, height, &t, scratch);
        if (t.error < best.error) best = t;
    }
    double step = 2.0 * M_PI / COARSE;
    for (int i = 0; i < STEPS && isfinite(best.error); i++) {
        bool moved = false;
        for (int k = -1; k <= 1; k += 2) {
            latlong_camera t = best;
            t.start += k * step;
            if (!find_eye(points, n, width, height, &t)) continue;
            t.error = error_of(points, n, width, height, &t, scratch);
            if (t.error < best.error) best = t, moved = true;
        }
        if (!moved) step *= 0.5;
    }
    *c = best;
    return isfinite(best.error);
}

bool latlong_fit(const float *positions, int width, int height, latlong_camera *out)
{
    error ignored = {0};
    out->error = INFINITY;
    if (width != 2 * height) return false;
    fit_point *points = mem_zero(FIT_POINTS, sizeof *points, &ignored);
    double *scratch = mem_zero(FIT_POINTS, sizeof *scratch, &ignored);
    for (int k = 0; points && scratch && k < 4; k++) {
        latlong_camera c = {.up = k / 2 ? 1 : 2, .sense = k % 2 ? 1 : -1};
        int n = take_points(positions, width, height, c.up, points);
        if (n >= FIT_LEAST && fit_turn(points, n, width, height, &c, scratch) && c.error < out->error) *out = c;
    }
    free(points);
    free(scratch);
    return out->error <= MOST_ERROR;
}

// ---- reading

static const double FARTHEST = 1e9;
static const double ON_RAY = 0.999; // cosine

static float *pass_of(const exrio_file *file, const resolution *r, role what, int *width, int *height, error *e)
{
    gbuffer frame = {.data_window = file->parts[r->main_part].data_window};
    const build b = {.file = file, .r = r, .g = &frame};
    plane p[3];
    *width = box2_width(frame.data_window), *height = box2_height(frame.data_window);
    for (int k = 0; k < 3; k++) p[k] = build_plane(&b, what, k);
    float *out = mem_pixels((size_t)*width * (size_t)*height, 3 * sizeof *out, e), *to = out;
    for (int y = 0; out && y < *height; y++)
        for (int x = 0; x < *width; x++)
            for (int k = 0; k < 3; k++) *to++ = (float)plane_get(&p[k], x, y);
    return out;
}

// ---- what shows nothing

bool shows_nothing(pixel_empty_fn is_empty, const void *picture, int x, int y)
{
    bool shows = false;
    for (int k = 0; k < 9; k++) {
        bool all = true;
        for (int i = 0; i < 9; i++) all = all && is_empty(picture, x + k % 3 + i % 3 - 2, y + k / 3 + i / 3 - 2);
        shows = shows || all;
    }
    return shows && is_empty(picture, x, y);
}

bool gbuffer_pixel_empty(const void *gb, int x, int y)
{
    const gbuffer *g = gb;
    if (x < 0 || y < 0 || x >= g->width || y >= g->height) return true;
    size_t i = (size_t)y * (size_t)g->width + (size_t)x;
    return g->depth[i] == 0.0f && (!g->coverage || g->coverage[i] == 0.0f);
}

typedef struct latlong_picture {
    const float *positions, *albedo; // albedo: NULL where there is none
    int width, height;
    const latlong_camera *camera;
} latlong_picture;

// Positions of the background are 0, far away or not finite.
static bool latlong_empty(const void *picture, int x, int y)
{
    const latlong_picture *l = picture;
    if (y < 0 || y >= l->height) return true;
    vec3 p = point_at(l->positions, l->width, (size_t)((x + l->width) % l->width), (size_t)y);
    return !is_point(p) || v3_length(v3_sub(p, l->camera->eye)) >= FARTHEST;
}

static bool make_room(world_view *v, size_t most, bool albedo, error *e)
{
    v->points = mem_pixels(most, 3 * sizeof *v->points, e);
    v->empty = v->points ? mem_pixels(most, 3 * sizeof *v->empty, e) : NULL;
    if (v->empty && albedo) v->albedo = mem_pixels(most, 3 * sizeof *v->albedo, e);
    return v->empty && (v->albedo || !albedo);
}

static void put(float *list, size_t *count, vec3 p)
{
    float *to = list + 3 * (*count)++;
    to[0] = (float)p.x, to[1] = (float)p.y, to[2] = (float)p.z;
}

static float as_albedo(float a) { return a > 0.0f ? fminf(a, 1.0f) : 0.0f; }

// albedo: of its pixel, NULL without.
static void put_point(world_view *v, vec3 p, const float *albedo)
{
    for (int k = 0; albedo && k < 3; k++) v->albedo[3 * v->point_count + (size_t)k] = as_albedo(albedo[k]);
    put(v->points, &v->point_count, p);
}

static int stride_of(int width, int height, size_t most)
{
    int stride = 1;
    while ((size_t)((width + stride - 1) / stride) * (size_t)((height + stride - 1) / stride) > most) stride++;
    return stride;
}

static void take_latlong(const latlong_picture *l, int stride, world_view *v)
{
    v->eye = l->camera->eye, v->latlong = true, v->pixel = stride * M_PI / l->height;
    for (int y = stride / 2; y < l->height; y += stride)
        for (int x = stride / 2; x < l->width; x += stride) {
            vec3 p = v3_sub(point_at(l->positions, l->width, (size_t)x, (size_t)y), v->eye);
            vec3 d = latlong_direction(l->camera, l->width, l->height, x + 0.5, y + 0.5);
            if (shows_nothing(latlong_empty, l, x, y))
                put(v->empty, &v->empty_count, d);
            else if (!latlong_empty(l, x, y) && v3_dot(p, d) > ON_RAY * v3_length(p)) // else it was sampled past an edge
                put_point(v, v3_add(p, v->eye), l->albedo ? l->albedo + 3 * ((size_t)y * (size_t)l->width + (size_t)x) : NULL);
        }
}

// One pixel in a block of stride x stride, whose place it takes.
static bool take_surface(const gbuffer *gb, int stride, world_view *v, error *e)
{
    const int first = stride / 2;
    v->width = (gb->width - first + stride - 1) / stride, v->height = (gb->height - first + stride - 1) / stride;
    v->camera = gb->camera;
    v->camera.fx /= stride, v->camera.fy /= stride;
    v->camera.cx = (gb->camera.cx - first - 0.5) / stride + 0.5, v->camera.cy = (gb->camera.cy - first - 0.5) / stride + 0.5;
    v->surface = mem_pixels((size_t)v->width * (size_t)v->height, 4 * sizeof *v->surface, e);
    float *to = v->surface;
    for (int y = first; to && y < gb->height; y += stride)
        for (int x = first; x < gb->width; x += stride, to += 4) {
            size_t i = (size_t)y * (size_t)gb->width + (size_t)x;
            bool there = gb->depth[i] > 0.0f;
            to[0] = there ? gb->depth[i] : shows_nothing(gbuffer_pixel_empty, gb, x, y) ? -1.0f : 0.0f;
            for (int k = 0; k < 3; k++) to[1 + k] = there ? gb->normal[4 * i + (size_t)k] : 0.0f;
        }
    return v->surface != NULL;
}

static void take_seen(const gbuffer *gb, int stride, world_view *v)
{
    const camera *c = &gb->camera;
    v->eye = c->origin, v->pixel = stride / c->fx;
    for (int y = stride / 2; y < gb->height; y += stride)
        for (int x = stride / 2; x < gb->width; x += stride) {
            vec3 p = gbuffer_position(gb, x, y);
            if (p.z > 0.0) {
                put_point(v, v3_add(c->origin, m3_apply(c->world_from_camera, p)),
                          gb->albedo ? gb->albedo + 4 * ((size_t)y * (size_t)gb->width + (size_t)x) : NULL);
                continue;
            }
            if (!shows_nothing(gbuffer_pixel_empty, gb, x, y)) continue;
            vec3 ray = v3((x + 0.5 - c->cx) / c->fx, (y + 0.5 - c->cy) / c->fy, 1.0);
            put(v->empty, &v->empty_count, m3_apply(c->world_from_camera, v3_scale(ray, 1.0 / v3_length(ray))));
        }
}

bool world_view_of_frame(const gbuffer *gb, size_t most, world_view *out, error *e)
{
    int stride = stride_of(gb->width, gb->height, most);
    if (!make_room(out, most, gb->albedo != NULL, e)) return false;
    take_seen(gb, stride, out);
    return take_surface(gb, stride, out, e);
}

bool world_view_read(const exrio_file *file, const resolution *r, const gbuffer_options *options, size_t most, world_view *out,
                     log_t *log, error *e)
{
    int width, height;
    latlong_camera c;
    gbuffer gb = {0};
    float *positions = NULL, *albedo = NULL;
    bool ok = false;
    *out = (world_view){0};
    if (r->components[ROLE_POSITION] < 3)
        return err_set(e, ERR_INPUT, file->path, NULL,
                       "it has no position pass, which alone says where in the world its surfaces are");
    positions = pass_of(file, r, ROLE_POSITION, &width, &height, e);
    if (!positions) goto out;
    if (latlong_fit(positions, width, height, &c)) {
        bool has_albedo = r->components[ROLE_ALBEDO] >= 3 && (albedo = pass_of(file, r, ROLE_ALBEDO, &width, &height, e));
        if (!make_room(out, most, has_albedo, e)) goto out;
        take_latlong(&(latlong_picture){positions, albedo, width, height, &c}, stride_of(width, height, most), out);
        log_info(log, "%s: a lat-long G-buffer, its eye at %.3g %.3g %.3g, %c up, %.2f pixels off in the median", file->path,
                 c.eye.x, c.eye.y, c.eye.z, c.up == 2 ? 'z' : 'y', c.error);
        ok = true;
        goto out;
    }
    if (!gbuffer_build(file, r, options, &gb, log, e)) goto out;
    if (!gb.camera.has_world || gb.camera.kind != CAMERA_PERSPECTIVE) {
        err_set(
            e, ERR_INPUT, file->path, NULL,
            "its positions are not those of a perspective or lat-long camera in world space, so nobody knows from where it was "
            "seen");
        goto out;
    }
    ok = world_view_of_frame(&gb, most, out, e);
out:
    if (!ok) world_view_free(out);
    gbuffer_free(&gb);
    free(positions);
    free(albedo);
    return ok;
}

void world_view_free(world_view *v)
{
    free(v->points);
    free(v->albedo);
    free(v->empty);
    free(v->surface);
    *v = (world_view){0};
}
