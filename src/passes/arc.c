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
        .kappa = knob("KAPPA", 0.25f),
        .fixed_thickness = s->thickness_fixed,
        .seed = s->seed,
        .spacing = knob("SPACING", 2.0f),
        .tolerance = knob("TOL", 2.0f),
        .level = (float)s->env_level,
        .strength = (float)s->bounce_strength,
        .test = {knob("T0", 0), knob("T1", 0), knob("T2", 0), knob("T3", 0)},
    };
    arc_grid(s->samples, &p.slices, &p.steps);
    return p;
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
bool pass_arc(pass_context *c, error *e) { return run_march(c, "RUNS 1\n", e); }
