#include "passes/pass.h"

#include <stdio.h>

bool pass_edges(pass_context *c, error *e)
{
    char defines[128];
    snprintf(defines, sizeof defines, "%s%s%s%s%s", c->bent.id ? "BENT 1\n" : "", c->sh[0].id ? "SH 1\n" : "",
             c->visibility.id ? "VISIBILITY 1\n" : "", c->radiance.id ? "RADIANCE 1\n" : "",
             c->indirect.id ? "INDIRECT 1\n" : "");
    const pass_binding bindings[] = {
        {2, &c->coverage, GL_READ_ONLY},  {3, &c->occlusion, GL_READ_WRITE}, {4, &c->visibility, GL_READ_WRITE},
        {5, &c->radiance, GL_READ_WRITE}, {6, &c->indirect, GL_READ_WRITE},  {7, &c->sh[0], GL_READ_WRITE},
        {8, &c->sh[1], GL_READ_WRITE},    {9, &c->sh[2], GL_READ_WRITE},     {10, &c->bent, GL_READ_WRITE}};
    return pass_run(c, "edges", defines, NULL, 0, bindings, 9, false, e);
}
