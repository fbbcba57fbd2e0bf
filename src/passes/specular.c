#include "passes/pass.h"

enum { SPECULAR_SAMPLES = 64 };

bool pass_specular(pass_context *c, error *e)
{
    int params[4] = {SPECULAR_SAMPLES, c->set.base_albedo && c->albedo.id};
    if (!pass_make(c, &c->specular, GL_RGBA32F, 0.0f, e) || !pass_make(c, &c->diffuse_share, GL_RGBA32F, 1.0f, e)) return false;
    const pass_binding bindings[] = {{2, &c->material, GL_READ_ONLY},
                                     {3, c->albedo.id ? &c->albedo : &c->normal, GL_READ_ONLY},
                                     {4, &c->specular, GL_WRITE_ONLY},
                                     {5, &c->diffuse_share, GL_WRITE_ONLY}};
    return pass_run(c, "specular", NULL, params, sizeof params, bindings, 4, false, e);
}
