#include "passes/pass.h"

bool pass_look(pass_context *c, gpu_image *scalar, error *e)
{
    float params[4] = {(float)c->set.scale, (float)c->set.contrast};
    const pass_binding bindings[] = {{2, scalar, GL_READ_WRITE}};
    return pass_run(c, "look", NULL, params, sizeof params, bindings, 1, false, e);
}
