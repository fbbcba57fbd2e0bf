#include "passes/arc.h"

#include <math.h>
#include <stdlib.h>
#include <stdio.h>

static const float HUGE_LENGTH = 1e30f;

void arc_grid(int samples, int *slices, int *steps)
{
    int s = (int)lround(sqrt(samples / 4.0));
    *slices = s > 1 ? s : 1;
    *steps = samples / (2 * *slices) > 1 ? samples / (2 * *slices) : 1;
}

static float knob(const char *name, float fallback)
{
    const char *v = getenv(name);
    return v ? (float)atof(v) : fallback;
}

arc_params arc_params_of(const pass_context *c)
{
    const pass_settings *s = &c->set;
    arc_params p = {
        .radius = (float)s->radius,
        .thickness = isinf(s->thickness) ? HUGE_LENGTH : (float)s->thickness,
        .kappa = knob("KAPPA", 1.0f),
        .fixed_thickness = s->thickness_fixed,
        .seed = s->seed,
        .planes = c->planes.count,
        .spacing = knob("SPACING", 2.0f),
        .tolerance = knob("TOL", 2.0f),
        .level = (float)s->env_level,
        .strength = (float)s->bounce_strength,
        .test = {knob("T0", 8), knob("T1", 0), knob("T2", 0), knob("T3", 0)},
    };
    arc_grid(s->samples, &p.slices, &p.steps);
    return p;
}

// shaders/include/arc_planes.glsl
typedef struct plane_block {
    float equation[4], u[4], v[4], half_size[4];
    unsigned cells[PLANE_CELLS / 2]; // two rows each
} plane_block;

static void put(float to[4], vec3 a, double w)
{
    to[0] = (float)a.x, to[1] = (float)a.y, to[2] = (float)a.z, to[3] = (float)w;
}

// Finds the planes, once a frame, and puts them where the shader reads them.
static bool make_planes(pass_context *c, error *e)
{
    if (!c->set.planes || c->plane_uniforms) return true;
    if (!planes_find(c->gb, &c->planes, e)) return false;
    plane_block blocks[PLANES_MAX] = {0};
    for (int i = 0; i < c->planes.count; i++) {
        const plane *p = &c->planes.planes[i];
        put(blocks[i].equation, p->normal, p->offset);
        put(blocks[i].u, p->axis[0], p->centre[0]);
        put(blocks[i].v, p->axis[1], p->centre[1]);
        put(blocks[i].half_size, v3(p->half[0], p->half[1], 0), 0);
        for (int y = 0; y < PLANE_CELLS; y++) blocks[i].cells[y / 2] |= (unsigned)p->cells[y] << 16 * (y & 1);
    }
    c->plane_uniforms = gpu_uniforms_make(sizeof blocks);
    gpu_uniforms_set(c->plane_uniforms, 2, blocks, sizeof blocks);
    if (getenv("SHOWPLANES"))
        for (int i = 0; i < c->planes.count; i++)
            fprintf(stderr, " plane %.3f n(%.2f %.2f %.2f) half %.3g x %.3g;", c->planes.planes[i].share, c->planes.planes[i].normal.x,
                    c->planes.planes[i].normal.y, c->planes.planes[i].normal.z, c->planes.planes[i].half[0], c->planes.planes[i].half[1]);
    return true;
}

static bool run_march(pass_context *c, const char *defines, error *e)
{
    arc_params params = arc_params_of(c);
    if (!pass_make(c, &c->occlusion, GL_R32F, 1.0f, e)) return false;
    const pass_binding bindings[] = {{2, &c->occlusion, GL_WRITE_ONLY}};
    return pass_run(c, "arc", defines, &params, sizeof params, bindings, 1, false, e);
}

bool pass_gtao(pass_context *c, error *e) { return run_march(c, "HORIZON 1\n", e); }
bool pass_bitmask(pass_context *c, error *e) { return run_march(c, "BITMASK 1\n", e); }

bool pass_arc(pass_context *c, error *e)
{
    if (!make_planes(c, e)) return false;
    return run_march(c, c->planes.count ? "RUNS 1\nPLANES 1\n" : "RUNS 1\n", e);
}
