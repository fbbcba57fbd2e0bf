#include <math.h>

#include "passes/method.h"
#include "passes/params.h"

// As many directions as steps a direction: the paper's 16 x 16 at 256.
static void grid(int samples, int *directions, int *steps)
{
    int d = (int)lround(sqrt((double)samples));
    *directions = d > 1 ? d : 1;
    *steps = samples / *directions > 1 ? samples / *directions : 1;
}

static bool run(pass_context *c, error *e)
{
    hbao_params params = {.radius = (float)c->set.radius, .bias = (float)(c->set.angle_bias * M_PI / 180.0), .seed = c->set.seed};
    grid(c->set.samples, &params.directions, &params.steps);
    const pass_call call = {.program = "hbao", PASS_PARAMS(params), .writes = {{"occlusion_image", &c->image[IMAGE_OCCLUSION]}}};
    return pass_make_image(c, IMAGE_OCCLUSION, e) && pass_run(c, &call, e);
}

static const variant_row variants[] = {
    {.program = "hbao", .pattern = ""},
    {0},
};

const method method_hbao = {
    .name = "hbao",
    .summary = "one horizon a direction, blockers fade with distance (Bavoil et al. 2008)",
    .weighting = "solid angle, blockers fade as 1 - (d/R)^2",
    .reaches = "surfaces within the radius",
    .blind = "gaps: all beneath a horizon is blocked; the rest as alchemy",
    .light = "SH irradiance times occlusion",
    .choose = "to match that look",
    .options = "angle-bias",
    .samples = 256,
    .blur = 2,
    .thickness = 0.0,
    .source = SEES_PICTURE,
    .weight = WEIGHS_OWN,
    .reach = REACH_SURFACES,
    .variants = variants,
    .run = run,
};
