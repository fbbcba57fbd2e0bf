#include "passes/pass.h"

#include <stdio.h>
#include <string.h>

bool pass_composite(pass_context *c, error *e)
{
    const pass_settings *s = &c->set;
    bool split = !s->relight && !s->multiply_all && c->diffuse_direct.id && c->albedo.id;
    bool bounce = c->indirect.id && c->albedo.id && (s->relight || s->bounce_in_composite);
    struct {
        float amount;
        int averaged, unused;
        float depthmask;
    } params = {(float)s->amount, s->averaged_albedo, 0, (float)s->depthmask_strength};
    char defines[256];
    snprintf(defines, sizeof defines, "BACKGROUND %d\n%s%s%s%s%s%s%s%s%s", c->beauty.id || s->background != 1 ? s->background : 0,
             s->relight ? "RELIGHT 1\n" : "", s->relight && s->visibility_mode ? "VISIBILITY 1\n" : "", split ? "SPLIT 1\n" : "",
             c->albedo.id ? "ALBEDO 1\n" : "", split || (s->relight && !s->visibility_mode) ? "RADIANCE 1\n" : "",
             bounce ? "INDIRECT 1\n" : "", s->relight && c->specular.id ? "SPECULAR 1\n" : "",
             s->relight && c->emission.id ? "EMISSION 1\n" : "", c->beauty.id ? "BEAUTY 1\n" : "");
    if (c->coverage.id) snprintf(defines + strlen(defines), sizeof defines - strlen(defines), "COVERAGE 1\n");
    if (c->want_diffuse) strcat(defines, "DIFFUSE 1\n");
    if (s->multiply_all) strcat(defines, "MULTIPLY_ALL 1\n");
    if (s->depthmask_strength > 0.0 && c->depthmask.id) strcat(defines, "DEPTHMASK 1\n");
    if (c->want_diffuse && !pass_make(c, &c->diffuse, GL_RGBA32F, 0.0f, e)) return false;
    if (!pass_make(c, &c->composite, GL_RGBA32F, 0.0f, e)) return false;
    const pass_binding bindings[] = {
        {2, s->relight && s->visibility_mode ? &c->visibility : &c->occlusion, GL_READ_ONLY},
        {4, &c->albedo, GL_READ_ONLY},
        {5, s->relight ? &c->radiance : &c->diffuse_direct, GL_READ_ONLY},
        {6, &c->indirect, GL_READ_ONLY},
        {7, &c->beauty, GL_READ_ONLY},
        {8, &c->specular, GL_READ_ONLY},
        {9, &c->diffuse_share, GL_READ_ONLY},
        {10, &c->emission, GL_READ_ONLY},
        {11, &c->coverage, GL_READ_ONLY},
        {13, &c->depthmask, GL_READ_ONLY},
        {3, &c->composite, GL_WRITE_ONLY},
    };
    const gpu_image *targets[] = {&c->composite, c->want_diffuse ? &c->diffuse : NULL};
    // Background pixels have a composite too.
    return s->relight ? pass_draw(c, "composite", defines, &params, sizeof params, bindings, 10, targets, 2, true, e)
                      : pass_run(c, "composite", defines, &params, sizeof params, bindings, 11, true, e);
}
