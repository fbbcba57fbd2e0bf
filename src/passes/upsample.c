#include "passes/params.h"
#include "passes/pass.h"
#include "passes/variants.h"

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
    upsample_params params = {.small_size = {small->width, small->height}, .sharpness = SHARPNESS};
    for (int i = 0; d->open_light && i < 9; i++)
        for (int k = 0; k < 3; k++) params.light[i][k] = (float)(small->suns_apart ? c->sunless->rest[i][k] : c->env->sh[i][k]);
    for (int k = 0; k < 4; k++)
        if (d->from[k] && !pass_make(c, d->to[k], k < 2 ? GL_R32F : GL_RGBA32F, k < 2 ? 1.0f : 0.0f, e)) return false;
    variant v = {{0}};
    variant_number(&v, "SCALARS", (d->from[0] != NULL) + (d->from[1] != NULL));
    variant_number(&v, "COLOURS", (d->from[2] != NULL) + (d->from[3] != NULL));
    variant_add(&v, d->open_light, "OPEN_LIGHT");
    const pass_call call = {
        .program = "upsample",
        .variant = v.words,
        PASS_PARAMS(params),
        .reads = {{"small_depth", &small->depth},
                  {"small_normal", &small->normal},
                  {"scalar0_in", d->from[0]},
                  {"scalar1_in", d->from[1]},
                  {"colour0_in", d->from[2]},
                  {"colour1_in", d->from[3]}},
        .writes = {{"scalar0_out", d->to[0]}, {"scalar1_out", d->to[1]}, {"colour0_out", d->to[2]}, {"colour1_out", d->to[3]}},
    };
    return pass_run(c, &call, e);
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
