// A room with a window, and lat-long pictures of it, for the tests of what lies outside the frame.
#ifndef SSDO_TESTS_OUTSIDE_ROOMS_H
#define SSDO_TESTS_OUTSIDE_ROOMS_H

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "gbuffer/world_view.h"
#include "must.h"
#include "scene_picture.h"

static const vec3 grey = {0.5, 0.5, 0.5};

static inline void quad(scene *s, double x, double y, double z, vec3 a, vec3 b) { scene_add_quad(s, v3(x, y, z), a, b, grey); }

// A room 4 x 5 x 2.5, its far wall with a window from x = 1 to 3 and z = 1 to 2. The eye stands inside. Without `back` the wall
// behind the eye is missing, and without `lid` the ceiling.
static inline scene room(bool back, bool lid)
{
    scene s = {.eye = v3(2, 0.3, 1.5), .target = v3(2, 5, 1.3), .radius = 0.5};
    vec3 x = v3(1, 0, 0), y = v3(0, 1, 0), z = v3(0, 0, 1);
    quad(&s, 0, 0, 0, v3_scale(x, 4), v3_scale(y, 5));
    if (lid) quad(&s, 0, 0, 2.5, v3_scale(x, 4), v3_scale(y, 5));
    quad(&s, 0, 0, 0, v3_scale(y, 5), v3_scale(z, 2.5));
    quad(&s, 4, 0, 0, v3_scale(y, 5), v3_scale(z, 2.5));
    if (back) quad(&s, 0, 0, 0, v3_scale(x, 4), v3_scale(z, 2.5));
    quad(&s, 0, 5, 0, v3_scale(x, 4), v3_scale(z, 1));
    quad(&s, 0, 5, 2, v3_scale(x, 4), v3_scale(z, 0.5));
    quad(&s, 0, 5, 1, v3_scale(x, 1), v3_scale(z, 1));
    quad(&s, 3, 5, 1, v3_scale(x, 1), v3_scale(z, 1));
    return s;
}

static inline void look(const scene *s, int width, int height, double fov, gbuffer *gb)
{
    error e = {0};
    view v = view_perspective(width, height, fov, 1.0);
    view_scene(&v, s);
    must(scene_gbuffer(s, &v, gb, &e), &e);
}

enum { AROUND_W = 256, AROUND_H = 128 };

// The positions of a lat-long picture of the scene; 0 where it sees nothing.
static inline float *around(const scene *s, const latlong_camera *c)
{
    error e = {0};
    tracer t = scene_tracer(s);
    float *p = mem_zero((size_t)3 * AROUND_W * AROUND_H, sizeof *p, &e);
    assert_non_null(p);
    for (int i = 0; i < AROUND_W * AROUND_H; i++) {
        hit h;
        vec3 d = latlong_direction(c, AROUND_W, AROUND_H, i % AROUND_W + 0.5, i / AROUND_W + 0.5);
        if (!t.closest(t.data, c->eye, d, 1e-6, 1e9, &h)) continue;
        p[3 * i] = (float)h.position.x, p[3 * i + 1] = (float)h.position.y, p[3 * i + 2] = (float)h.position.z;
    }
    return p;
}

// The same as a further G-buffer.
static inline world_view view_around(const scene *s, const latlong_camera *c)
{
    error e = {0};
    float *p = around(s, c);
    world_view v = {.eye = c->eye, .latlong = true, .pixel = M_PI / AROUND_H, .points = p};
    v.empty = mem_zero((size_t)3 * AROUND_W * AROUND_H, sizeof *v.empty, &e);
    assert_non_null(v.empty);
    for (int i = 0; i < AROUND_W * AROUND_H; i++) {
        if (p[3 * i] == 0.0f && p[3 * i + 1] == 0.0f && p[3 * i + 2] == 0.0f) {
            vec3 d = latlong_direction(c, AROUND_W, AROUND_H, i % AROUND_W + 0.5, i / AROUND_W + 0.5);
            float *to = v.empty + 3 * v.empty_count++;
            to[0] = (float)d.x, to[1] = (float)d.y, to[2] = (float)d.z;
        } else {
            memmove(p + 3 * v.point_count++, p + 3 * i, 3 * sizeof *p);
        }
    }
    return v;
}

#endif
