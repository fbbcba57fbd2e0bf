#include <stdio.h>

#include "passes/pass.h"

// A surface may bend by this many footprints of a small pixel off the pixel's tangent plane before a tap loses weight.
static const float SHARPNESS = 0.5f;

// Layers on their way; those of a draw share the weights of the taps.
typedef struct draw {
    const gpu_image *from[4]; // two scalars, two of four components; NULL: none
    gpu_image *to[4];
    bool open_light; // the first of four components is radiance
} draw;

static bool bring(pass_context *c, const pass_context *small, const draw *d, error *e)
{
    struct {
        int size[2];
        float sharpness;
        int unused;
        float light[9][4];
    } params = {.size = {small->width, small->height}, .sharpness = SHARPNESS};
    for (int i = 0; d->open_light && i < 9; i++)
        for (int k = 0; k < 3; k++) params.light[i][k] = (float)(small->suns_apart ? c->sunless->rest[i][k] : c->env->sh[i][k]);
    pass_binding bindings[6] = {{2, &small->depth, GL_READ_ONLY}, {3, &small->normal, GL_READ_ONLY}};
    char defines[64];
    int count = 2;
    for (int k = 0; k < 4; k++) {
        if (!d->from[k]) continue;
        if (!pass_make(c, d->to[k], k < 2 ? GL_R32F : GL_RGBA32F, k < 2 ? 1.0f : 0.0f, e)) return false;
        bindings[count++] = (pass_binding){4 + k, d->from[k], GL_READ_ONLY};
    }
    snprintf(defines, sizeof defines, "SCALARS %d\nCOLOURS %d\n%s", (d->from[0] != NULL) + (d->from[1] != NULL),
             (d->from[2] != NULL) + (d->from[3] != NULL), d->open_light ? "OPEN_LIGHT 1\n" : "");
    const gpu_image *targets[4];
    for (int k = 0; k < 4; k++) targets[k] = d->from[k] ? d->to[k] : NULL;
    return pass_draw(c, "upsample", defines, &params, sizeof params, bindings, count, targets, 4, false, e);
}

bool pass_upsample(pass_context *c, const pass_context *small, error *e)
{
    const gpu_image *from[3 + SH_IMAGES] = {&small->radiance, &small->indirect, &small->bent};
    gpu_image *to[3 + SH_IMAGES] = {&c->radiance, &c->indirect, &c->bent};
    draw d = {{&small->occlusion, small->visibility.id ? &small->visibility : NULL}, {&c->occlusion, &c->visibility}, false};
    bool waiting = true; // the scalars go with the first
    c->suns_apart = small->suns_apart;
    for (int k = 0; k < SH_IMAGES; k++) from[3 + k] = &small->sh[k], to[3 + k] = &c->sh[k];
    for (int k = 0, n = 2; k < 3 + SH_IMAGES || waiting; k++) {
        if (k < 3 + SH_IMAGES && from[k]->id && !to[k]->id) {
            d.open_light |= k == 0;
            d.from[n] = from[k], d.to[n++] = to[k];
        }
        if (n < 4 && k < 2 + SH_IMAGES) continue;
        if ((n > 2 || waiting) && !bring(c, small, &d, e)) return false;
        d = (draw){0};
        n = 2, waiting = false;
    }
    return true;
}

bool pass_upsample_indirect(pass_context *c, const pass_context *small, error *e)
{
    const draw d = {{NULL, NULL, &small->indirect}, {NULL, NULL, &c->indirect}, false};
    return bring(c, small, &d, e);
}
