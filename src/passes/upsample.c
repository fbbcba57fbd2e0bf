#include <stdio.h>

#include "passes/pass.h"

// A surface may bend by this many footprints of a small pixel off the pixel's tangent plane before a tap loses weight.
static const float SHARPNESS = 0.5f;

static bool bring(pass_context *c, const pass_context *small, const gpu_image *from[3], gpu_image *to[3], error *e)
{
    struct {
        int size[2];
        float sharpness;
        int unused;
    } params = {{small->width, small->height}, SHARPNESS, 0};
    gpu_image none = {0};
    char defines[64];
    snprintf(defines, sizeof defines, "SCALARS %d\nCOLOURS %d\n%s", (from[0] != NULL) + (from[1] != NULL), from[2] != NULL,
             from[0] ? "OPEN_LIGHT 1\n" : "");
    for (int k = 0; k < 3; k++)
        if (from[k] && !pass_make(c, to[k], k < 2 ? GL_R32F : GL_RGBA32F, k < 2 ? 1.0f : 0.0f, e)) return false;
    const pass_binding bindings[] = {
        {2, &small->depth, GL_READ_ONLY},
        {3, &small->normal, GL_READ_ONLY},
        {4, from[0] ? from[0] : &none, GL_READ_ONLY},
        {5, from[0] ? to[0] : &none, GL_WRITE_ONLY},
        {6, from[1] ? from[1] : &none, GL_READ_ONLY},
        {7, from[1] ? to[1] : &none, GL_WRITE_ONLY},
        {8, from[2] ? from[2] : &none, GL_READ_ONLY},
        {9, from[2] ? to[2] : &none, GL_WRITE_ONLY},
    };
    return pass_run(c, "upsample", defines, &params, sizeof params, bindings, 8, false, e);
}

bool pass_upsample(pass_context *c, const pass_context *small, error *e)
{
    const gpu_image *from[3] = {&small->occlusion, small->visibility.id ? &small->visibility : NULL,
                                small->radiance.id ? &small->radiance : NULL};
    gpu_image *to[3] = {&c->occlusion, &c->visibility, &c->radiance};
    if (!bring(c, small, from, to, e)) return false;
    if (small->bent.id && !pass_upsample_colour(c, small, &small->bent, &c->bent, e)) return false;
    for (int k = 0; k < SH_IMAGES; k++)
        if (small->sh[k].id && !pass_upsample_colour(c, small, &small->sh[k], &c->sh[k], e)) return false;
    return true;
}

bool pass_upsample_colour(pass_context *c, const pass_context *small, const gpu_image *from, gpu_image *to, error *e)
{
    const gpu_image *list[3] = {NULL, NULL, from};
    gpu_image *targets[3] = {NULL, NULL, to};
    return bring(c, small, list, targets, e);
}
