#include "passes/pass.h"

#include <math.h>

// As many directions as steps a direction: the paper's 16 x 16 at 256.
static void grid(int samples, int *directions, int *steps)
{
    int d = (int)lround(sqrt((double)samples));
    *directions = d > 1 ? d : 1;
    *steps = samples / *directions > 1 ? samples / *directions : 1;
}

bool pass_hbao(pass_context *c, error *e)
{
    struct {
        float radius, bias;
        int directions, steps, seed, unused[3];
    } params = {.radius = (float)c->set.radius, .bias = (float)(c->set.angle_bias * M_PI / 180.0), .seed = c->set.seed};
    grid(c->set.samples, &params.directions, &params.steps);
    if (!pass_make(c, &c->occlusion, GL_R32F, 1.0f, e)) return false;
    const pass_binding bindings[] = {{2, &c->occlusion, GL_WRITE_ONLY}};
    return pass_run(c, "hbao", NULL, &params, sizeof params, bindings, 1, false, e);
}
