#include "passes/pass.h"

#include <stdio.h>

// A surface may bend by this many pixel footprints off the centre's tangent plane before its taps lose weight.
static const float SHARPNESS = 1.0f;

// The filtered image replaces the unfiltered one; the other becomes scratch for the next direction.
static void swap(gpu_image *a, gpu_image *b)
{
    gpu_image t = *a;
    *a = *b;
    *b = t;
}

bool pass_blur(pass_context *c, gpu_image *scalar0, gpu_image *scalar1, gpu_image *colour0, error *e)
{
    gpu_image none = {0}, t0 = {0}, t1 = {0}, t2 = {0};
    gpu_image *s0 = scalar0 && scalar0->id ? scalar0 : NULL, *s1 = scalar1 && scalar1->id ? scalar1 : NULL;
    gpu_image *col = colour0 && colour0->id ? colour0 : NULL;
    if (!s0 && s1) s0 = s1, s1 = NULL;
    char defines[64];
    snprintf(defines, sizeof defines, "SCALARS %d\nCOLOURS %d\n", (s0 != NULL) + (s1 != NULL), col != NULL);
    bool ok = (!s0 || pass_make(c, &t0, GL_R32F, 1.0f, e)) && (!s1 || pass_make(c, &t1, GL_R32F, 1.0f, e)) &&
              (!col || pass_make(c, &t2, GL_RGBA32F, 0.0f, e));
    for (int direction = 0; ok && direction < 2; direction++) {
        struct {
            int step[2], radius;
            float sharpness;
        } params = {{direction == 0, direction == 1}, c->set.blur, SHARPNESS};
        const pass_binding bindings[] = {
            {2, s0 ? s0 : &none, GL_READ_ONLY}, {4, s1 ? s1 : &none, GL_READ_ONLY}, {6, col ? col : &none, GL_READ_ONLY}};
        const gpu_image *targets[] = {s0 ? &t0 : NULL, s1 ? &t1 : NULL, col ? &t2 : NULL};
        ok = pass_draw(c, "blur", defines, &params, sizeof params, bindings, 3, targets, 3, false, e);
        if (s0) swap(s0, &t0);
        if (s1) swap(s1, &t1);
        if (col) swap(col, &t2);
    }
    gpu_image_free(&t0);
    gpu_image_free(&t1);
    gpu_image_free(&t2);
    return ok;
}

typedef struct denoise_params {
    int radius;
    float sharpness;
} denoise_params;

bool pass_denoise_across(pass_context *c, const pass_denoising *d, error *e)
{
    const denoise_params params = {c->set.blur, SHARPNESS};
    const pass_binding bindings[] = {{2, &c->occlusion, GL_READ_ONLY}, {3, &c->change, GL_READ_ONLY}};
    const gpu_image *targets[] = {d->moments};
    return pass_draw(c, "denoise", "ACROSS 1\n", &params, sizeof params, bindings, 2, targets, 1, false, e);
}

bool pass_denoise_down(pass_context *c, const pass_denoising *d, error *e)
{
    const denoise_params params = {c->set.blur, SHARPNESS};
    const pass_binding bindings[] = {
        {2, &c->occlusion, GL_READ_ONLY}, {3, &c->change, GL_READ_ONLY}, {4, d->moments, GL_READ_ONLY}};
    const gpu_image *targets[] = {d->result, d->square};
    return pass_draw(c, "denoise", d->square ? "ERRORS 1\n" : NULL, &params, sizeof params, bindings, 3, targets, 2, false, e);
}

bool pass_denoise(pass_context *c, error *e)
{
    gpu_image moments = {0}, result = {0};
    const pass_denoising d = {&moments, &result, NULL};
    bool ok = pass_make(c, &moments, GL_RGBA32F, 0.0f, e) && pass_make(c, &result, GL_R32F, 1.0f, e) &&
              pass_denoise_across(c, &d, e) && pass_denoise_down(c, &d, e);
    if (ok) swap(&c->occlusion, &result);
    c->denoised = ok;
    gpu_image_free(&moments);
    gpu_image_free(&result);
    return ok;
}
