#include "passes/params.h"
#include "passes/pass.h"

enum { SPECULAR_SAMPLES = 64 };

bool pass_specular(pass_context *c, error *e)
{
    const specular_params params = {.samples = SPECULAR_SAMPLES, .base_albedo = c->set.base_albedo && c->albedo.id};
    const pass_call call = {
        .program = "specular",
        PASS_PARAMS(params),
        .reads = {{"material_image", &c->material}, {"albedo_image", c->albedo.id ? &c->albedo : &c->normal}},
        .writes = {{"specular_image", &c->specular}, {"diffuse_share_image", &c->diffuse_share}},
    };
    return pass_make(c, &c->specular, GL_RGBA32F, 0.0f, e) && pass_make(c, &c->diffuse_share, GL_RGBA32F, 1.0f, e) &&
           pass_run(c, &call, e);
}
