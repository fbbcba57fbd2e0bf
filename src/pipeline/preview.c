#include "pipeline/preview.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "plugin/images.h"

enum { LABEL = 24, GAP = 6, COLUMNS = 2, GLYPH_W = 5, GLYPH_H = 7, ZOOM = 2, EXPOSURE_SAMPLES = 4096 };

// Five by seven pixels, a row a number, the leftmost pixel in bit 4.
static const unsigned char font[128][GLYPH_H] = {
    ['a'] = {0x00, 0x00, 0x0e, 0x01, 0x0f, 0x11, 0x0f}, ['b'] = {0x10, 0x10, 0x1e, 0x11, 0x11, 0x11, 0x1e},
    ['c'] = {0x00, 0x00, 0x0e, 0x10, 0x10, 0x11, 0x0e}, ['d'] = {0x01, 0x01, 0x0f, 0x11, 0x11, 0x11, 0x0f},
    ['e'] = {0x00, 0x00, 0x0e, 0x11, 0x1f, 0x10, 0x0e}, ['f'] = {0x06, 0x09, 0x08, 0x1c, 0x08, 0x08, 0x08},
    ['g'] = {0x00, 0x0f, 0x11, 0x11, 0x0f, 0x01, 0x0e}, ['h'] = {0x10, 0x10, 0x1e, 0x11, 0x11, 0x11, 0x11},
    ['i'] = {0x04, 0x00, 0x0c, 0x04, 0x04, 0x04, 0x0e}, ['j'] = {0x02, 0x00, 0x06, 0x02, 0x02, 0x12, 0x0c},
    ['k'] = {0x10, 0x10, 0x12, 0x14, 0x18, 0x14, 0x12}, ['l'] = {0x0c, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0e},
    ['m'] = {0x00, 0x00, 0x1a, 0x15, 0x15, 0x15, 0x15}, ['n'] = {0x00, 0x00, 0x1e, 0x11, 0x11, 0x11, 0x11},
    ['o'] = {0x00, 0x00, 0x0e, 0x11, 0x11, 0x11, 0x0e}, ['p'] = {0x00, 0x00, 0x1e, 0x11, 0x1e, 0x10, 0x10},
    ['q'] = {0x00, 0x0f, 0x11, 0x11, 0x0f, 0x01, 0x01}, ['r'] = {0x00, 0x00, 0x16, 0x19, 0x10, 0x10, 0x10},
    ['s'] = {0x00, 0x00, 0x0f, 0x10, 0x0e, 0x01, 0x1e}, ['t'] = {0x08, 0x08, 0x1c, 0x08, 0x08, 0x09, 0x06},
    ['u'] = {0x00, 0x00, 0x11, 0x11, 0x11, 0x13, 0x0d}, ['v'] = {0x00, 0x00, 0x11, 0x11, 0x11, 0x0a, 0x04},
    ['w'] = {0x00, 0x00, 0x11, 0x11, 0x15, 0x15, 0x0a}, ['x'] = {0x00, 0x00, 0x11, 0x0a, 0x04, 0x0a, 0x11},
    ['y'] = {0x00, 0x11, 0x11, 0x11, 0x0f, 0x01, 0x0e}, ['z'] = {0x00, 0x00, 0x1f, 0x02, 0x04, 0x08, 0x1f},
    ['0'] = {0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e}, ['1'] = {0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e},
    ['2'] = {0x0e, 0x11, 0x01, 0x06, 0x08, 0x10, 0x1f}, ['3'] = {0x1e, 0x01, 0x01, 0x0e, 0x01, 0x01, 0x1e},
    ['4'] = {0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02}, ['5'] = {0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e},
    ['6'] = {0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e}, ['7'] = {0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08},
    ['8'] = {0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e}, ['9'] = {0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c},
    ['.'] = {0x00, 0x00, 0x00, 0x00, 0x00, 0x0c, 0x0c}, ['-'] = {0x00, 0x00, 0x00, 0x1e, 0x00, 0x00, 0x00},
    ['+'] = {0x00, 0x04, 0x04, 0x1f, 0x04, 0x04, 0x00},
};

typedef struct sheet {
    int width, height;
    uint8_t *rgb;
} sheet;

static void put(sheet *s, int x, int y, const uint8_t c[3])
{
    if (x >= 0 && y >= 0 && x < s->width && y < s->height) memcpy(s->rgb + 3 * ((size_t)y * (size_t)s->width + (size_t)x), c, 3);
}

static void write_text(sheet *s, int x, int y, const char *text)
{
    static const uint8_t ink[3] = {230, 230, 230};
    for (; *text; text++, x += (GLYPH_W + 1) * ZOOM)
        for (int r = 0; r < GLYPH_H * ZOOM; r++)
            for (int c = 0; c < GLYPH_W * ZOOM; c++)
                if (font[*text & 127][r / ZOOM] >> (GLYPH_W - 1 - c / ZOOM) & 1) put(s, x + c, y + r, ink);
}

static uint8_t encode(float linear)
{
    float v = linear <= 0.0f ? 0.0f : linear >= 1.0f ? 1.0f : linear;
    v = v <= 0.0031308f ? 12.92f * v : 1.055f * powf(v, 1.0f / 2.4f) - 0.055f;
    return (uint8_t)lrintf(255.0f * v);
}

static int by_value(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// Factor that puts the 95th percentile of the surfaces' light at 0.8.
static float exposure(const frame_result *r)
{
    const float *v = r->layers[LAYER_COMPOSITE] ? r->layers[LAYER_COMPOSITE] : r->layers[LAYER_RADIANCE];
    float values[EXPOSURE_SAMPLES];
    size_t n = 0, pixels = (size_t)r->gb.width * (size_t)r->gb.height, stride = r->gb.valid / EXPOSURE_SAMPLES + 1, seen = 0;
    for (size_t i = 0; v && i < pixels && n < EXPOSURE_SAMPLES; i++)
        if (r->gb.depth[i] > 0.0f && seen++ % stride == 0) values[n++] = fmaxf(v[3 * i], fmaxf(v[3 * i + 1], v[3 * i + 2]));
    if (n == 0) return 1.0f;
    qsort(values, n, sizeof *values, by_value);
    float top = values[n * 95 / 100];
    return top > 0.0f ? 0.8f / top : 1.0f;
}

static void draw_layer(sheet *s, const frame_result *r, layer_id l, int x0, int y0, float gain)
{
    size_t channels = strlen(layer_table[l].channels);
    bool share = channels == 1;
    float neutral = l == LAYER_DEPTHMASK ? 1.0f : 0.0f; // its 0 is shown white
    for (int y = 0; y < r->gb.height; y++)
        for (int x = 0; x < r->gb.width; x++) {
            const float *v = r->layers[l] + channels * ((size_t)y * (size_t)r->gb.width + (size_t)x);
            uint8_t c[3];
            for (size_t k = 0; k < 3; k++)
                c[k] = share             ? (uint8_t)lrintf(255.0f * (v[0] + neutral))
                       : l == LAYER_BENT ? (uint8_t)lrintf(127.5f * (v[k] + 1.0f))
                                         : encode(gain * v[k]);
            put(s, x0 + x, y0 + y, c);
        }
}

bool preview_write(const frame_result *r, const char *path, error *e)
{
    int cells = 0, w = r->gb.width, h = r->gb.height;
    for (int l = 0; l < LAYER_COUNT; l++) cells += r->layers[l] != NULL;
    int columns = cells < COLUMNS ? cells : COLUMNS, rows = (cells + COLUMNS - 1) / COLUMNS;
    sheet s = {.width = columns * (w + GAP) + GAP, .height = rows * (h + LABEL + GAP) + GAP};
    s.rgb = mem_zero((size_t)s.width * (size_t)s.height, 3, e);
    if (!s.rgb) return false;
    memset(s.rgb, 40, 3 * (size_t)s.width * (size_t)s.height);
    float gain = exposure(r);
    for (int l = 0, cell = 0; l < LAYER_COUNT; l++) {
        if (!r->layers[l]) continue;
        int x = GAP + cell % COLUMNS * (w + GAP), y = GAP + cell / COLUMNS * (h + LABEL + GAP);
        char label[96];
        int n = snprintf(label, sizeof label, "%s", layer_table[l].name);
        if (l == LAYER_OCCLUSION) snprintf(label + n, sizeof label - (size_t)n, "  radius %.3g", r->set.radius);
        if ((int)strlen(label) * (GLYPH_W + 1) * ZOOM > w) label[n] = 0; // no room for the radius
        write_text(&s, x, y + (LABEL - GLYPH_H * ZOOM) / 2, label);
        draw_layer(&s, r, (layer_id)l, x, y + LABEL, gain);
        cell++;
    }
    bool ok = images_write_png(path, s.width, s.height, s.rgb, e);
    free(s.rgb);
    return ok;
}
