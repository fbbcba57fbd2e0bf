#include "passes/arc.h"
#include "passes/further.h"

// What is recorded does not depend on the method: the march is that of `arc`, with the method's number of samples.
bool pass_confidence(pass_context *c, error *e)
{
    gpu_image *out = &c->image[IMAGE_CONFIDENCE];
    const arc_params params = arc_params_of(c);
    const pass_call call = {
        .program = "confidence",
        .variant = further_serves(c) ? "FURTHER" : NULL,
        PASS_PARAMS(params),
        .reads = {{"surface_image", &c->image[IMAGE_SURFACE]}, {"further_image", c->further}},
        .writes = {{"confidence_image", out}},
    };
    return arc_make_inputs(c, e) && pass_make_image(c, IMAGE_CONFIDENCE, e) && pass_run(c, &call, e) &&
           (c->set.blur == 0 || pass_blur(c, &(pass_blurring){.radius = c->set.blur, .scalars = {out}}, e));
}
