#include "passes/params.h"
#include "passes/pass.h"

bool pass_tone(pass_context *c, gpu_image *scalar, error *e)
{
    const tone_params params = {.scale = (float)c->set.scale, .contrast = (float)c->set.contrast};
    const pass_call call = {.program = "tone", PASS_PARAMS(params), .writes = {{"scalar_image", scalar}}};
    return pass_run(c, &call, e);
}
