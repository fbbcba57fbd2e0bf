// The canonical scenes of scene.h.
#include <stdint.h>

#include "scene.h"

enum { HUGE_SIZE = 1000000 }; // stands for infinity where a quad or a box must be finite

static const vec3 GREY = {0.5, 0.5, 0.5};

static void start(scene *s, vec3 eye, vec3 target, vec3 point, double radius)
{
    *s = (scene){.eye = eye, .target = target, .point = point, .radius = radius};
}

static void add_ground(scene *s) { scene_add_plane(s, v3(0, 0, 0), v3(0, 0, 1), GREY); }

void scene_tilted_plane(scene *s, double tilt_degrees, double distance)
{
    double a = tilt_degrees * (M_PI / 180.0);
    start(s, v3(0, 0, 0), v3(0, distance, 0), v3(0, distance, 0), 0.25 * distance);
    scene_add_plane(s, v3(0, distance, 0), v3(0, -cos(a), sin(a)), GREY);
}

void scene_wall(scene *s, double elevation_degrees, double distance)
{
    double a = elevation_degrees * (M_PI / 180.0);
    start(s, v3(0.7, -6, 4), v3(0, -0.2, 0.3), v3(0, -distance, 0), 1.0);
    add_ground(s);
    scene_add_quad(s, v3(-0.5 * HUGE_SIZE, 0, 0), v3(HUGE_SIZE, 0, 0), v3_scale(v3(0, cos(a), sin(a)), HUGE_SIZE),
                   v3(0.8, 0.6, 0.4));
}

void scene_corner(scene *s, double distance) { scene_wall(s, 90.0, distance); }

void scene_sphere(scene *s, double r, double h, double d)
{
    start(s, v3(0, -8 * r, 4 * r), v3(0, 0, 0.5 * h), v3(0, -d, 0), 2.0 * r);
    add_ground(s);
    scene_add_sphere(s, v3(0, 0, h), r, v3(0.8, 0.3, 0.2));
}

void scene_slit(scene *s, double w, double depth)
{
    start(s, v3(0, 0, 4 * depth), v3(0, 0, 0), v3(0, 0, 0), 4.0 * depth);
    add_ground(s);
    for (int side = -1; side <= 1; side += 2)
        scene_add_box(s, v3(0, side * (0.5 * w + 0.5 * HUGE_SIZE), 0.5 * depth), v3(HUGE_SIZE, 0.5 * HUGE_SIZE, 0.5 * depth), 0.0,
                      v3(0.7, 0.7, 0.3));
}

void scene_bar(scene *s, double width, double thickness, double h, double y)
{
    start(s, v3(0, -6 * h, 4 * h), v3(0, 0, 0.3 * h), v3(0, y, 0), 4.0 * h);
    add_ground(s);
    scene_add_box(s, v3(0, 0, h + 0.5 * thickness), v3(HUGE_SIZE, 0.5 * width, 0.5 * thickness), 0.0, v3(0.3, 0.5, 0.8));
}

void scene_patches(scene *s, double size, double gap)
{
    vec3 corner = v3(-0.5 * size, -0.5 * size, 0), x = v3(size, 0, 0), y = v3(0, size, 0);
    start(s, v3(0, -2.5 * size, 0.5 * gap), v3(0, 0, 0.5 * gap), v3(0, 0, 0), 2.0 * gap);
    scene_add_quad(s, corner, x, y, GREY);
    scene_add_quad(s, v3_add(corner, v3(0, 0, gap)), x, y, v3(0.8, 0.1, 0.1));
}

// A linear congruential generator, so that the scene never depends on the C library. 0 <= result < 1.
static double next(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double)(*state >> 8) / 16777216.0;
}

static vec3 next_colour(uint32_t *state)
{
    double r = next(state), g = next(state), b = next(state);
    return v3(0.2 + 0.7 * r, 0.2 + 0.7 * g, 0.2 + 0.7 * b);
}

void scene_clutter(scene *s)
{
    uint32_t state = 12345;
    start(s, v3(1.5, -7, 4.5), v3(0, 0, 0.6), v3(0, -1, 0), 1.0);
    add_ground(s);
    scene_add_plane(s, v3(0, 2.5, 0), v3(0, -1, 0), v3(0.7, 0.7, 0.75));
    for (int i = 0; i < 16; i++) {
        double x = -3.0 + 6.0 * next(&state), y = -1.8 + 3.6 * next(&state), size = 0.15 + 0.4 * next(&state);
        double tall = 0.5 + 1.5 * next(&state), turn = 90.0 * next(&state);
        vec3 colour = next_colour(&state);
        if (i % 2)
            scene_add_sphere(s, v3(x, y, size), size, colour);
        else
            scene_add_box(s, v3(x, y, size * tall), v3(size, 0.6 * size, size * tall), turn, colour);
    }
}

void scene_furnace(scene *s)
{
    start(s, v3(0.3, -1.5, 0.2), v3(0, 1, 0), v3(0, 0, -1), 1.0);
    scene_add_box(s, v3(0, 0, 0), v3(1.5, 2, 1), 0.0, v3(1, 1, 1));
}
