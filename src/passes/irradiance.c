#include "passes/pass.h"

bool pass_irradiance(pass_context *c, error *e)
{
    if (!pass_make(c, &c->radiance, GL_RGBA32F, 0.0f, e)) return false;
    const pass_binding bindings[] = {{2, &c->occlusion, GL_READ_ONLY}, {3, &c->radiance, GL_WRITE_ONLY}};
    return pass_run(c, "irradiance", NULL, NULL, 0, bindings, 2, false, e);
}
