#include <math.h>

#include "passes/params.h"
#include "passes/pass.h"

// As many directions as steps a direction: the paper's 16 x 16 at 256.
static void grid(int samples, int *directions, int *steps)
{
    int d = (int)lround(sqrt((double)samples));
    *directions = d > 1 ? d : 1;
    *steps = samples / *directions > 1 ? samples / *directions : 1;
}

bool pass_hbao(pass_context *c, error *e)
{
    hbao_params params = {.radius = (float)c->set.radius, .bias = (float)(c->set.angle_bias * M_PI / 180.0), .seed = c->set.seed};
    grid(c->set.samples, &params.directions, &params.steps);
    const pass_call call = {.program = "hbao", PASS_PARAMS(params), .writes = {{"occlusion_image", &c->occlusion}}};
    return pass_make(c, &c->occlusion, GL_R32F, 1.0f, e) && pass_run(c, &call, e);
}
