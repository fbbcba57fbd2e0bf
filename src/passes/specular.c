#include "passes/params.h"
#include "passes/pass.h"

enum { SPECULAR_SAMPLES = 64 };

bool pass_specular(pass_context *c, error *e)
{
    const specular_params params = {.samples = SPECULAR_SAMPLES, .base_albedo = c->set.base_albedo && c->image[IMAGE_ALBEDO].id};
    const pass_call call = {
        .program = "specular",
        PASS_PARAMS(params),
        .reads = {{"material_image", &c->image[IMAGE_MATERIAL]},
                  {"albedo_image", c->image[IMAGE_ALBEDO].id ? &c->image[IMAGE_ALBEDO] : &c->image[IMAGE_NORMAL]}},
        .writes = {{"specular_image", &c->image[IMAGE_SPECULAR]}, {"diffuse_share_image", &c->image[IMAGE_DIFFUSE_SHARE]}},
    };
    return pass_make_image(c, IMAGE_SPECULAR, e) && pass_make_image(c, IMAGE_DIFFUSE_SHARE, e) && pass_run(c, &call, e);
}
