// A room with a window, for the tests of what lies outside the frame.
#ifndef SSDO_TESTS_OUTSIDE_ROOMS_H
#define SSDO_TESTS_OUTSIDE_ROOMS_H

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

#endif
