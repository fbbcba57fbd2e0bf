#include "pipeline/read_back.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "exr/write.h"

enum { BAND = 1 << 17 }; // floats read at a time: what follows finds them in the cache

// A layer never holds NaN or infinity, whatever happened before; occlusion stays in 0..1 and light is not negative.
static inline float sane(float v, bool share, bool light)
{
    if (!(fabsf(v) <= 3e38f)) v = share ? 1.0f : isnan(v) ? 0.0f : copysignf(3e38f, v);
    if (share) return v < 0.0f ? 0.0f : v > 1.0f ? 1.0f : v;
    return light && v < 0.0f ? 0.0f : v;
}

// Leaves the first `channels` of every `stored` components, in place.
static void sanitise(layer_id l, float *v, size_t pixels, size_t stored, size_t channels)
{
    bool share = l == LAYER_OCCLUSION || l == LAYER_VISIBILITY,
         light = l == LAYER_RADIANCE || l == LAYER_INDIRECT || l == LAYER_SPECULAR || l == LAYER_ERROR;
    float *to = v;
    for (size_t i = 0; i < pixels; i++, v += stored)
        for (size_t k = 0; k < channels; k++) *to++ = sane(v[k], share, light);
}

// Bent normals: unit length, in the space of the file's normals. Where nothing is open the normal stands in.
static void point_along(const gbuffer *gb, size_t first, float *v, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++) {
        float *w = v + 3 * i;
        const float *n = gb->normal + 4 * (first + i);
        vec3 d = v3((double)w[0], (double)w[1], (double)w[2]);
        if (v3_length(d) < 1e-4) d = v3((double)n[0], (double)n[1], (double)n[2]);
        d = v3_normalize(m3_apply(gb->normal_from_camera, d));
        w[0] = (float)d.x, w[1] = (float)d.y, w[2] = (float)d.z;
    }
}

// Some rows of a layer; `joined` is the room where the seven coefficients of sh_3, which lie in two images, come together.
typedef struct band {
    int y, rows;
    size_t first, pixels;
    float *v, *joined;
} band;

static size_t components(const gpu_image *image) { return image->format == GL_R32F ? 1 : 4; }

// Leaves the layer's own channels, interleaved, in *v.
static void fetch(gpu *g, const gpu_image *image, layer_id l, const gbuffer *gb, const band *b, float **v)
{
    size_t stored = components(image), channels = strlen(layer_table[l].channels);
    gpu_image_download_rows(g, image, b->y, b->rows, b->v);
    *v = b->v;
    if (l == LAYER_SH_3) {
        float *second = b->v + 4 * b->pixels;
        gpu_image_download_rows(g, image + 1, b->y, b->rows, second);
        for (size_t i = 0; i < b->pixels; i++) {
            memcpy(b->joined + 8 * i, b->v + 4 * i, 4 * sizeof *second);
            memcpy(b->joined + 8 * i + 4, second + 4 * i, 4 * sizeof *second);
        }
        *v = b->joined;
        stored = 8;
    }
    sanitise(l, *v, b->pixels, stored, channels);
    if (l == LAYER_BENT) point_along(gb, b->first, *v, b->pixels);
}

static size_t put(const float *v, size_t stride, size_t n, sample_type type, void *to, size_t first)
{
    if (type == SAMPLE_HALF) return exr_to_half(v, stride, n, (uint16_t *)to + first);
    for (size_t i = 0; i < n; i++) ((float *)to)[first + i] = v[i * stride];
    return 0;
}

// A picture that stands beside a float beauty keeps its precision, so that an untouched beauty comes back bit for bit.
static sample_type type_of(const job *j, const frame_result *r, layer_id l)
{
    if (j->o->output_float) return SAMPLE_FLOAT;
    channel_ref beauty = r->resolution.channels[ROLE_BEAUTY][0];
    if (l == LAYER_COMPOSITE && !r->plan.relight && r->resolution.components[ROLE_BEAUTY] > 0)
        return r->file->parts[beauty.part].channels[beauty.channel].type;
    return SAMPLE_HALF;
}

static bool make_room(const job *j, layer_id l, frame_result *r, error *e)
{
    size_t pixels = (size_t)r->gb.width * (size_t)r->gb.height, channels = strlen(layer_table[l].channels);
    r->types[l] = type_of(j, r, l);
    for (size_t k = 0; k < channels; k++)
        if (!r->samples[l][k] && !(r->samples[l][k] = mem_pixels(pixels, sample_size(r->types[l]), e))) return false;
    return j->no_floats || (r->layers[l] = mem_pixels(pixels * channels, sizeof(float), e));
}

static bool read_layer(const job *j, gpu *g, const gpu_image *image, layer_id l, frame_result *r, error *e)
{
    size_t width = (size_t)r->gb.width, channels = strlen(layer_table[l].channels);
    int most = (int)(BAND / (8 * width)) + 1;
    band b = {.v = mem_pixels(8 * width * (size_t)most, sizeof(float), e)};
    bool ok = b.v && make_room(j, l, r, e);
    if (ok && l == LAYER_SH_3) ok = (b.joined = mem_pixels(8 * width * (size_t)most, sizeof(float), e)) != NULL;
    for (; ok && b.y < r->gb.height; b.y += b.rows) {
        float *v;
        b.rows = r->gb.height - b.y < most ? r->gb.height - b.y : most;
        b.first = (size_t)b.y * width, b.pixels = (size_t)b.rows * width;
        fetch(g, image, l, &r->gb, &b, &v);
        if (r->layers[l]) memcpy(r->layers[l] + channels * b.first, v, channels * b.pixels * sizeof *v);
        for (size_t k = 0; k < channels; k++)
            r->clamped += put(v + k, channels, b.pixels, r->types[l], r->samples[l][k], b.first);
    }
    free(b.v);
    free(b.joined);
    return ok;
}

bool read_back(const job *j, const pass_context *c, frame_result *r, error *e)
{
    const gpu_image *images[LAYER_COUNT] = {
        [LAYER_OCCLUSION] = &c->occlusion,
        [LAYER_RADIANCE] = &c->radiance,
        [LAYER_INDIRECT] = &c->indirect,
        [LAYER_COMPOSITE] = &c->composite,
        [LAYER_VISIBILITY] = c->visibility.id ? &c->visibility : &c->occlusion,
        [LAYER_SPECULAR] = &c->specular,
        [LAYER_DIFFUSE] = &c->diffuse,
        [LAYER_DEPTHMASK] = &c->depthmask,
        [LAYER_BENT] = &c->bent,
        [LAYER_SH_0] = &c->sh[0],
        [LAYER_SH_1] = &c->sh[1],
        [LAYER_SH_2] = &c->sh[2],
        [LAYER_SH_3] = &c->sh[3],
        [LAYER_ERROR] = &c->error,
    };
    for (int i = 0; i < LAYER_COUNT; i++)
        if (r->plan.layers & 1u << i && !read_layer(j, c->g, images[i], (layer_id)i, r, e)) return false;
    return true;
}
