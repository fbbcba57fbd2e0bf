#include "passes/ssdo.h"

bool pass_ssdo_bounce(pass_context *c, error *e)
{
    // A picture the renderer lit is what surfaces send; our own radiance still needs their albedo.
    bool exitant = !c->set.relight;
    ssdo_params params = ssdo_params_of(c);
    params.exitant = exitant;
    if (!pass_make(c, &c->indirect, GL_RGBA32F, 0.0f, e)) return false;
    const pass_binding bindings[] = {{2, exitant ? &c->beauty : &c->radiance, GL_READ_ONLY},
                                     {3, exitant ? &c->beauty : &c->albedo, GL_READ_ONLY},
                                     {4, &c->indirect, GL_WRITE_ONLY}};
    return pass_run(c, "ssdo_bounce", NULL, &params, sizeof params, bindings, 3, false, e);
}
