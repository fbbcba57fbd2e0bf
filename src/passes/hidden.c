#include "passes/hidden.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/sort.h"
#include "light/sh.h"

#include "../../shaders/include/constants.glsl"

enum { PLACES = 48 };             // of the frame, a side
enum { WIDTH = 64, HEIGHT = 32 }; // of the lat-long grid of directions

// Of each coordinate the median over a grid of the frame. (0, 0, 0) if no surface is there.
static bool find_middle(const gbuffer *gb, vec3 *middle, error *e)
{
    enum { ALL = PLACES * PLACES };
    double *of[3] = {mem_pixels(3 * ALL, sizeof *of[0], e)};
    size_t n = 0;
    *middle = v3(0, 0, 0);
    if (!of[0]) return false;
    of[1] = of[0] + ALL, of[2] = of[1] + ALL;
    for (int i = 0; i < ALL; i++) {
        int x = (2 * (i % PLACES) + 1) * gb->width / (2 * PLACES), y = (2 * (i / PLACES) + 1) * gb->height / (2 * PLACES);
        if (gb->depth[(size_t)y * (size_t)gb->width + (size_t)x] == 0.0f) continue;
        vec3 p = gbuffer_position(gb, x, y);
        of[0][n] = p.x, of[1][n] = p.y, of[2][n] = p.z;
        n++;
    }
    for (int k = 0; k < 3; k++) sort_doubles(of[k], n);
    if (n > 0) *middle = v3(of[0][n / 2], of[1][n / 2], of[2][n / 2]);
    free(of[0]);
    return true;
}

// Whether the plane that holds x goes on there.
static bool holds(const plane *p, vec3 x)
{
    double u = (v3_dot(p->axis[0], x) - p->centre[0]) / p->extent[0], v = (v3_dot(p->axis[1], x) - p->centre[1]) / p->extent[1];
    double most = fmax(fabs(u), fabs(v));
    if (!(most <= 1.0)) return most <= BELIEVED_PLANE;
    int column = (int)fmin(0.5 * (u + 1.0) * PLANE_CELLS, PLANE_CELLS - 1),
        row = (int)fmin(0.5 * (v + 1.0) * PLANE_CELLS, PLANE_CELLS - 1);
    return p->cells[row] >> column & 1;
}

// Whether a plane is met from `place` in the unit direction d. A place that lies on a plane, within twice its margin, is before
// it.
static bool meets(const plane *p, const gbuffer *gb, vec3 place, vec3 d)
{
    double height = v3_dot(p->normal, place) - p->offset, towards = -v3_dot(p->normal, d);
    double on_it = 2.0 * p->margin * (gb->camera.kind == CAMERA_ORTHOGRAPHIC ? 1.0 : place.z);
    return towards > 1e-6 && height >= -on_it && holds(p, v3_add(place, v3_scale(d, fmax(height, 0.0) / towards)));
}

// The share of the environment's light from the unit direction d that reaches `place`, in camera space.
static double open_share(const hidden_place *at, vec3 place, vec3 d)
{
    double open = 1.0;
    for (int k = 0; k < at->planes->count; k++)
        open *= meets(&at->planes->planes[k], at->gb, place, d) ? 1.0 - at->planes->planes[k].belief : 1.0;
    if (open == 0.0 || openness_is_whole(at->outside)) return open;
    vec3 upright = v3_add(at->upright_eye, m3_apply(at->upright_from_camera, place));
    return open * openness_towards(at->outside, upright, m3_apply(at->upright_from_camera, d));
}

bool hidden_light(const environment *env, const hidden_place *at, int threads, double sh[HIDDEN_SH][3], error *e)
{
    mat3 camera_from_map = m3_transpose(at->map_from_camera);
    double level = fmax(0.0, log2((double)env->levels[0].width / WIDTH)), all[SH_MAX][3];
    vec3 place;
    float *seen = mem_zero((size_t)WIDTH * HEIGHT, 4 * sizeof *seen, e);
    bool ok = seen && find_middle(at->gb, &place, e);
    for (int i = 0; ok && i < WIDTH * HEIGHT; i++) {
        double phi = (0.5 - (i % WIDTH + 0.5) / WIDTH) * 2.0 * M_PI, theta = (i / WIDTH + 0.5) / HEIGHT * M_PI;
        vec3 direction = v3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
        double open = open_share(at, place, m3_apply(camera_from_map, direction));
        vec3 L = open > 0.0 ? v3_scale(environment_lookup(env, direction, level), open) : v3(0, 0, 0);
        seen[4 * i] = (float)L.x, seen[4 * i + 1] = (float)L.y, seen[4 * i + 2] = (float)L.z;
    }
    ok = ok && sh_project(seen, WIDTH, HEIGHT, threads, all, e);
    if (ok) memcpy(sh, all, HIDDEN_SH * sizeof *sh);
    free(seen);
    return ok;
}
