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

enum { KIND = 2, PLACES = 2 * KIND }; // scalars, then colours

// The images that are there, each kind from its first place on; how many of each kind.
static void gather(const pass_blurring *b, gpu_image *found[PLACES], int count[2])
{
    for (int i = 0; i < PLACES; i++) {
        int kind = i / KIND;
        gpu_image *image = kind == 0 ? b->scalars[i] : b->colours[i - KIND];
        if (image && image->id) found[kind * KIND + count[kind]++] = image;
    }
}

bool pass_blur(pass_context *c, const pass_blurring *b, error *e)
{
    static const char *const in[] = {"scalar0_in", "scalar1_in", "colour0_in", "colour1_in"}, *const out[] = {
                                                                                                  "scalar0_out", "scalar1_out",
                                                                                                  "colour0_out", "colour1_out"};
    gpu_image *image[PLACES] = {NULL}, scratch[PLACES] = {{0}};
    int count[2] = {0};
    gather(b, image, count);
    variant v = {{0}};
    variant_number(&v, "SCALARS", count[0]);
    variant_number(&v, "COLOURS", count[1]);
    variant_add(&v, b->fitted, "FITTED");
    bool ok = true;
    for (int i = 0; ok && i < PLACES; i++)
        ok = !image[i] || pass_make(c, &scratch[i], i < KIND ? GL_R32F : GL_RGBA32F, i < KIND ? 1.0f : 0.0f, e);
    for (int direction = 0; ok && direction < 2; direction++) {
        const blur_params params = {.step = {direction == 0, direction == 1}, .radius = b->radius, .sharpness = SHARPNESS};
        pass_call call = {.program = "blur", .variant = v.words, PASS_PARAMS(params)};
        for (int i = 0, n = 0; i < PLACES; i++) {
            if (!image[i]) continue;
            call.reads[n] = (pass_picture){in[i], image[i]};
            call.writes[n++] = (pass_picture){out[i], &scratch[i]};
        }
        ok = pass_run(c, &call, e);
        for (int i = 0; i < PLACES; i++)
            if (image[i]) swap(image[i], &scratch[i]);
    }
    for (int i = 0; i < PLACES; i++) gpu_image_free(&scratch[i]);
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
