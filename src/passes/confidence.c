#include "passes/arc.h"

// What the picture records does not depend on the method: the march is that of `arc`, with the method's number of samples.
bool pass_confidence(pass_context *c, error *e)
{
    gpu_image *out = &c->image[IMAGE_CONFIDENCE];
    const arc_params params = arc_params_of(c);
    const pass_call call = {
        .program = "confidence",
        PASS_PARAMS(params),
        .reads = {{"surface_image", &c->image[IMAGE_SURFACE]}},
        .writes = {{"confidence_image", out}},
    };
    return arc_make_inputs(c, e) && pass_make_image(c, IMAGE_CONFIDENCE, e) && pass_run(c, &call, e) &&
           (c->set.blur == 0 || pass_blur(c, c->set.blur, out, NULL, NULL, e));
}
