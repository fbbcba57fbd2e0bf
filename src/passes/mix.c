#include <stdlib.h>

#include "base/mem.h"
#include "passes/pass.h"
#include "passes/variants.h"

// As shaders/mix.comp has it.
typedef struct mix_item {
    uint32_t pixel, beside;
    uint16_t share, light[3];
} mix_item;
_Static_assert(sizeof(mix_item) == 16, "the shader reads four numbers of 32 bits");

static uint16_t coded(float share) { return (uint16_t)(65535.0f * share + 0.5f); }

// Of what the pixel's mean albedo reflects, the neighbour's part; without albedo, or where it is black, its part of the pixel.
static float share_of_light(const gbuffer *g, const mixed_pixel *m, size_t own, size_t beside, int colour)
{
    if (!g->albedo) return m->share;
    float mean = g->albedo[4 * own + (size_t)colour], part = m->share * g->albedo[4 * beside + (size_t)colour];
    return part < mean ? part / mean : mean > 0.0f ? 1.0f : m->share;
}

static mix_item *make_items(const gbuffer *g, error *e)
{
    mix_item *items = mem_pixels(g->mixed_count, sizeof *items, e);
    for (size_t i = 0; items && i < g->mixed_count; i++) {
        const mixed_pixel *m = &g->mixed[i];
        const uint32_t x = m->pixel & 0xffff, y = m->pixel >> 16;
        const uint32_t u = (uint32_t)((int)x + m->x), v = (uint32_t)((int)y + m->y);
        const size_t width = (size_t)g->width, own = y * width + x, beside = v * width + u;
        items[i] = (mix_item){.pixel = m->pixel, .beside = u | v << 16, .share = coded(m->share)};
        for (int c = 0; c < 3; c++) items[i].light[c] = coded(share_of_light(g, m, own, beside, c));
    }
    return items;
}

static bool mix(pass_context *c, const gpu_buffer *items, const gpu_buffer *means, image_id id, error *e)
{
    const bool colour = image_table[id].format != GL_R32F, light = id == IMAGE_RADIANCE || id == IMAGE_INDIRECT;
    for (int scatter = 0; scatter < 2; scatter++) {
        variant v = {{0}};
        variant_add(&v, colour, "COLOUR");
        variant_add(&v, light && !scatter, "LIGHT");
        variant_add(&v, scatter, "SCATTER");
        pass_call call = {.program = "mix",
                          .variant = v.words,
                          .writes = {{"value_image", &c->image[id]}},
                          .buffers = {{"Mixed", items}, {"Means", means}}};
        if (!pass_run_list(c, c->gb->mixed_count, call, e)) return false;
    }
    return true;
}

image_set pass_mix_takes(image_set there)
{
    image_set taken = IMAGE_BIT(IMAGE_ERROR);
    for (int i = 0; i < IMAGE_COUNT; i++)
        if (image_table[i].groups & IMAGE_FILLED) taken |= IMAGE_BIT(i);
    return taken & there;
}

bool pass_mix(pass_context *c, error *e)
{
    const size_t count = c->gb->mixed_count;
    gpu_buffer items = {0}, means = {0};
    pass_timing clock = pass_clock(c, "mix");
    mix_item *list = make_items(c->gb, e);
    bool ok = list && gpu_buffer_make(c->g, &items, list, count * sizeof *list, "mixed pixels", e) &&
              gpu_buffer_make(c->g, &means, NULL, count * 4 * sizeof(float), "mixed pixels", e);
    for (int i = 0; ok && i < IMAGE_COUNT; i++)
        if (pass_mix_takes(IMAGE_BIT(i)) && c->image[i].id) ok = mix(c, &items, &means, (image_id)i, e);
    ok = ok && (!c->timing || gpu_finish(c->g, "mix", e));
    pass_clock_stop(c, clock);
    gpu_buffer_free(&items);
    gpu_buffer_free(&means);
    free(list);
    return ok;
}
