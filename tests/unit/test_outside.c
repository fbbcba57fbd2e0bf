// What lies outside the frame: a roof is told from the sky, openings are found, and light of a closed place comes through the
// openings that the picture shows.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/mem.h"
#include "gbuffer/world_view.h"
#include "must.h"
#include "outside_rooms.h"
#include "passes/openings.h"
#include "passes/surround.h"
#include "rig.h"
#include "scene_picture.h"
#include "truth.h"

static double roof_of(const scene *s, double fov)
{
    gbuffer gb;
    look(s, 160, 90, fov, &gb);
    double roof = openings_roof(&gb, m3_apply(m3_transpose(gb.camera.world_from_camera), v3(0, 0, 1)));
    gbuffer_free(&gb);
    return roof;
}

static void roofs(void **state)
{
    (void)state;
    scene inside = room(true, true), court = room(true, false), up = inside, box = room(false, true), table = {0};
    up.target = v3(2, 3, 2.5);
    box.eye = v3(2, -5, 1.5); // before the open side: it sees where the ceiling ends
    table.eye = v3(0, -6, 0.4), table.target = v3(0, 0, 0.8);
    scene_add_plane(&table, v3(0, 0, 0), v3(0, 0, 1), grey);
    scene_add_box(&table, v3(0, 0, 1.2), v3(1.5, 1.0, 0.05), 10.0, grey);
    assert_true(roof_of(&inside, 60.0) > 0.05);
    assert_true(roof_of(&up, 60.0) > 0.2);
    assert_true(roof_of(&court, 60.0) == 0.0);
    assert_true(roof_of(&box, 60.0) == 0.0);
    assert_true(roof_of(&table, 40.0) == 0.0);
}

static void openings(void **state)
{
    (void)state;
    enum { W = 160, H = 90 };
    error e = {0};
    scene s = room(true, true);
    gbuffer gb;
    static float rim[W * H];
    look(&s, W, H, 60.0, &gb);
    gb.depth[80 * W + 20] = 0.0f; // a crack in the floor
    must(openings_find(&gb, rim, &e), &e);
    int shown = 0, empty = 0;
    for (int i = 0; i < W * H; i++) {
        empty += gb.depth[i] == 0.0f;
        if (rim[i] == 0.0f) continue;
        assert_true(gb.depth[i] == 0.0f);
        assert_true(fabs((double)rim[i] / 4.7 - 1.0) < 0.02); // the far wall
        shown++;
    }
    assert_true(rim[80 * W + 20] == 0.0f);
    assert_true(shown == empty - 1);
    gbuffer_free(&gb);
}

// The ground seen through the window is outdoors too, also where the pixels of its horizon are covered in part.
static void ground_is_outdoors(void **state)
{
    (void)state;
    enum { W = 160, H = 90 };
    error e = {0};
    scene s = room(true, true);
    gbuffer gb;
    static float rim[W * H], coverage[W * H];
    quad(&s, -500, 5.2, -0.3, v3(1000, 0, 0), v3(0, 900, 0));
    look(&s, W, H, 60.0, &gb);
    gb.coverage = coverage;
    for (int i = 0; i < W * H; i++) coverage[i] = gb.depth[i] > 0.0f;
    for (int i = W; i < W * H; i++) // the first row of the ground
        if (coverage[i - W] == 0.0f && gb.depth[i] > 50.0f) gb.depth[i] = 0.0f, coverage[i] = 0.5f;
    must(openings_find(&gb, rim, &e), &e);
    int ground = 0;
    for (int i = 0; i < W * H; i++) {
        if (gb.depth[i] < 8.0f) continue;
        assert_true(rim[i] > 4.0f && rim[i] < 5.5f);
        ground++;
    }
    assert_true(ground > 100);
    gb.coverage = NULL;
    gbuffer_free(&gb);
}

// A crack in a further view is no opening in the map.
static void cracks_are_no_openings(void **state)
{
    (void)state;
    enum { W = 64, H = 36, TEXELS = SURROUND_SIDE * SURROUND_SIDE, COARSE = SURROUND_COARSE * SURROUND_COARSE };
    error e = {0};
    scene s = room(true, true);
    gbuffer gb;
    static float shell[TEXELS][2], albedo[COARSE][4];
    int openings[2] = {0}, map_of[MAX_FURTHER];
    look(&s, W, H, 60.0, &gb);
    for (int cracked = 0; cracked < 2; cracked++) {
        world_view v = {0};
        surround_map maps[MAX_FURTHER];
        for (int i = 0; cracked && i < 16; i++) gb.depth[30 * W + 8 + 3 * i] = 0.0f;
        must(world_view_of_frame(&gb, (size_t)W * H, &v, &e), &e);
        memset(shell, 0, sizeof shell);
        assert_int_equal(surround_maps(&v, 1, map_of, maps), 1);
        maps[0].shell = shell, maps[0].albedo = albedo;
        must(surround_make(&v, 1, m3_identity(), 2, map_of, maps, 1, &e), &e);
        for (int i = 0; i < TEXELS; i++) openings[cracked] += shell[i][0] < 0.0f;
        world_view_free(&v);
    }
    assert_true(openings[0] > 0);
    assert_int_equal(openings[0], openings[1]);
    gbuffer_free(&gb);
}

// The texel of a direction has that direction, on both halves of the octahedron.
static void texels_have_their_directions(void **state)
{
    (void)state;
    enum { SIDE = 96 };
    for (int i = 0; i < SIDE * SIDE; i++) {
        vec3 d = surround_direction(i % SIDE + 0.5, i / SIDE + 0.5, SIDE);
        assert_true(fabs(v3_length(d) - 1.0) < 1e-12);
        assert_int_equal(surround_texel(v3_scale(d, 3.0), SIDE), i);
    }
    assert_true(surround_direction(0.5 * SIDE, 0.5 * SIDE, SIDE).z == 1.0 && surround_direction(0, 0, SIDE).z == -1.0);
}

typedef struct light {
    double rms, ratio; // of the difference over the truth's rms; of the means
} light;

// A pixel in 7 x 7 against rays; with what further views show. layer: radiance or indirect.
static light light_in(const scene *s, double outside, const world_view *more, layer_id layer)
{
    enum { W = 160, H = 90, STEP = 7 };
    static rig r;
    error e = {0};
    gbuffer gb;
    frame_result out;
    must(rig_open(&r, &(env_options){.scale = 1.0}, &e), &e);
    look(s, W, H, 60.0, &gb);
    pass_settings set = rig_settings(method_find("arc"), 0.5);
    set.thickness = 0.1, set.planes = true, set.blur = 4, set.outside = openness_even(outside);
    if (more) r.job.views[r.job.view_count++] = *more;
    must(rig_run(&r, &gb, method_find("arc"), &set, 1u << layer, &out, &e), &e);
    r.job.view_count = 0; // borrowed
    tracer t = scene_tracer(s);
    truth_options o = {.rays = layer == LAYER_RADIANCE ? 1024 : 256, .offset = 1e-4}; // the points are rounded to floats
    double se = 0, sx = 0, st = 0, stt = 0;
    for (int y = STEP / 2; y < H; y += STEP)
        for (int x = STEP / 2; x < W; x += STEP) {
            size_t i = (size_t)y * W + (size_t)x;
            const float *n = gb.normal + 4 * i;
            if (gb.depth[i] == 0.0f) continue;
            vec3 N = m3_apply(gb.camera.world_from_camera, v3((double)n[0], (double)n[1], (double)n[2]));
            vec3 P = v3_add(gb.camera.origin, m3_apply(gb.camera.world_from_camera, gbuffer_position(&gb, x, y)));
            double want = layer == LAYER_RADIANCE ? truth_radiance(&t, P, N, &o).x : truth_indirect(&t, P, N, &o).x;
            double got = (double)out.layers[layer][3 * i];
            se += (got - want) * (got - want), sx += got, st += want, stt += want * want;
        }
    rig_free_result(&out);
    gbuffer_free(&gb);
    rig_close(&r);
    return (light){sqrt(se / stt), sx / st};
}

static light light_of(const scene *s, double outside, const world_view *more)
{
    return light_in(s, outside, more, LAYER_RADIANCE);
}

static void light_comes_through_the_window(void **state)
{
    (void)state;
    scene s = room(true, true);
    light closed = light_of(&s, 0.0, NULL), open = light_of(&s, 1.0, NULL), part = light_of(&s, 0.5, NULL);
    printf("figure: room with a window in view: radiance %.3f of the truth's rms (means %.2f) closed, %.2f (%.1f) open\n",
           closed.rms, closed.ratio, open.rms, open.ratio);
    assert_true(closed.rms < 0.25);
    assert_true(fabs(closed.ratio - 1.0) < 0.2);
    assert_true(open.ratio > 2.0);
    assert_true(part.ratio > closed.ratio && part.ratio < open.ratio);
}

static void latlong_cameras_are_found(void **state)
{
    (void)state;
    scene s = room(true, true);
    for (int k = 0; k < 4; k++) {
        latlong_camera wanted = {.eye = v3(2.3, 1.1, 1.4), .up = k / 2 ? 1 : 2, .start = 0.4 + 1.3 * k, .sense = k % 2 ? 1 : -1},
                       c;
        float *p = around(&s, &wanted);
        assert_true(latlong_fit(p, AROUND_W, AROUND_H, &c));
        assert_true(c.up == wanted.up && c.sense == wanted.sense && c.error < 0.1);
        assert_true(v3_length(v3_sub(c.eye, wanted.eye)) < 0.01);
        // The lower half of the same picture, stretched: no lat-long camera.
        memmove(p, p + 3 * AROUND_W * AROUND_H / 2, sizeof *p * 3 * AROUND_W * AROUND_H / 2);
        assert_false(latlong_fit(p, AROUND_W, AROUND_H, &c));
        free(p);
    }
}

// The window is behind the eye; a lat-long picture from another place shows it.
static void another_view_shows_the_window(void **state)
{
    (void)state;
    scene s = room(true, true);
    s.eye = v3(2, 4.6, 1.4), s.target = v3(1.8, 0, 1.1);
    latlong_camera c = {.eye = v3(1.2, 2.2, 1.3), .up = 2, .start = 1.0, .sense = -1};
    world_view v = view_around(&s, &c);
    light without = light_of(&s, 0.0, NULL), with = light_of(&s, 0.0, &v);
    printf("figure: room with its window behind the eye: radiance %.3f of the truth's rms without and %.3f (means %.2f) with "
           "another "
           "view\n",
           without.rms, with.rms, with.ratio);
    assert_true(without.rms == 1.0);
    assert_true(with.rms < 0.35);
    assert_true(fabs(with.ratio - 1.0) < 0.2);
    world_view_free(&v);
}

// The same picture shows what is lit beside the window, behind the eye, too: the bounce comes from there.
static void another_view_sends_light(void **state)
{
    (void)state;
    scene s = room(true, true);
    s.eye = v3(2, 4.6, 1.4), s.target = v3(1.8, 0, 1.1);
    latlong_camera c = {.eye = v3(1.2, 2.2, 1.3), .up = 2, .start = 1.0, .sense = -1};
    world_view v = view_around(&s, &c);
    light got = light_in(&s, 0.0, &v, LAYER_INDIRECT);
    printf("figure: its bounce: %.3f of the truth's rms (means %.2f)\n", got.rms, got.ratio);
    assert_true(got.rms < 0.35);
    assert_true(fabs(got.ratio - 1.0) < 0.2);
    world_view_free(&v);
}

// No background is in view, so nothing comes in. In particular the filter of the suns lends no light from surfaces that face
// away.
static void a_closed_place_is_black(void **state)
{
    (void)state;
    enum { W = 96, H = 64, ENV_W = 256, ENV_H = 128 };
    static rig r;
    static float sky[3 * ENV_W * ENV_H];
    error e = {0};
    gbuffer gb;
    frame_result out;
    scene s = {.eye = v3(0.5, -3, 4), .target = v3(0, 0, 0.3), .radius = 0.5};
    for (int i = 0; i < 3 * ENV_W * ENV_H; i++) sky[i] = 0.2f;
    for (int k = 0; k < 3; k++) sky[3 * (30 * ENV_W + 40) + k] = 1000.0f;
    must(rig_open(&r, NULL, &e), &e);
    must(environment_prepare(sky, ENV_W, ENV_H, &(env_options){.path = "sun", .up_z = true, .scale = 1.0}, &r.job.light.env,
                             &r.log, &e),
         &e);
    r.job.light.loaded = true;
    must(pass_upload_environment(&r.job.g, &r.job.light.env, &r.job.light.image, &e), &e);
    scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), grey);
    scene_add_box(&s, v3(0, 0, 0.4), v3(0.4, 0.3, 0.4), 20.0, grey);
    look(&s, W, H, 30.0, &gb);
    assert_int_equal(gb.valid, W * H);
    pass_settings set = rig_settings(method_find("arc"), 0.5);
    set.thickness = 0.1, set.planes = true, set.blur = 4, set.outside = openness_even(0.0);
    must(rig_run(&r, &gb, method_find("arc"), &set, 1 << LAYER_RADIANCE | 1 << LAYER_INDIRECT, &out, &e), &e);
    for (int i = 0; i < 3 * W * H; i++)
        assert_true(out.layers[LAYER_RADIANCE][i] == 0.0f && out.layers[LAYER_INDIRECT][i] == 0.0f);
    rig_free_result(&out);
    gbuffer_free(&gb);
    rig_close(&r);
}

// Where all directions are as open, the box that they are looked up in does not matter: not one without a width, not one about
// the very point that looks, not one far away.
static void any_box_will_do(void **state)
{
    (void)state;
    enum { W = 48, H = 32 };
    static rig r;
    error e = {0};
    gbuffer gb;
    frame_result out;
    float *usual = NULL;
    scene s = {.eye = v3(0, 0, 2), .target = v3(0, 0.01, 0), .radius = 0.5};
    scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), grey);
    look(&s, W, H, 30.0, &gb);
    must(rig_open(&r, &(env_options){.scale = 1.0}, &e), &e);
    const vec3 seen = v3_add(gb.camera.origin, m3_apply(gb.camera.world_from_camera, gbuffer_position(&gb, W / 2, H / 2)));
    const vec3 boxes[][2] = {{{-1, -1, -1}, {1, 1, 1}},
                             {{-1, -1, 0}, {1, 1, 0}},
                             {seen, seen},
                             {{0, 0, 0}, {0, 0, 0}},
                             {{1e25, 1e25, 1e25}, {2e25, 2e25, 2e25}},
                             {{-1e25, -1e25, -1e25}, {1e25, 1e25, 1e25}}};
    for (size_t b = 0; b < sizeof boxes / sizeof *boxes; b++) {
        pass_settings set = rig_settings(method_find("arc"), 0.5);
        set.planes = false, set.outside = openness_even(0.5);
        set.outside.low = boxes[b][0], set.outside.high = boxes[b][1];
        must(rig_run(&r, &gb, method_find("arc"), &set, 1 << LAYER_RADIANCE, &out, &e), &e);
        if (b == 0) usual = out.layers[LAYER_RADIANCE], out.layers[LAYER_RADIANCE] = NULL;
        for (int i = 0; b > 0 && i < 3 * W * H; i++)
            assert_true(fabsf(out.layers[LAYER_RADIANCE][i] - usual[i]) < 1e-5f && usual[i] > 0.3f);
        rig_free_result(&out);
    }
    free(usual);
    gbuffer_free(&gb);
    rig_close(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roofs),
        cmocka_unit_test(openings),
        cmocka_unit_test(ground_is_outdoors),
        cmocka_unit_test(cracks_are_no_openings),
        cmocka_unit_test(texels_have_their_directions),
        cmocka_unit_test(light_comes_through_the_window),
        cmocka_unit_test(a_closed_place_is_black),
        cmocka_unit_test(any_box_will_do),
        cmocka_unit_test(latlong_cameras_are_found),
        cmocka_unit_test(another_view_shows_the_window),
        cmocka_unit_test(another_view_sends_light),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
