#include "scene_picture.h"

#include <stdlib.h>

#include "base/mem.h"

static view plain_view(int width, int height, double pixel_aspect)
{
    box2 window = {0, 0, width - 1, height - 1};
    view v = {.width = width, .height = height, .data_window = window, .display_window = window, .pixel_aspect = pixel_aspect};
    v.camera.cx = 0.5 * width;
    v.camera.cy = 0.5 * height;
    view_look(&v, v3(0, 0, 0), v3(0, 1, 0), 0.0);
    return v;
}

view view_perspective(int width, int height, double fov_degrees, double pixel_aspect)
{
    view v = plain_view(width, height, pixel_aspect);
    v.camera.kind = CAMERA_PERSPECTIVE;
    v.camera.fx = 0.5 * width / tan(fov_degrees * (M_PI / 360.0));
    v.camera.fy = v.camera.fx * pixel_aspect;
    return v;
}

view view_orthographic(int width, int height, double width_in_units, double pixel_aspect)
{
    view v = plain_view(width, height, pixel_aspect);
    v.camera.kind = CAMERA_ORTHOGRAPHIC;
    v.camera.fx = width / width_in_units;
    v.camera.fy = v.camera.fx * pixel_aspect;
    return v;
}

static mat3 columns(vec3 x, vec3 y, vec3 z) { return (mat3){{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}}; }

void view_look(view *v, vec3 eye, vec3 target, double roll_degrees)
{
    vec3 z = v3_normalize(v3_sub(target, eye));
    vec3 up = fabs(z.z) > 1.0 - 1e-9 ? v3(0, 1, 0) : v3(0, 0, 1);
    vec3 x = v3_normalize(v3_cross(z, up)), y = v3_cross(z, x);
    v->camera.world_from_camera = m3_mul(columns(x, y, z), rotation_about(v3(0, 0, 1), roll_degrees));
    v->camera.origin = eye;
    v->camera.has_world = true;
    v->camera.residual = -1.0;
}

void view_scene(view *v, const scene *s) { view_look(v, s->eye, s->target, 0.0); }

void view_place(view *v, double scale, mat3 rotation, vec3 offset)
{
    camera *c = &v->camera;
    c->origin = v3_add(m3_apply(rotation, v3_scale(c->origin, scale)), offset);
    c->world_from_camera = m3_mul(rotation, c->world_from_camera);
    if (c->kind == CAMERA_ORTHOGRAPHIC) {
        c->fx /= scale;
        c->fy /= scale;
    }
}

void view_crop(view *v, box2 data_window)
{
    v->camera.cx += v->data_window.x0 - data_window.x0;
    v->camera.cy += v->data_window.y0 - data_window.y0;
    v->data_window = data_window;
    v->width = box2_width(data_window);
    v->height = box2_height(data_window);
}

void view_ray(const view *v, double x, double y, vec3 *origin, vec3 *direction)
{
    const camera *c = &v->camera;
    double u = (x - c->cx) / c->fx, w = (y - c->cy) / c->fy;
    bool perspective = c->kind == CAMERA_PERSPECTIVE;
    *origin = perspective ? c->origin : v3_add(c->origin, m3_apply(c->world_from_camera, v3(u, w, 0)));
    *direction = m3_apply(c->world_from_camera, perspective ? v3(u, w, 1) : v3(0, 0, 1));
}

bool view_project(const view *v, vec3 world, double *x, double *y, double *z)
{
    const camera *c = &v->camera;
    vec3 p = m3_apply(m3_transpose(c->world_from_camera), v3_sub(world, c->origin));
    double scale = c->kind == CAMERA_PERSPECTIVE ? 1.0 / p.z : 1.0;
    *x = c->cx + c->fx * p.x * scale;
    *y = c->cy + c->fy * p.y * scale;
    *z = p.z;
    return p.z > 0.0;
}

bool scene_at_pixel(const scene *s, const view *v, int x, int y, hit *out)
{
    vec3 o, d;
    view_ray(v, x + 0.5, y + 0.5, &o, &d);
    tracer t = scene_tracer(s);
    return t.closest(t.data, o, d, 0.0, INFINITY, out);
}

static void put(float *to, vec3 v)
{
    to[0] = (float)v.x;
    to[1] = (float)v.y;
    to[2] = (float)v.z;
}

bool scene_picture(const scene *s, const view *v, picture *out, error *e)
{
    size_t n = (size_t)v->width * (size_t)v->height;
    *out = (picture){.width = v->width, .height = v->height};
    out->position = mem_zero(n, 3 * sizeof(float), e);
    out->normal = mem_zero(n, 3 * sizeof(float), e);
    out->albedo = mem_zero(n, 3 * sizeof(float), e);
    out->depth = mem_zero(n, sizeof(float), e);
    out->valid = mem_zero(n, 1, e);
    if (!out->position || !out->normal || !out->albedo || !out->depth || !out->valid) {
        picture_free(out);
        return false;
    }
    for (size_t i = 0; i < n; i++) {
        hit h;
        if (!scene_at_pixel(s, v, (int)(i % (size_t)v->width), (int)(i / (size_t)v->width), &h)) continue;
        put(out->position + 3 * i, h.position);
        put(out->normal + 3 * i, h.normal);
        put(out->albedo + 3 * i, h.albedo);
        out->depth[i] = (float)h.t;
        out->valid[i] = 1;
    }
    return true;
}

void picture_free(picture *p)
{
    free(p->position);
    free(p->normal);
    free(p->albedo);
    free(p->depth);
    free(p->valid);
    *p = (picture){0};
}

typedef struct bounds {
    vec3 low, high;
} bounds;

static void grow(bounds *b, vec3 p)
{
    b->low = v3(fmin(b->low.x, p.x), fmin(b->low.y, p.y), fmin(b->low.z, p.z));
    b->high = v3(fmax(b->high.x, p.x), fmax(b->high.y, p.y), fmax(b->high.z, p.z));
}

static void fill_gbuffer(const scene *s, const view *v, gbuffer *out)
{
    mat3 camera_from_world = m3_transpose(v->camera.world_from_camera);
    bounds seen = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int y = 0; y < v->height; y++) {
        for (int x = 0; x < v->width; x++) {
            size_t i = (size_t)y * (size_t)v->width + (size_t)x;
            hit h;
            if (!scene_at_pixel(s, v, x, y, &h)) continue;
            out->depth[i] = (float)h.t;
            put(out->normal + 4 * i, m3_apply(camera_from_world, h.normal));
            put(out->albedo + 4 * i, h.albedo);
            grow(&seen, h.position);
            out->valid++;
        }
    }
    out->extent = out->valid ? v3_length(v3_sub(seen.high, seen.low)) : 0.0;
}

bool scene_gbuffer(const scene *s, const view *v, gbuffer *out, error *e)
{
    size_t n = (size_t)v->width * (size_t)v->height;
    *out = (gbuffer){.width = v->width,
                     .height = v->height,
                     .data_window = v->data_window,
                     .display_window = v->display_window,
                     .pixel_aspect = v->pixel_aspect,
                     .camera = v->camera,
                     .normal_from_camera = v->camera.world_from_camera,
                     .depth_kind = DEPTH_PLANAR};
    out->depth = mem_zero(n, sizeof(float), e);
    out->normal = mem_zero(n, 4 * sizeof(float), e);
    out->albedo = mem_zero(n, 4 * sizeof(float), e);
    if (!out->depth || !out->normal || !out->albedo) {
        free(out->depth);
        free(out->normal);
        free(out->albedo);
        *out = (gbuffer){0};
        return false;
    }
    fill_gbuffer(s, v, out);
    return true;
}
