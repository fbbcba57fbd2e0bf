#include "passes/method.h"
#include "passes/params.h"

static bool run(pass_context *c, error *e)
{
    const points_params params = {.radius = (float)c->set.radius, .samples = c->set.samples, .seed = c->set.seed};
    const pass_call call = {
        .program = "hemisphere", PASS_PARAMS(params), .writes = {{"occlusion_image", &c->image[IMAGE_OCCLUSION]}}};
    return pass_make_image(c, IMAGE_OCCLUSION, e) && pass_run(c, &call, e);
}

static const variant_row variants[] = {
    {.program = "hemisphere", .pattern = ""},
    {0},
};

const method method_hemisphere = {
    .name = "hemisphere",
    .summary = "points in the half space over the normal, with a range check: the common tutorial's",
    .weighting = "the common tutorial's kernel, nearly solid angle; near points count more",
    .reaches = "points within the radius, most of them within half of it",
    .blind = "as alchemy",
    .light = "SH irradiance times occlusion",
    .choose = "to match that look, or as the cheapest method per sample",
    .options = "",
    .samples = 64,
    .blur = 4,
    .thickness = 0.0,
    .source = SEES_PICTURE,
    .weight = WEIGHS_OWN,
    .reach = REACH_POINTS,
    .variants = variants,
    .run = run,
};
