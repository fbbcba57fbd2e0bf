#include <string.h>

#include "passes/params.h"
#include "passes/pass.h"
#include "passes/variants.h"

// A surface may bend by this many pixel footprints off the centre's tangent plane before its taps lose weight.
static const float SHARPNESS = 1.0f;

// The filtered image replaces the unfiltered one; the other becomes scratch for the next direction.
static void swap(gpu_image *a, gpu_image *b)
{
    gpu_image t = *a;
    *a = *b;
    *b = t;
}

bool pass_blur(pass_context *c, int radius, gpu_image *scalar0, gpu_image *scalar1, gpu_image *colour0, error *e)
{
    gpu_image t0 = {0}, t1 = {0}, t2 = {0};
    gpu_image *s0 = scalar0 && scalar0->id ? scalar0 : NULL, *s1 = scalar1 && scalar1->id ? scalar1 : NULL;
    gpu_image *col = colour0 && colour0->id ? colour0 : NULL;
    if (!s0 && s1) s0 = s1, s1 = NULL;
    variant v = {{0}};
    variant_number(&v, "SCALARS", (s0 != NULL) + (s1 != NULL));
    variant_number(&v, "COLOURS", col != NULL);
    bool ok = (!s0 || pass_make(c, &t0, GL_R32F, 1.0f, e)) && (!s1 || pass_make(c, &t1, GL_R32F, 1.0f, e)) &&
              (!col || pass_make(c, &t2, GL_RGBA32F, 0.0f, e));
    for (int direction = 0; ok && direction < 2; direction++) {
        const blur_params params = {.step = {direction == 0, direction == 1}, .radius = radius, .sharpness = SHARPNESS};
        const pass_call call = {
            .program = "blur",
            .variant = v.words,
            PASS_PARAMS(params),
            .reads = {{"scalar0_in", s0}, {"scalar1_in", s1}, {"colour0_in", col}},
            .writes = {{"scalar0_out", &t0}, {"scalar1_out", &t1}, {"colour0_out", &t2}},
        };
        ok = pass_run(c, &call, e);
        if (s0) swap(s0, &t0);
        if (s1) swap(s1, &t1);
        if (col) swap(col, &t2);
    }
    gpu_image_free(&t0);
    gpu_image_free(&t1);
    gpu_image_free(&t2);
    return ok;
}

// One direction of the filter; the variant tells which and what it leaves.
static bool denoise(pass_context *c, const pass_denoising *d, const char *words, error *e)
{
    const denoise_params params = {.radius = c->set.blur, .sharpness = SHARPNESS};
    const bool across = strcmp(words, "ACROSS") == 0;
    const pass_call call = {
        .program = "denoise",
        .variant = words,
        .tiles = d->tiles,
        PASS_PARAMS(params),
        .reads = {{"estimate_image", &c->image[IMAGE_OCCLUSION]},
                  {"half_difference_image", &c->image[IMAGE_HALF_DIFFERENCE]},
                  {"moments_image", across ? NULL : d->moments}},
        .writes = {{"moments_out", across ? d->moments : NULL}, {"result_out", d->result}, {"error_out", d->square}},
    };
    return pass_run(c, &call, e);
}

bool pass_denoise_across(pass_context *c, const pass_denoising *d, error *e) { return denoise(c, d, "ACROSS", e); }

bool pass_denoise_down(pass_context *c, const pass_denoising *d, error *e) { return denoise(c, d, d->square ? "ERRORS" : "", e); }

bool pass_denoise(pass_context *c, error *e)
{
    gpu_image moments = {0}, result = {0};
    const pass_denoising d = {.moments = &moments, .result = &result};
    bool ok = pass_make(c, &moments, GL_RGBA32F, 0.0f, e) && pass_make(c, &result, GL_R32F, 1.0f, e) &&
              pass_denoise_across(c, &d, e) && pass_denoise_down(c, &d, e);
    if (ok) swap(&c->image[IMAGE_OCCLUSION], &result);
    gpu_image_free(&moments);
    gpu_image_free(&result);
    return ok;
}
