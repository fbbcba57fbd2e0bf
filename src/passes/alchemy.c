#include "passes/params.h"
#include "passes/pass.h"

bool pass_alchemy(pass_context *c, error *e)
{
    const points_params params = {.radius = (float)c->set.radius, .samples = c->set.samples, .seed = c->set.seed};
    const pass_call call = {.program = "alchemy", PASS_PARAMS(params), .writes = {{"occlusion_image", &c->occlusion}}};
    return pass_make(c, &c->occlusion, GL_R32F, 1.0f, e) && pass_run(c, &call, e);
}
