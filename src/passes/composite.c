#include <string.h>

#include "passes/params.h"
#include "passes/pass.h"
#include "passes/variants.h"

// What is behind a surface that is relit (composite.comp's BACKGROUND).
enum { BEHIND_NOTHING, BEHIND_BEAUTY, BEHIND_ENVIRONMENT };

static void relit_variant(const pass_context *c, variant *v)
{
    const pass_settings *s = &c->set;
    int behind = c->image[IMAGE_BEAUTY].id || s->background != BEHIND_BEAUTY ? s->background : BEHIND_NOTHING;
    variant_add(v, true, "RELIGHT");
    variant_add(v, true, s->visibility_mode ? "VISIBILITY" : "RADIANCE");
    variant_number(v, "BACKGROUND", behind);
    variant_add(v, behind == BEHIND_BEAUTY, "BEAUTY");
    variant_add(v, true, "ALBEDO");
    variant_add(v, c->image[IMAGE_INDIRECT].id != 0, "INDIRECT");
    variant_add(v, c->image[IMAGE_SPECULAR].id != 0, "SPECULAR");
    variant_add(v, c->image[IMAGE_SPECULAR].id && s->multiply_all, "MULTIPLY_ALL");
    variant_add(v, c->image[IMAGE_EMISSION].id != 0, "EMISSION");
    variant_add(v, c->image[IMAGE_COVERAGE].id != 0, "COVERAGE");
    variant_add(v, c->want_diffuse, "DIFFUSE");
}

static void beauty_variant(const pass_context *c, variant *v)
{
    const pass_settings *s = &c->set;
    bool split = !s->multiply_all && c->image[IMAGE_DIFFUSE_DIRECT].id && c->image[IMAGE_ALBEDO].id;
    bool bounce = c->image[IMAGE_INDIRECT].id && c->image[IMAGE_ALBEDO].id && s->bounce_in_composite;
    variant_add(v, true, "BEAUTY");
    variant_add(v, split || bounce, "ALBEDO");
    variant_add(v, split, "SPLIT");
    variant_add(v, split, "RADIANCE");
    variant_add(v, bounce, "INDIRECT");
    variant_add(v, bounce && c->image[IMAGE_COVERAGE].id, "COVERAGE");
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
    variant_add(&v, s->depthmask_strength > 0.0 && c->image[IMAGE_DEPTHMASK].id, "DEPTHMASK");
    if (c->want_diffuse && !pass_make_image(c, IMAGE_DIFFUSE, e)) return false;
    if (!pass_make_image(c, IMAGE_COMPOSITE, e)) return false;
    const pass_call call = {
        .program = "composite",
        .variant = v.words,
        .everywhere = true,   // background pixels have a composite too
        .exact = !s->relight, // a beauty comes through to the bit
        PASS_PARAMS(params),
        .reads = {{"occlusion_image", s->relight && s->visibility_mode && c->image[IMAGE_VISIBILITY].id
                                          ? &c->image[IMAGE_VISIBILITY]
                                          : &c->image[IMAGE_OCCLUSION]},
                  {"albedo_image", &c->image[IMAGE_ALBEDO]},
                  {"radiance_image", s->relight ? &c->image[IMAGE_RADIANCE] : &c->image[IMAGE_DIFFUSE_DIRECT]},
                  {"indirect_image", &c->image[IMAGE_INDIRECT]},
                  {"beauty_image", &c->image[IMAGE_BEAUTY]},
                  {"specular_image", &c->image[IMAGE_SPECULAR]},
                  {"diffuse_share_image", &c->image[IMAGE_DIFFUSE_SHARE]},
                  {"emission_image", &c->image[IMAGE_EMISSION]},
                  {"coverage_image", &c->image[IMAGE_COVERAGE]},
                  {"depthmask_image", &c->image[IMAGE_DEPTHMASK]}},
        .writes = {{"composite_out", &c->image[IMAGE_COMPOSITE]}, {"diffuse_out", &c->image[IMAGE_DIFFUSE]}},
    };
    return pass_run(c, &call, e);
}
