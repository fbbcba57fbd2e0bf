#include "passes/pass.h"

bool pass_irradiance(pass_context *c, error *e)
{
    const pass_call call = {
        .program = "irradiance", .reads = {{"occlusion_image", &c->occlusion}}, .writes = {{"radiance_image", &c->radiance}}};
    return pass_make(c, &c->radiance, GL_RGBA32F, 0.0f, e) && pass_run(c, &call, e);
}
