#include "passes/method.h"
#include "passes/params.h"

static bool run(pass_context *c, error *e)
{
    const points_params params = {.radius = (float)c->set.radius, .samples = c->set.samples, .seed = c->set.seed};
    const pass_call call = {
        .program = "alchemy", PASS_PARAMS(params), .writes = {{"occlusion_image", &c->image[IMAGE_OCCLUSION]}}};
    return pass_make_image(c, IMAGE_OCCLUSION, e) && pass_run(c, &call, e);
}

static const variant_row variants[] = {
    {.program = "alchemy", .pattern = ""},
    {0},
};

const method method_alchemy = {
    .name = "alchemy",
    .summary = "Alchemy obscurance: taps on a disc, no visibility test (McGuire et al. 2011)",
    .weighting = "falls off with distance; a look, not a fraction of the hemisphere",
    .reaches = "the radius; radiance is irradiance times occlusion",
    .blind = "directions: shadows have none; the rest as ssdo",
    .light = "SH irradiance times occlusion",
    .choose = "to match that look",
    .options = "",
    .samples = 32,
    .blur = 4,
    .thickness = 0.0,
    .source = SEES_PICTURE,
    .weight = WEIGHS_OWN,
    .reach = REACH_SURFACES,
    .variants = variants,
    .run = run,
};
