#include "passes/pass.h"

bool pass_irradiance(pass_context *c, error *e)
{
    const pass_call call = {.program = "irradiance",
                            .reads = {{"occlusion_image", &c->image[IMAGE_OCCLUSION]}},
                            .writes = {{"radiance_image", &c->image[IMAGE_RADIANCE]}}};
    return pass_make_image(c, IMAGE_RADIANCE, e) && pass_run(c, &call, e);
}
