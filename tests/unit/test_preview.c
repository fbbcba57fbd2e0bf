// The contact sheet of a frame that is made by hand: what stands in which cell, how bright, and what stands where nothing is.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "modules.h"
#include "must.h"
#include "pipeline/canvas.h"
#include "pipeline/preview.h"
#include "plugin/images.h"

enum { WIDTH = 400, HEIGHT = 60, PIXELS = WIDTH * HEIGHT, GAP = 6, LABEL = 24 };

// Left half a surface at depth 2, right half nothing.
static float depth[PIXELS], alpha[PIXELS], values[4][3 * PIXELS];
static exrio_channel channel = {.type = SAMPLE_FLOAT, .data = alpha};
static char no_view[] = "";
static exrio_part part = {.view = no_view, .channels = &channel, .channel_count = 1};
static exrio_file file = {.parts = &part, .part_count = 1};

static frame_result blank(void)
{
    frame_result r = {.file = &file};
    r.gb.width = WIDTH, r.gb.height = HEIGHT, r.gb.depth = depth, r.gb.valid = PIXELS / 2;
    r.gb.camera = (camera){.kind = CAMERA_PERSPECTIVE, .fx = 100.0, .fy = 100.0};
    r.set.radius = 0.5;
    for (int i = 0; i < PIXELS; i++) depth[i] = i % WIDTH < WIDTH / 2 ? 2.0f : 0.0f;
    return r;
}

static void fill(float *v, int channels, float r, float g, float b)
{
    const float colour[3] = {r, g, b};
    for (int i = 0; i < channels * PIXELS; i++) v[i] = colour[i % channels];
}

typedef struct picture {
    int width, height;
    unsigned char *rgb;
} picture;

static int take(void *context, int width, int height, int channels, int y, int rows, const float *pixels)
{
    picture *p = context;
    assert_int_equal(channels, 3);
    if (!p->rgb) p->rgb = malloc((size_t)(3 * width * height));
    p->width = width, p->height = height;
    for (int i = 0; p->rgb && i < 3 * width * rows; i++) p->rgb[3 * width * y + i] = (unsigned char)lrintf(255.0f * pixels[i]);
    return p->rgb != NULL;
}

static picture drawn(const frame_result *r)
{
    char path[64];
    error e = {0};
    options o;
    picture p = {0};
    options_defaults(&o);
    snprintf(path, sizeof path, "/tmp/ssdo_preview_%d.png", (int)getpid());
    must(preview_write(&o, r, path, &e), &e);
    must(images_read_rows(path, 0, take, &p, &e), &e);
    remove(path);
    return p;
}

// A dot of a cell's picture.
static const unsigned char *at(const picture *p, int cell, int x, int y)
{
    int left = GAP + cell % 2 * (WIDTH + GAP), top = GAP + cell / 2 * (HEIGHT + LABEL + GAP) + LABEL;
    return p->rgb + 3 * ((top + y) * p->width + left + x);
}

static void expect_colour(const picture *p, int cell, int x, int r, int g, int b)
{
    const unsigned char *c = at(p, cell, x, HEIGHT / 2);
    if (abs(c[0] - r) > 1 || abs(c[1] - g) > 1 || abs(c[2] - b) > 1)
        fail_msg("cell %d at %d: %d %d %d, not %d %d %d", cell, x, c[0], c[1], c[2], r, g, b);
}

static int srgb(double v) { return (int)lrint(255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055)); }

// Shares as they are, light exposed to 0.8 and through sRGB's curve, directions around grey; two columns, in the layers' order.
static void each_layer_has_its_cell_and_its_scale(void **state)
{
    (void)state;
    frame_result r = blank();
    fill(values[0], 1, 0.25f, 0.0f, 0.0f);
    fill(values[1], 3, 40.0f, 20.0f, 10.0f);
    fill(values[2], 3, -1.0f, 0.0f, 0.5f);
    r.layers[LAYER_OCCLUSION] = values[0], r.layers[LAYER_RADIANCE] = values[1], r.layers[LAYER_BENT] = values[2];
    picture p = drawn(&r);
    assert_int_equal(p.width, 2 * (WIDTH + GAP) + GAP);
    assert_int_equal(p.height, 2 * (HEIGHT + LABEL + GAP) + GAP + 3 * LABEL);
    expect_colour(&p, 0, 100, 64, 64, 64);
    expect_colour(&p, 1, 100, srgb(0.8), srgb(0.4), srgb(0.2));
    expect_colour(&p, 2, 100, 0, 128, 191);
    for (int cell = 0; cell < 3; cell++) { // no surface
        const unsigned char *c = at(&p, cell, 300, 30), *side = at(&p, cell, 308, 30);
        assert_true((c[0] == 72 && side[0] == 104) || (c[0] == 104 && side[0] == 72));
        assert_true(c[0] == c[1] && c[1] == c[2]);
    }
    free(p.rgb);
}

// The composite is a picture: it stands also where there is no surface, and as far as its alpha goes.
static void a_composite_lies_over_the_checkerboard(void **state)
{
    (void)state;
    frame_result r = blank();
    r.resolution.components[ROLE_ALPHA] = 1; // part 0, channel 0
    for (int i = 0; i < PIXELS; i++) alpha[i] = i % WIDTH < 300 ? 1.0f : i % WIDTH < 350 ? 0.5f : 0.0f;
    for (int i = 0; i < 3 * PIXELS; i++) values[0][i] = 0.8f * alpha[i / 3]; // premultiplied
    r.layers[LAYER_COMPOSITE] = values[0];
    picture p = drawn(&r);
    assert_int_equal(p.width, WIDTH + 2 * GAP); // one cell, one column
    int white = srgb(0.8);
    expect_colour(&p, 0, 100, white, white, white);
    expect_colour(&p, 0, 250, white, white, white); // no surface, but a picture
    const unsigned char *half = at(&p, 0, 330, 30), *none = at(&p, 0, 380, 30);
    assert_true(abs(half[0] - (white + 72) / 2) <= 1 || abs(half[0] - (white + 104) / 2) <= 1);
    assert_true(none[0] == 72 || none[0] == 104);
    free(p.rgb);
}

// The bar below is as long as the radius at the middle depth: 0.5 at a depth of 2 and 100 pixels a unit at depth 1 are 25.
static void the_bar_is_the_radius(void **state)
{
    (void)state;
    frame_result r = blank();
    fill(values[0], 1, 1.0f, 0.0f, 0.0f);
    r.layers[LAYER_OCCLUSION] = values[0];
    picture p = drawn(&r);
    int y = HEIGHT + LABEL + 2 * GAP + LABEL + 6, length = 0;
    const unsigned char *row = p.rgb + 3 * y * p.width;
    while (row[3 * (GAP + length)] == 235) length++;
    assert_int_equal(length, 25);
    free(p.rgb);
}

// A small frame is enlarged and a large one reduced, by a whole number: a cell is 320 to 960 columns wide.
static void cells_are_wide_enough_to_see(void **state)
{
    (void)state;
    const int cases[][2] = {{8, 320}, {100, 400}, {320, 320}, {960, 960}, {961, 481}, {2000, 667}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        frame_result r = blank();
        r.gb.width = cases[i][0], r.gb.height = 10, r.gb.valid = 0;
        fill(values[0], 1, 1.0f, 0.0f, 0.0f);
        r.layers[LAYER_OCCLUSION] = values[0];
        picture p = drawn(&r);
        assert_int_equal(p.width, cases[i][1] + 2 * GAP);
        free(p.rgb);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_layer_has_its_cell_and_its_scale),
        cmocka_unit_test(a_composite_lies_over_the_checkerboard),
        cmocka_unit_test(the_bar_is_the_radius),
        cmocka_unit_test(cells_are_wide_enough_to_see),
    };
    use_built_modules();
    unsetenv("OCIO");
    return cmocka_run_group_tests(tests, NULL, NULL);
}
