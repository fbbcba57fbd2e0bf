#include <math.h>

#include "passes/method.h"
#include "passes/params.h"

static ssdo_params params_of(const pass_context *c)
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

static bool run(pass_context *c, error *e)
{
    const ssdo_params params = params_of(c);
    variant v = {{0}};
    variant_add(&v, c->want_radiance, "LIGHT");
    variant_add(&v, c->want_visibility, "VISIBILITY");
    if (!pass_make_image(c, IMAGE_OCCLUSION, e)) return false;
    if (c->want_radiance && !pass_make_image(c, IMAGE_RADIANCE, e)) return false;
    if (c->want_visibility && !pass_make_image(c, IMAGE_VISIBILITY, e)) return false;
    const pass_call call = {
        .program = "ssdo",
        .variant = v.words,
        PASS_PARAMS(params),
        .writes = {{"occlusion_image", &c->image[IMAGE_OCCLUSION]},
                   {"radiance_image", &c->image[IMAGE_RADIANCE]},
                   {"visibility_image", &c->image[IMAGE_VISIBILITY]}},
    };
    return pass_run(c, &call, e);
}

static bool run_bounce(pass_context *c, error *e)
{
    // A beauty is the light that surfaces send. Our own radiance is light before albedo.
    bool exitant = !c->set.relight;
    ssdo_params params = params_of(c);
    params.exitant = exitant;
    const pass_call call = {
        .program = "ssdo_bounce",
        PASS_PARAMS(params),
        .reads = {{"sender_image", exitant ? &c->image[IMAGE_BEAUTY] : &c->image[IMAGE_RADIANCE]},
                  {"albedo_image", exitant ? &c->image[IMAGE_BEAUTY] : &c->image[IMAGE_ALBEDO]}},
        .writes = {{"indirect_image", &c->image[IMAGE_INDIRECT]}},
    };
    return pass_make_image(c, IMAGE_INDIRECT, e) && pass_run(c, &call, e);
}

static const variant_row variants[] = {
    {.program = "ssdo", .pattern = "[LIGHT] [VISIBILITY]"},
    {.program = "ssdo_bounce", .pattern = ""},
    {0},
};

const bounce_kind bounce_ssdo = {
    .name = "ssdo",
    .source = SEES_PICTURE,
    .march = BOUNCE_AFTER,
    .run = run_bounce,
};

const method method_ssdo = {
    .name = "ssdo",
    .summary = "a point on each direction of the hemisphere (screen-space directional occlusion, Ritschel et al. 2009)",
    .weighting = "directions uniform in solid angle, weighted by cosine",
    .reaches = "one point per direction, within the radius; beyond it everything is open",
    .blind = "blockers between the points, behind other surfaces, outside the picture",
    .light = "environment and one bounce, within the radius",
    .choose = "to match an SSDO renderer",
    .options = "thickness",
    .samples = 64,
    .blur = 4,
    .thickness = 2.0,
    .makes = MAKES_LIGHT,
    .source = SEES_PICTURE,
    .weight = WEIGHS_COSINE,
    .reach = REACH_POINTS,
    .bounce = &bounce_ssdo,
    .variants = variants,
    .run = run,
};
