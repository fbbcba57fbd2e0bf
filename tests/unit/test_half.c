// --resolution half and light: the small frame, and what comes back from it.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "gbuffer/half_size.h"
#include "must.h"
#include "near.h"
#include "rig.h"
#include "scene_picture.h"

enum { LIGHT = 1 << LAYER_OCCLUSION | 1 << LAYER_RADIANCE, BOUNCE = LIGHT | 1 << LAYER_INDIRECT };

static gbuffer shoot(const scene *s, const view *v)
{
    gbuffer gb;
    error e = {0};
    must(scene_gbuffer(s, v, &gb, &e), &e);
    return gb;
}

static gbuffer clutter(int width, int height)
{
    scene s = {0};
    scene_clutter(&s);
    view v = view_perspective(width, height, 50.0, 1.0);
    view_scene(&v, &s);
    return shoot(&s, &v);
}

// A pixel of the frame that was halved twice has the normal of the pixel whose place it tells.
static void quarters_know_their_pixels(void **state)
{
    (void)state;
    gbuffer gb = clutter(93, 61), half, quarter;
    error e = {0};
    int seen = 0;
    must(gbuffer_halve(&gb, 2, &half, &e) && gbuffer_halve(&half, 2, &quarter, &e), &e);
    gbuffer_quarter_places(&half, &quarter);
    for (int y = 0; y < quarter.height; y++)
        for (int x = 0; x < quarter.width; x++) {
            size_t i = (size_t)(y * quarter.width + x);
            if (quarter.depth[i] == 0.0f) continue;
            int place = (int)quarter.normal[4 * i + 3] % 16, u = 4 * x + place % 4, v = 4 * y + place / 4;
            assert_in_range(u, 0, gb.width - 1);
            assert_in_range(v, 0, gb.height - 1);
            assert_memory_equal(quarter.normal + 4 * i, gb.normal + 4 * (v * gb.width + u), 3 * sizeof(float));
            seen++;
        }
    assert_true(seen > 100);
    gbuffer_free(&gb);
    gbuffer_free(&half);
    gbuffer_free(&quarter);
}

static double clutter_radius(void)
{
    scene s = {0};
    scene_clutter(&s);
    return s.radius;
}

static void open_white(rig *r)
{
    error e = {0};
    must(rig_open(r, &(env_options){.up_z = true, .scale = 1.0}, &e), &e);
}

// Every small pixel lies on the floor or on the wall, never between them, and has that surface's normal and colour.
static void no_surface_is_invented(void **state)
{
    (void)state;
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        scene s = {0};
        error e = {0};
        gbuffer small;
        scene_corner(&s, 0.3);
        view v = orthographic ? view_orthographic(91, 63, 4.0, 1.3) : view_perspective(91, 63, 55.0, 1.0);
        view_scene(&v, &s);
        gbuffer gb = shoot(&s, &v);
        must(gbuffer_halve(&gb, 2, &small, &e), &e);
        assert_int_equal(small.width, 46);
        assert_int_equal(small.height, 32);
        int floors = 0, walls = 0;
        const camera *c = &small.camera;
        for (int i = 0; i < 46 * 32; i++) {
            assert_true(small.depth[i] > 0.0f);
            vec3 w = v3_add(c->origin, m3_apply(c->world_from_camera, gbuffer_position(&small, i % 46, i / 46)));
            const float *n = small.normal + 4 * i;
            vec3 up = m3_apply(c->world_from_camera, v3((double)n[0], (double)n[1], (double)n[2]));
            bool floor = up.z > 0.5;
            assert_near(floor ? w.z : w.y, 0.0, 2e-6);
            assert_near(floor ? up.z : -up.y, 1.0, 1e-6);
            floors += floor, walls += !floor;
        }
        assert_true(floors > 100 && walls > 100);
        gbuffer_free(&small);
        gbuffer_free(&gb);
    }
}

// Four depths in a block: a stray near and a stray far one do not represent it; of two surfaces the nearer does.
static void the_median_represents(void **state)
{
    (void)state;
    static const struct {
        float depth[4], expected;
    } cases[] = {{{5, 5, 1, 9}, 5}, {{3, 7, 3, 7}, 3}, {{0, 0, 4, 0}, 4}, {{0, 8, 6, 0}, 6}, {{0, 0, 0, 0}, 0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        float depth[4], normal[16] = {0};
        error e = {0};
        gbuffer g = {.width = 2, .height = 2, .depth = depth, .normal = normal}, small;
        g.camera = (camera){.kind = CAMERA_ORTHOGRAPHIC, .fx = 1, .fy = 1, .cx = 1, .cy = 1};
        memcpy(depth, cases[k].depth, sizeof depth);
        for (int i = 0; i < 4; i++) normal[4 * i + 2] = -1.0f;
        must(gbuffer_halve(&g, 1, &small, &e), &e);
        assert_true(small.depth[0] == cases[k].expected);
        assert_int_equal(small.valid, cases[k].expected > 0.0f);
        gbuffer_free(&small);
    }
}

static void empty_plane_stays_open(void **state)
{
    (void)state;
    static const double tilts[] = {0.0, 0.1, 30.0, 60.0, 80.0, 89.0};
    static const int sizes[][2] = {{96, 64}, {61, 37}, {3, 5}, {2, 1}, {1, 1}};
    rig r;
    open_white(&r);
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE))
        for (size_t t = 0; t < sizeof tilts / sizeof *tilts; t++)
            for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
                for (int kind = 0; kind < 4; kind++) {
                    scene s = {0};
                    error e = {0};
                    frame_result out;
                    bool orthographic = kind % 2;
                    int w = sizes[k][0], h = sizes[k][1];
                    scene_tilted_plane(&s, tilts[t], 10.0);
                    view v = orthographic ? view_orthographic(w, h, 12.0, 1.0) : view_perspective(w, h, 45.0, 1.0);
                    gbuffer gb = shoot(&s, &v);
                    pass_settings set = rig_settings(m, 1.0);
                    set.samples = 16, set.blur = 3, set.size = kind < 2 ? SIZE_HALF : SIZE_LIGHT;
                    must(rig_run(&r, &gb, m, &set, LIGHT, &out, &e), &e);
                    for (int i = 0; i < w * h; i++) {
                        if (out.layers[LAYER_OCCLUSION][i] != 1.0f)
                            fail_msg("%s: occlusion %.9g at pixel %d of %d x %d, tilt %g, orthographic %d", m->name,
                                     (double)out.layers[LAYER_OCCLUSION][i], i, w, h, tilts[t], orthographic);
                        for (int c = 0; gb.depth[i] > 0.0f && c < 3; c++)
                            assert_near((double)out.layers[LAYER_RADIANCE][3 * i + c], 1.0, 2e-6);
                    }
                    rig_free_result(&out);
                    gbuffer_free(&gb);
                }
    rig_close(&r);
}

// Near the full-size result, not the same, and as bounded; a constant picture of the albedo's colour stays out of neither.
static void is_near_the_full_result(void **state)
{
    (void)state;
    rig r;
    error e = {0};
    open_white(&r);
    gbuffer gb = clutter(240, 160);
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
        frame_result full, half;
        unsigned layers = m->bounce ? BOUNCE : LIGHT;
        pass_settings set = rig_settings(m, clutter_radius());
        set.samples = 64, set.blur = 4, set.thickness = 0.3 * set.radius;
        r.options.bounce = m->bounce ? m->bounce->name : NULL;
        must(rig_run(&r, &gb, m, &set, layers, &full, &e), &e);
        set.size = SIZE_HALF;
        must(rig_run(&r, &gb, m, &set, layers, &half, &e), &e);
        double square = 0.0, contrast = 0.0, mean = 0.0, n = 240 * 160;
        for (int i = 0; i < 240 * 160; i++) {
            double x = (double)full.layers[LAYER_OCCLUSION][i], d = (double)half.layers[LAYER_OCCLUSION][i] - x;
            square += d * d / n, mean += x / n, contrast += x * x / n;
        }
        contrast = sqrt(contrast - mean * mean);
        print_message("%s: rms difference %.4f of a contrast of %.4f\n", m->name, sqrt(square), contrast);
        assert_true(sqrt(square) < 0.3 * contrast);
        assert_true(square > 0.0);
        for (int i = 0; m->bounce && i < 3 * 240 * 160; i++) assert_true(half.layers[LAYER_INDIRECT][i] <= 1.0f);
        rig_free_result(&full);
        rig_free_result(&half);
    }
    gbuffer_free(&gb);
    rig_close(&r);
}

// No halo: a wall far behind a floating disc, out of reach of each other, stays open up to the disc's outline.
static void nothing_bleeds_over_edges(void **state)
{
    (void)state;
    rig r;
    scene s = {0};
    error e = {0};
    frame_result out;
    open_white(&r);
    scene_tilted_plane(&s, 0.0, 20.0);
    scene_add_disc(&s, v3(0.3, 5, 0.2), v3(0, -1, 0), 1.0, v3(0.5, 0.5, 0.5));
    scene_add_box(&s, v3(0.3, 4.7, 0.2), v3(0.2, 0.3, 0.2), 30.0, v3(0.5, 0.5, 0.5));
    view v = view_perspective(151, 111, 50.0, 1.0);
    gbuffer gb = shoot(&s, &v);
    const method *m = method_find("bitmask");
    pass_settings set = rig_settings(m, 1.0);
    set.samples = 128, set.blur = 4, set.size = SIZE_HALF;
    must(rig_run(&r, &gb, m, &set, 1 << LAYER_OCCLUSION, &out, &e), &e);
    double darkest = 1.0;
    for (int i = 0; i < 151 * 111; i++) {
        if (gb.depth[i] > 19.0f) assert_true(out.layers[LAYER_OCCLUSION][i] == 1.0f);
        darkest = fmin(darkest, (double)out.layers[LAYER_OCCLUSION][i]);
    }
    assert_true(darkest < 0.8); // the disc around the box is not open
    rig_free_result(&out);
    gbuffer_free(&gb);
    rig_close(&r);
}

// A pixel stands alone if its surface is not among those that the small pixels around it have taken: of a thin bar before a wall,
// some; of a plane, none, up to an odd frame's last row.
static void lone_pixels_are_those_not_shown(void **state)
{
    (void)state;
    for (int orthographic = 0; orthographic < 2; orthographic++)
        for (int bar = 0; bar < 2; bar++) {
            scene s = {0};
            error e = {0};
            gbuffer small;
            pixel_list lone, again;
            scene_tilted_plane(&s, 0.0, 20.0);
            if (bar) scene_add_box(&s, v3(0.0, 4.0, 0.0), v3(0.02, 0.02, 1.0), 0.0, v3(0.5, 0.5, 0.5));
            view v = orthographic ? view_orthographic(91, 63, 4.0, 1.3) : view_perspective(91, 63, 45.0, 1.0);
            gbuffer gb = shoot(&s, &v);
            must(gbuffer_halve(&gb, 1, &small, &e) && gbuffer_lone(&gb, &small, 1, &lone, &e), &e);
            must(gbuffer_lone(&gb, &small, 5, &again, &e), &e);
            assert_int_equal(lone.count > 0, bar);
            assert_int_equal(lone.count, again.count);
            for (size_t i = 0; i < lone.count; i++) {
                int x = (int)(lone.pixels[i] & 0xffffu), y = (int)(lone.pixels[i] >> 16);
                assert_int_equal(lone.pixels[i], again.pixels[i]);
                assert_true(x < 91 && y < 63 && gb.depth[y * 91 + x] > 0.0f);
                // No small pixel near by is as near as this one, or none as far.
                int alike = 0;
                for (int k = 0; k < 4; k++) {
                    int sx = (x + 2 * (k & 1) - 1) / 2, sy = (y + 2 * (k >> 1) - 1) / 2;
                    if (sx < small.width && sy < small.height)
                        alike += fabsf(small.depth[sy * small.width + sx] - gb.depth[y * 91 + x]) < 1.0f;
                }
                assert_true(alike < 4);
            }
            pixel_list_free(&lone);
            pixel_list_free(&again);
            gbuffer_free(&small);
            gbuffer_free(&gb);
        }
}

static double rms(const float *a, const float *b, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]) / (double)n;
    return sqrt(sum);
}

// Light at half size leaves occlusion and bent as they are, to the bit, and its own layers are near those at full size: nearer
// than with all at half size.
static void light_alone_is_halved(void **state)
{
    (void)state;
    enum { W = 240, H = 160 };
    rig r;
    error e = {0};
    frame_result out[3];
    open_white(&r);
    gbuffer gb = clutter(W, H);
    pass_settings set = rig_settings(method_find("arc"), clutter_radius());
    set.blur = 4, set.thickness = 0.3 * set.radius;
    r.options.bounce = "arc";
    for (int size = SIZE_FULL; size <= SIZE_HALF; size++) {
        set.size = (estimate_size)size;
        must(rig_run(&r, &gb, method_find("arc"), &set, BOUNCE | 1 << LAYER_BENT, &out[size], &e), &e);
    }
    assert_memory_equal(out[SIZE_FULL].layers[LAYER_OCCLUSION], out[SIZE_LIGHT].layers[LAYER_OCCLUSION], sizeof(float) * W * H);
    assert_memory_equal(out[SIZE_FULL].layers[LAYER_BENT], out[SIZE_LIGHT].layers[LAYER_BENT], sizeof(float) * 3 * W * H);
    for (int l = LAYER_RADIANCE; l <= LAYER_INDIRECT; l++) {
        double light = rms(out[SIZE_FULL].layers[l], out[SIZE_LIGHT].layers[l], 3 * W * H);
        double half = rms(out[SIZE_FULL].layers[l], out[SIZE_HALF].layers[l], 3 * W * H);
        print_message("%s: rms difference %.4f, with all at half size %.4f\n", layer_table[l]->name, light, half);
        assert_true(light > 0.0 && light < half);
    }
    for (int i = 0; i < 3; i++) rig_free_result(&out[i]);
    gbuffer_free(&gb);
    rig_close(&r);
}

static void same_bits_for_any_threads(void **state)
{
    (void)state;
    rig r;
    error e = {0};
    frame_result a, b;
    open_white(&r);
    gbuffer gb = clutter(151, 97);
    const method *m = method_find("arc");
    pass_settings set = rig_settings(m, clutter_radius());
    set.blur = 4, set.planes = true;
    r.options.bounce = "arc";
    for (int size = SIZE_LIGHT; size <= SIZE_HALF; size++) {
        set.size = (estimate_size)size;
        r.job.threads = 1;
        must(rig_run(&r, &gb, m, &set, BOUNCE, &a, &e), &e);
        r.job.threads = 5;
        must(rig_run(&r, &gb, m, &set, BOUNCE, &b, &e), &e);
        assert_memory_equal(a.layers[LAYER_OCCLUSION], b.layers[LAYER_OCCLUSION], sizeof(float) * 151 * 97);
        assert_memory_equal(a.layers[LAYER_RADIANCE], b.layers[LAYER_RADIANCE], sizeof(float) * 3 * 151 * 97);
        assert_memory_equal(a.layers[LAYER_INDIRECT], b.layers[LAYER_INDIRECT], sizeof(float) * 3 * 151 * 97);
        rig_free_result(&a);
        rig_free_result(&b);
    }
    gbuffer_free(&gb);
    rig_close(&r);
}

// test_half [FILTER]
int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_surface_is_invented),     cmocka_unit_test(the_median_represents),
        cmocka_unit_test(empty_plane_stays_open),     cmocka_unit_test(is_near_the_full_result),
        cmocka_unit_test(nothing_bleeds_over_edges),  cmocka_unit_test(same_bits_for_any_threads),
        cmocka_unit_test(quarters_know_their_pixels), cmocka_unit_test(lone_pixels_are_those_not_shown),
        cmocka_unit_test(light_alone_is_halved),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests_name("half", tests, NULL, NULL);
}
