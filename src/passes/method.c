#include "passes/method.h"

#include <string.h>

const method methods[] = {
    {
        .name = "ssdo",
        .summary = "screen-space directional occlusion (Ritschel, Grosch, Seidel 2009): a point on each hemisphere direction",
        .weighting = "cosine",
        .reach = "points up to the radius",
        .blind = "thin and near blockers between the points; whatever the camera does not see",
        .samples = 64,
        .blur = 4,
        .thickness = 2.0,
        .fills_radiance = true,
        .bounce = "ssdo",
        .run = pass_ssdo,
    },
    {
        .name = "alchemy",
        .summary = "Alchemy obscurance (McGuire et al. 2011): taps on a disc, no visibility test",
        .weighting = "obscurance: cosine over distance, near blockers count more",
        .reach = "surfaces within the radius",
        .blind = "direction: light is SH irradiance times occlusion; whatever the camera does not see",
        .samples = 32,
        .blur = 4,
        .thickness = 0.0,
        .fills_radiance = false,
        .bounce = NULL,
        .run = pass_alchemy,
    },
    {0},
};

const method *method_find(const char *name)
{
    for (const method *m = methods; m->name; m++)
        if (strcmp(m->name, name) == 0) return m;
    return NULL;
}

const char *method_names(void) { return "ssdo, alchemy"; }
