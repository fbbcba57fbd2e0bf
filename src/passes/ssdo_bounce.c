#include "passes/ssdo.h"

bool pass_ssdo_bounce(pass_context *c, error *e)
{
    // A picture the renderer lit is what surfaces send; our own radiance still needs their albedo.
    bool exitant = !c->set.relight;
    ssdo_params params = ssdo_params_of(c);
    params.exitant = exitant;
    const pass_call call = {
        .program = "ssdo_bounce",
        PASS_PARAMS(params),
        .reads = {{"sender_image", exitant ? &c->beauty : &c->radiance}, {"albedo_image", exitant ? &c->beauty : &c->albedo}},
        .writes = {{"indirect_image", &c->indirect}},
    };
    return pass_make(c, &c->indirect, GL_RGBA32F, 0.0f, e) && pass_run(c, &call, e);
}
