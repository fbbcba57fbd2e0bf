#include "passes/ssdo.h"

#include <math.h>

#include "passes/variants.h"

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
    const ssdo_params params = ssdo_params_of(c);
    variant v = {{0}};
    variant_add(&v, c->want_radiance, "LIGHT");
    variant_add(&v, c->want_visibility, "VISIBILITY");
    if (!pass_make(c, &c->occlusion, GL_R32F, 1.0f, e)) return false;
    if (c->want_radiance && !pass_make(c, &c->radiance, GL_RGBA32F, 0.0f, e)) return false;
    if (c->want_visibility && !pass_make(c, &c->visibility, GL_R32F, 1.0f, e)) return false;
    const pass_call call = {
        .program = "ssdo",
        .variant = v.words,
        PASS_PARAMS(params),
        .writes = {{"occlusion_image", &c->occlusion}, {"radiance_image", &c->radiance}, {"visibility_image", &c->visibility}},
    };
    return pass_run(c, &call, e);
}
