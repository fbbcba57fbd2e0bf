#include "passes/vpl.h"

#include <stdlib.h>

#include "base/mem.h"
#include "passes/method.h"
#include "passes/params.h"

// A surface seen at less than 3 degrees is treated as seen at 3. Otherwise rounding of the normal would decide its area.
static const double GRAZING = 0.05;

static double pixel_area(const gbuffer *gb, size_t i)
{
    const camera *c = &gb->camera;
    double z = (double)gb->depth[i], x = (double)(i % (size_t)gb->width) + 0.5, y = (double)(i / (size_t)gb->width) + 0.5;
    vec3 n = v3((double)gb->normal[4 * i], (double)gb->normal[4 * i + 1], (double)gb->normal[4 * i + 2]);
    if (c->kind == CAMERA_ORTHOGRAPHIC) return 1.0 / (c->fx * c->fy * fmax(fabs(n.z), GRAZING));
    vec3 ray = v3((x - c->cx) / c->fx, (y - c->cy) / c->fy, 1.0);
    return z * z / (c->fx * c->fy * fmax(fabs(v3_dot(n, ray)), GRAZING * v3_length(ray)));
}

// A ground that reaches the horizon can hold most of the scene's area, but its far part lights nothing in the picture. So the
// density of lights falls with the square of the distance. Far lights are fewer and larger, and send the same light in all.
static double nearness(const gbuffer *gb, size_t i)
{
    double depths = gb->extent > 0.0 ? (double)gb->depth[i] / gb->extent : 0.0;
    return 1.0 / (1.0 + depths * depths);
}

static void sent_from(const float *light, const float *albedo, size_t i, double out[3])
{
    for (size_t k = 0; k < 3; k++) {
        double v = (double)light[4 * i + k] * (albedo ? (double)albedo[4 * i + k] : 1.0);
        out[k] = v > 0.0 && isfinite(v) ? v : 0.0;
    }
}

// Every second bit of a Morton code.
static unsigned even_bits(unsigned long code)
{
    unsigned v = 0;
    for (int b = 0; b < 16; b++) v |= (unsigned)(code >> (2 * b) & 1u) << b;
    return v;
}

typedef struct walk {
    const gbuffer *gb;
    const float *light, *albedo;
    unsigned long code, end;
} walk;

static walk walk_over(const gbuffer *gb, const float *light, const float *albedo)
{
    unsigned long side = 1;
    while (side < (unsigned long)gb->width || side < (unsigned long)gb->height) side *= 2;
    return (walk){gb, light, albedo, 0, side * side};
}

// The next pixel with a surface, and its weight. False at the end.
static bool next(walk *w, size_t *pixel, double *weight)
{
    while (w->code < w->end) {
        unsigned x = even_bits(w->code), y = even_bits(w->code >> 1);
        w->code++;
        if (x >= (unsigned)w->gb->width || y >= (unsigned)w->gb->height) continue;
        size_t i = (size_t)y * (size_t)w->gb->width + x;
        if (w->gb->depth[i] <= 0.0f) continue;
        double sent[3];
        sent_from(w->light, w->albedo, i, sent);
        *pixel = i;
        *weight = luminance(sent[0], sent[1], sent[2]) * pixel_area(w->gb, i) * nearness(w->gb, i);
        return true;
    }
    return false;
}

int vpl_choose(const gbuffer *gb, const float *light, const float *albedo, int count, vpl *out)
{
    size_t i;
    double weight, total = 0.0, sum = 0.0;
    for (walk w = walk_over(gb, light, albedo); next(&w, &i, &weight);) total += weight;
    if (!(total > 0.0) || !isfinite(total)) return 0;
    int chosen = 0;
    for (walk w = walk_over(gb, light, albedo); chosen < count && next(&w, &i, &weight);) {
        sum += weight;
        for (; chosen < count && sum > total * (chosen + 0.5) / count; chosen++) {
            vpl *v = &out[chosen];
            sent_from(light, albedo, i, v->radiance);
            v->area = total / count / luminance(v->radiance[0], v->radiance[1], v->radiance[2]) / nearness(gb, i);
            v->position = gbuffer_position(gb, (int)(i % (size_t)gb->width), (int)(i / (size_t)gb->width));
            v->normal = v3((double)gb->normal[4 * i], (double)gb->normal[4 * i + 1], (double)gb->normal[4 * i + 2]);
        }
    }
    return chosen;
}

static bool upload(pass_context *c, const vpl *lights, int count, gpu_image *image, error *e)
{
    size_t n = (size_t)count;
    float *v = mem_zero(3 * 4 * n, sizeof *v, e);
    if (!v) return false;
    for (size_t k = 0; k < n; k++) {
        const vpl *l = &lights[k];
        const double rows[3][4] = {{l->position.x, l->position.y, l->position.z, l->area},
                                   {l->normal.x, l->normal.y, l->normal.z, 0.0},
                                   {l->radiance[0], l->radiance[1], l->radiance[2], 0.0}};
        for (size_t row = 0; row < 3; row++)
            for (size_t j = 0; j < 4; j++) v[4 * (row * n + k) + j] = (float)rows[row][j];
    }
    bool ok = gpu_image_make(c->g, image, GL_RGBA32F, count, 3, 1, e);
    if (ok) gpu_image_upload(c->g, image, 0, v);
    free(v);
    return ok;
}

// What surfaces send: a picture the renderer lit, or our own radiance, which still needs their albedo.
static bool choose(pass_context *c, vpl *lights, int *count, error *e)
{
    if (!c->set.relight) {
        *count = vpl_choose(c->gb, c->gb->beauty, NULL, c->set.vpl_count, lights);
        return true;
    }
    float *radiance = mem_pixels((size_t)c->width * (size_t)c->height * 4, sizeof *radiance, e);
    if (!radiance) return false;
    gpu_image_download(c->g, &c->image[IMAGE_RADIANCE], radiance);
    *count = vpl_choose(c->gb, radiance, c->gb->albedo, c->set.vpl_count, lights);
    free(radiance);
    return true;
}

static bool run_bounce(pass_context *c, error *e)
{
    vpl_params params = {.strength = (float)c->set.bounce_strength};
    gpu_image image = {0};
    vpl *lights = mem_zero((size_t)c->set.vpl_count, sizeof *lights, e);
    bool ok = lights && pass_make_image(c, IMAGE_INDIRECT, e) && choose(c, lights, &params.count, e);
    if (ok && params.count > 0) {
        const pass_call call = {
            .program = "vpl",
            PASS_PARAMS(params),
            .reads = {{"lights_image", &image}},
            .writes = {{"indirect_image", &c->image[IMAGE_INDIRECT]}},
        };
        ok = upload(c, lights, params.count, &image, e) && pass_run(c, &call, e);
    }
    gpu_image_free(&image);
    free(lights);
    return ok;
}

static const variant_row variants[] = {{.program = "vpl", .pattern = ""}, {0}};

const bounce_kind bounce_vpl = {
    .name = "vpl",
    .source = SEES_PICTURE,
    .march = BOUNCE_AFTER,
    .exact = true,
    .variants = variants,
    .run = run_bounce,
};
