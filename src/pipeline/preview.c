#include "pipeline/preview.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "base/mem.h"
#include "base/sort.h"
#include "light/primaries.h"
#include "pipeline/canvas.h"
#include "pipeline/settings.h"
#include "plugin/colour.h"
#include "plugin/images.h"

enum { LABEL = 24, GAP = 6, COLUMNS = 2, EXPOSURE_SAMPLES = 4096, NARROW = 320, WIDE = 960, BACKGROUND = 40 };

// From pixels to the canvas: blocks of `reduce` pixels squared become one dot, each drawn `enlarge` times as large. One of them
// is 1.
typedef struct zoom {
    int reduce, enlarge;
    int width, height; // of a cell
} zoom;

static zoom zoom_for(int width, int height)
{
    zoom z = {.reduce = (width + WIDE - 1) / WIDE, .enlarge = width < NARROW ? (NARROW + width - 1) / width : 1};
    z.width = (width + z.reduce - 1) / z.reduce * z.enlarge;
    z.height = (height + z.reduce - 1) / z.reduce * z.enlarge;
    return z;
}

static uint8_t encode(float linear)
{
    float v = linear <= 0.0f ? 0.0f : linear >= 1.0f ? 1.0f : linear;
    v = v <= 0.0031308f ? 12.92f * v : 1.055f * powf(v, 1.0f / 2.4f) - 0.055f;
    return (uint8_t)lrintf(255.0f * v);
}

static bool is_light(layer_id l)
{
    return layer_table[l]->display == DISPLAY_LIGHT || layer_table[l]->display == DISPLAY_PICTURE;
}

// Factor that puts the 95th percentile of a layer's light, over its surfaces, at 0.8; 1 for what is no light.
static float exposure(const frame_result *r, layer_id l)
{
    const float *v = r->layers[l];
    float values[EXPOSURE_SAMPLES];
    size_t n = 0, pixels = (size_t)r->gb.width * (size_t)r->gb.height, stride = r->gb.valid / EXPOSURE_SAMPLES + 1, seen = 0;
    if (!is_light(l)) return 1.0f;
    for (size_t i = 0; i < pixels && n < EXPOSURE_SAMPLES; i++)
        if (r->gb.depth[i] > 0.0f && seen++ % stride == 0) values[n++] = fmaxf(v[3 * i], fmaxf(v[3 * i + 1], v[3 * i + 2]));
    if (n == 0) return 1.0f;
    sort_floats(values, n);
    float top = values[n * 95 / 100];
    return top > 0.0f ? 0.8f / top : 1.0f;
}

// The input's own alpha: a coverage of 0 may have a picture behind it all the same.
static float alpha_at(const frame_result *r, size_t i)
{
    channel_ref ref = r->resolution.channels[ROLE_ALPHA][0];
    const exrio_channel *c = &r->file->parts[ref.part].channels[ref.channel];
    return c->type == SAMPLE_UINT ? 1.0f : sample_value(c->type, c->data, i);
}

static bool has_surface(const gbuffer *gb, size_t i) { return gb->depth[i] > 0.0f || (gb->coverage && gb->coverage[i] > 0.0f); }

// A dot of a layer: the mean over the block's pixels with a surface, all of them for the composite. False if there are none.
typedef struct dot {
    float v[3];
    float open; // composite: what is left of the background behind it
} dot;

static bool average(const frame_result *r, layer_id l, int x0, int y0, int size, dot *d)
{
    const gbuffer *gb = &r->gb;
    size_t channels = strlen(layer_table[l]->channels);
    bool picture = layer_table[l]->display == DISPLAY_PICTURE, alpha = picture && r->resolution.components[ROLE_ALPHA] > 0;
    float n = 0.0f;
    *d = (dot){0};
    for (int y = y0; y < y0 + size && y < gb->height; y++)
        for (int x = x0; x < x0 + size && x < gb->width; x++) {
            size_t i = (size_t)y * (size_t)gb->width + (size_t)x;
            if (!picture && !has_surface(gb, i)) continue;
            for (size_t k = 0; k < 3; k++) d->v[k] += r->layers[l][i * channels + (channels > k ? k : 0)];
            if (alpha) d->open += 1.0f - fminf(1.0f, fmaxf(0.0f, alpha_at(r, i)));
            n += 1.0f;
        }
    for (int k = 0; k < 3 && n > 0.0f; k++) d->v[k] /= n;
    if (n > 0.0f) d->open /= n;
    return n > 0.0f;
}

static uint8_t share(float v) { return (uint8_t)lrintf(255.0f * fminf(1.0f, fmaxf(0.0f, v))); }

// What is no light, as a code.
static uint8_t shade(const frame_result *r, layer_id l, const dot *d, int k)
{
    switch (layer_table[l]->display) {
    case DISPLAY_SIGNED:
        return share(0.5f * (d->v[k] + 1.0f));
    case DISPLAY_DARKENING:
        return share(d->v[0] + 1.0f);
    case DISPLAY_ERROR:
        return share(d->v[0] / (2.0f * (float)r->set.target_error));
    default:
        return share(d->v[0]);
    }
}

static bool has_display(const options *o) { return o->display || o->view || colour_config(o->ocio); }

bool preview_check(const options *o, error *e)
{
    float grey[3] = {0.18f, 0.18f, 0.18f};
    if (!o->preview) return true;
    return images_check_png(o->preview, e) && (!has_display(o) || colour_to_display(o->ocio, o->display, o->view, grey, 1, e));
}

// From scene-linear light to codes, in place: by the config's view, else by sRGB's curve after its primaries.
static bool develop(const options *o, const frame_result *r, float *rgb, size_t n, error *e)
{
    double xy[8];
    mat3 m;
    if (has_display(o)) return colour_to_display(o->ocio, o->display, o->view, rgb, n, e);
    bool other = exrio_attr_chromaticities(r->file, r->resolution.main_part, xy) && !primaries_equal(xy, primaries_rec709) &&
                 primaries_between(xy, primaries_rec709, &m);
    for (size_t i = 0; i < n; i++) {
        float *v = rgb + 3 * i;
        vec3 c = v3((double)v[0], (double)v[1], (double)v[2]);
        if (other) c = m3_apply(m, c);
        v[0] = (float)encode((float)c.x) / 255.0f;
        v[1] = (float)encode((float)c.y) / 255.0f;
        v[2] = (float)encode((float)c.z) / 255.0f;
    }
    return true;
}

// One cell: its dots as linear light without alpha or, for other layers, as codes already; then all of them onto the sheet.
static bool draw_layer(canvas *s, const options *o, const frame_result *r, layer_id l, int x0, int y0, const zoom *z, float gain,
                       error *e)
{
    size_t n = (size_t)z->width * (size_t)z->height;
    float *rgb = mem_pixels(n, 4 * sizeof *rgb, e), *open = rgb ? rgb + 3 * n : NULL;
    if (!rgb) return false;
    for (size_t i = 0; i < n; i++) {
        int x = (int)(i % (size_t)z->width), y = (int)(i / (size_t)z->width);
        dot d;
        bool any = average(r, l, x / z->enlarge * z->reduce, y / z->enlarge * z->reduce, z->reduce, &d);
        bool glow = d.open >= 1.0f && d.v[0] + d.v[1] + d.v[2] > 0.0f; // light without alpha is shown whole
        open[i] = !any ? 1.0f : glow ? 0.0f : d.open;
        float part = open[i] < 1.0f ? 1.0f - open[i] : 1.0f;
        for (int k = 0; k < 3; k++)
            rgb[3 * i + (size_t)k] = is_light(l) ? gain * d.v[k] / part : (float)shade(r, l, &d, k) / 255.0f;
    }
    bool ok = !is_light(l) || develop(o, r, rgb, n, e);
    // The checkerboard goes through no view: it looks the same everywhere, also in the legend.
    for (size_t i = 0; ok && i < n; i++) {
        int x = (int)(i % (size_t)z->width), y = (int)(i / (size_t)z->width);
        float checker = (float)canvas_checker(x, y) / 255.0f;
        uint8_t c[3];
        for (size_t k = 0; k < 3; k++) c[k] = share((1.0f - open[i]) * rgb[3 * i + k] + open[i] * checker);
        canvas_put(s, x0 + x, y0 + y, c);
    }
    free(rgb);
    return ok;
}

// The radius and its length in the cells; the checkerboard; what light went through. Below `y`, over `width` columns.
static void draw_legend(canvas *s, const options *o, const frame_result *r, int y, int width, const zoom *z)
{
    static const uint8_t ink[3] = {235, 235, 235};
    char text[96];
    const camera *c = &r->gb.camera;
    double pixels = r->set.radius * c->fx / (c->kind == CAMERA_ORTHOGRAPHIC ? 1.0 : frame_median_depth(&r->gb));
    int length = (int)lrint(fmin(pixels * z->enlarge / z->reduce, 1e6)), x = GAP;
    snprintf(text, sizeof text, "radius %.3g = %.0f px%s%.24s", r->set.radius, pixels, r->view ? ", view " : "",
             r->view ? r->view : "");
    canvas_text(s, x, y + (LABEL - CANVAS_TEXT_HEIGHT) / 2, text);
    y += LABEL;
    bool whole = length <= width; // otherwise the bar has no right end
    int shown = whole ? length : width;
    canvas_fill(s, x, y + 6, shown > 0 ? shown : 1, 2, ink);
    canvas_fill(s, x, y, 2, 14, ink);
    if (whole && length > 2) canvas_fill(s, x + length - 2, y, 2, 14, ink);
    y += LABEL;
    for (int i = 0; i < 32 * 16; i++) {
        uint8_t v = canvas_checker(i % 32, i / 32);
        canvas_put(s, x + i % 32, y + i / 32, (uint8_t[3]){v, v, v});
    }
    canvas_text(s, x + 32 + CANVAS_LETTER, y + 1, "no surface");
    if (!has_display(o)) return;
    snprintf(text, sizeof text, "light: view %.24s%s%.24s", o->view ? o->view : "default", o->display ? ", display " : "",
             o->display ? o->display : "");
    canvas_text(s, x, y + LABEL, text);
}

bool preview_write(const options *o, const frame_result *r, const char *path, error *e)
{
    int cells = 0;
    zoom z = zoom_for(r->gb.width, r->gb.height);
    for (int l = 0; l < LAYER_COUNT; l++) cells += r->layers[l] != NULL;
    int columns = cells < COLUMNS ? cells : COLUMNS, rows = (cells + COLUMNS - 1) / COLUMNS;
    int below = rows * (z.height + LABEL + GAP) + GAP;
    canvas s;
    if (!canvas_make(&s, columns * (z.width + GAP) + GAP, below + (has_display(o) ? 4 : 3) * LABEL, BACKGROUND, e)) return false;
    bool ok = true;
    for (int l = 0, cell = 0; ok && l < LAYER_COUNT; l++) {
        if (!r->layers[l]) continue;
        int x = GAP + cell % COLUMNS * (z.width + GAP), y = GAP + cell / COLUMNS * (z.height + LABEL + GAP);
        float gain = exposure(r, (layer_id)l);
        char label[64];
        snprintf(label, sizeof label, gain == 1.0f ? "%s" : "%s x%.2g", layer_table[l]->name, (double)gain);
        canvas_text(&s, x, y + (LABEL - CANVAS_TEXT_HEIGHT) / 2, label);
        ok = draw_layer(&s, o, r, (layer_id)l, x, y + LABEL, &z, gain, e);
        cell++;
    }
    draw_legend(&s, o, r, below, columns * (z.width + GAP) - GAP, &z);
    char record[DIGEST_TEXT + 1] = "none";
    if (r->record.made) digest_format(r->record.preview, record);
    ok = ok && images_write_png(path, s.width, s.height, s.rgb, RECORD_NAME, record, e);
    canvas_free(&s);
    return ok;
}
