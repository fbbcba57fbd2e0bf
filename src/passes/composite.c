#include <string.h>

#include "passes/params.h"
#include "passes/pass.h"
#include "passes/variants.h"

// What is behind a surface that is relit (composite.comp's BACKGROUND).
enum { BEHIND_NOTHING, BEHIND_BEAUTY, BEHIND_ENVIRONMENT };

static void relit_variant(const pass_context *c, variant *v)
{
    const pass_settings *s = &c->set;
    int behind = c->beauty.id || s->background != BEHIND_BEAUTY ? s->background : BEHIND_NOTHING;
    variant_add(v, true, "RELIGHT");
    variant_add(v, true, s->visibility_mode ? "VISIBILITY" : "RADIANCE");
    variant_number(v, "BACKGROUND", behind);
    variant_add(v, behind == BEHIND_BEAUTY, "BEAUTY");
    variant_add(v, true, "ALBEDO");
    variant_add(v, c->indirect.id != 0, "INDIRECT");
    variant_add(v, c->specular.id != 0, "SPECULAR");
    variant_add(v, c->specular.id && s->multiply_all, "MULTIPLY_ALL");
    variant_add(v, c->emission.id != 0, "EMISSION");
    variant_add(v, c->coverage.id != 0, "COVERAGE");
    variant_add(v, c->want_diffuse, "DIFFUSE");
}

static void beauty_variant(const pass_context *c, variant *v)
{
    const pass_settings *s = &c->set;
    bool split = !s->multiply_all && c->diffuse_direct.id && c->albedo.id;
    bool bounce = c->indirect.id && c->albedo.id && s->bounce_in_composite;
    variant_add(v, true, "BEAUTY");
    variant_add(v, split || bounce, "ALBEDO");
    variant_add(v, split, "SPLIT");
    variant_add(v, split, "RADIANCE");
    variant_add(v, bounce, "INDIRECT");
    variant_add(v, bounce && c->coverage.id, "COVERAGE");
}

bool pass_composite(pass_context *c, error *e)
{
    const pass_settings *s = &c->set;
    const composite_params params = {
        .amount = (float)s->amount, .averaged = s->averaged_albedo, .depthmask = (float)s->depthmask_strength};
    variant v = {{0}};
    if (s->relight)
        relit_variant(c, &v);
    else
        beauty_variant(c, &v);
    variant_add(&v, s->depthmask_strength > 0.0 && c->depthmask.id, "DEPTHMASK");
    if (c->want_diffuse && !pass_make(c, &c->diffuse, GL_RGBA32F, 0.0f, e)) return false;
    if (!pass_make(c, &c->composite, GL_RGBA32F, 0.0f, e)) return false;
    const pass_call call = {
        .program = "composite",
        .variant = v.words,
        .everywhere = true,   // background pixels have a composite too
        .exact = !s->relight, // a beauty comes through to the bit
        PASS_PARAMS(params),
        .reads = {{"occlusion_image", s->relight && s->visibility_mode && c->visibility.id ? &c->visibility : &c->occlusion},
                  {"albedo_image", &c->albedo},
                  {"radiance_image", s->relight ? &c->radiance : &c->diffuse_direct},
                  {"indirect_image", &c->indirect},
                  {"beauty_image", &c->beauty},
                  {"specular_image", &c->specular},
                  {"diffuse_share_image", &c->diffuse_share},
                  {"emission_image", &c->emission},
                  {"coverage_image", &c->coverage},
                  {"depthmask_image", &c->depthmask}},
        .writes = {{"composite_out", &c->composite}, {"diffuse_out", &c->diffuse}},
    };
    return pass_run(c, &call, e);
}
