#include "passes/ssdo.h"

#include <math.h>
#include <stdio.h>

ssdo_params ssdo_params_of(const pass_context *c)
{
    const pass_settings *s = &c->set;
    return (ssdo_params){
        .radius = (float)s->radius,
        .thickness = isinf(s->thickness) ? 1e30f : (float)s->thickness,
        .samples = s->samples,
        .seed = s->seed,
        .level = (float)s->env_level,
        .strength = (float)s->bounce_strength,
    };
}

bool pass_ssdo(pass_context *c, error *e)
{
    ssdo_params params = ssdo_params_of(c);
    char defines[64];
    snprintf(defines, sizeof defines, "%s%s", c->want_radiance ? "LIGHT 1\n" : "", c->want_visibility ? "VISIBILITY 1\n" : "");
    if (!pass_make(c, &c->occlusion, GL_R32F, 1.0f, e)) return false;
    if (c->want_radiance && !pass_make(c, &c->radiance, GL_RGBA32F, 0.0f, e)) return false;
    if (c->want_visibility && !pass_make(c, &c->visibility, GL_R32F, 1.0f, e)) return false;
    const pass_binding bindings[] = {
        {2, &c->occlusion, GL_WRITE_ONLY}, {3, &c->radiance, GL_WRITE_ONLY}, {4, &c->visibility, GL_WRITE_ONLY}};
    return pass_run(c, "ssdo", defines, &params, sizeof params, bindings, 3, false, e);
}
