#include "passes/pass.h"

bool pass_hemisphere(pass_context *c, error *e)
{
    struct {
        float radius;
        int samples, seed, unused;
    } params = {(float)c->set.radius, c->set.samples, c->set.seed, 0};
    if (!pass_make(c, &c->occlusion, GL_R32F, 1.0f, e)) return false;
    const pass_binding bindings[] = {{2, &c->occlusion, GL_WRITE_ONLY}};
    return pass_run(c, "hemisphere", NULL, &params, sizeof params, bindings, 1, false, e);
}
