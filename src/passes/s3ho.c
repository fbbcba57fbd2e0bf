#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "light/sh.h"
#include "passes/method.h"
#include "passes/params.h"

static const double Y00 = 0.28209479177387814;

// Images of the vector: three for l <= 2, five for l <= 3.
static int images(const pass_context *c) { return c->set.sh_bands == 3 ? SH_IMAGES : 3; }
static const char *bands(const pass_context *c) { return c->set.sh_bands == 3 ? "BANDS3" : ""; }

static void world_rows(const pass_context *c, vec4 rows[3])
{
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 3; k++) rows[r][k] = (float)c->set.world_from_camera.m[r][k];
}

static double low_pass(const pass_context *c, int l) { return exp(-0.5 * c->set.sh_sigma * c->set.sh_sigma * l * (l + 1)); }

static bool measure(pass_context *c, error *e)
{
    s3ho_params params = {.radius = (float)c->set.radius,
                          .thickness = isinf(c->set.thickness) ? 1e30f : (float)c->set.thickness,
                          .samples = c->set.samples,
                          .seed = c->set.seed,
                          .bands = {(float)low_pass(c, 0), (float)low_pass(c, 1), (float)low_pass(c, 2), (float)low_pass(c, 3)}};
    world_rows(c, params.world_from_camera);
    const pass_call call = {
        .program = "s3ho",
        .variant = bands(c),
        PASS_PARAMS(params),
        .writes = {{"sh0_image", &c->image[IMAGE_SH_0]},
                   {"sh1_image", &c->image[IMAGE_SH_1]},
                   {"sh2_image", &c->image[IMAGE_SH_2]},
                   {"sh3_image", &c->image[IMAGE_SH_3]},
                   {"sh4_image", &c->image[IMAGE_SH_4]}},
    };
    return pass_run(c, &call, e);
}

static bool gather_pattern(pass_context *c, error *e)
{
    gpu_image t[SH_IMAGES] = {{0}};
    bool ok = true;
    for (int k = 0; ok && k < images(c); k++) ok = pass_make(c, &t[k], GL_RGBA32F, 0.0f, e);
    const pass_call call = {
        .program = "s3ho_filter",
        .variant = bands(c),
        .reads = {{"sh0_in", &c->image[IMAGE_SH_0]},
                  {"sh1_in", &c->image[IMAGE_SH_1]},
                  {"sh2_in", &c->image[IMAGE_SH_2]},
                  {"sh3_in", &c->image[IMAGE_SH_3]},
                  {"sh4_in", &c->image[IMAGE_SH_4]}},
        .writes = {{"sh0_out", &t[0]}, {"sh1_out", &t[1]}, {"sh2_out", &t[2]}, {"sh3_out", &t[3]}, {"sh4_out", &t[4]}},
    };
    ok = ok && pass_run(c, &call, e);
    for (int k = 0; k < images(c); k++) {
        gpu_image_free(&c->image[IMAGE_SH_0 + k]);
        c->image[IMAGE_SH_0 + k] = t[k];
    }
    return ok;
}

// The vector a file brought along; the open share is its first coefficient.
static bool upload_relight(pass_context *c, error *e)
{
    size_t n = (size_t)c->width * (size_t)c->height;
    float *v = mem_pixels(4 * n, sizeof *v, e);
    if (!v) return false;
    for (int k = 0; k < images(c); k++) {
        memcpy(v, c->relight_sh[k], 4 * n * sizeof *v);
        for (size_t i = 0; k == 0 && i < n; i++) v[4 * i + 3] = (float)((double)v[4 * i] / (M_PI * Y00));
        gpu_image_upload(c->g, &c->image[IMAGE_SH_0 + k], 0, v);
    }
    free(v);
    return true;
}

static bool light(pass_context *c, error *e)
{
    static const double a[3] = {M_PI, 2.0 * M_PI / 3.0, M_PI / 4.0};
    s3ho_light_params params = {0};
    world_rows(c, params.world_from_camera);
    for (int l = 0; l < 3; l++) params.bands[l] = (float)(a[l] * low_pass(c, l));
    double in_world[SH_MAX][3] = {{0}};
    const int count = c->set.sh_bands == 3 ? 16 : 9;
    if (c->env) sh_turn(c->env->sh, c->env->map_from_world, c->set.sh_bands == 3 ? 4 : 3, in_world);
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) params.light[i][k] = (float)in_world[i][k];
        if (c->env) log_info(c->log, "environment L_%d: %.6g %.6g %.6g", i, in_world[i][0], in_world[i][1], in_world[i][2]);
    }
    variant v = {{0}};
    variant_add(&v, c->set.sh_bands == 3, "BANDS3");
    variant_add(&v, c->want_radiance, "LIGHT");
    variant_add(&v, c->want_visibility, "VISIBILITY");
    const pass_call call = {
        .program = "s3ho_light",
        .variant = v.words,
        PASS_PARAMS(params),
        .reads = {{"sh0_image", &c->image[IMAGE_SH_0]},
                  {"sh1_image", &c->image[IMAGE_SH_1]},
                  {"sh2_image", &c->image[IMAGE_SH_2]},
                  {"sh3_image", &c->image[IMAGE_SH_3]},
                  {"sh4_image", &c->image[IMAGE_SH_4]}},
        .writes = {{"occlusion_image", &c->image[IMAGE_OCCLUSION]},
                   {"radiance_image", &c->image[IMAGE_RADIANCE]},
                   {"visibility_image", &c->image[IMAGE_VISIBILITY]}},
    };
    return pass_run(c, &call, e);
}

static bool run(pass_context *c, error *e)
{
    for (int k = 0; k < images(c); k++)
        if (!pass_make_image(c, (image_id)(IMAGE_SH_0 + k), e)) return false;
    if (!pass_make_image(c, IMAGE_OCCLUSION, e)) return false;
    if (c->want_radiance && !pass_make_image(c, IMAGE_RADIANCE, e)) return false;
    if (c->want_visibility && !pass_make_image(c, IMAGE_VISIBILITY, e)) return false;
    if (c->relight_sh[0]) {
        if (!upload_relight(c, e)) return false;
    } else if (!measure(c, e) || (c->set.blur > 0 && !gather_pattern(c, e))) {
        return false;
    }
    return light(c, e);
}

static const variant_row variants[] = {
    {.program = "s3ho", .pattern = "[BANDS3]"},
    {.program = "s3ho_filter", .pattern = "[BANDS3]"},
    {.program = "s3ho_light", .pattern = "[BANDS3] [LIGHT] [VISIBILITY]"},
    {0},
};

const method method_s3ho = {
    .name = "s3ho",
    .summary = "spherical harmonics of the visibility, relit by a dot product (Herholz et al. 2011)",
    .weighting = "cosine",
    .reaches = "points within the radius, as ssdo",
    .blind = "sharp shadows: nine coefficients hold soft ones only; the rest as ssdo",
    .light = "spherical harmonics, relit later from stored layers",
    .choose = "when the light will still change",
    .options = "thickness sh-bands sh-sigma",
    .samples = 32,
    .blur = 2,
    .thickness = 2.0,
    .makes = MAKES_LIGHT | MAKES_SH,
    .source = SEES_PICTURE,
    .weight = WEIGHS_COSINE,
    .reach = REACH_POINTS,
    .variants = variants,
    .run = run,
};
