// What surfaces send that the camera does not see: what lights them, and that a surface does not light itself past something that
// stands before it.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "light/sh.h"
#include "must.h"
#include "outside_rooms.h"
#include "passes/hidden.h"
#include "rig.h"
#include "scene_picture.h"
#include "truth.h"

// Irradiance over pi that a white environment gives hidden faces, by normal.
static double light_in(const gbuffer *gb, const plane_set *planes, const openness *outside, vec3 normal)
{
    error e = {0};
    environment white;
    log_t log = {0};
    double sh[HIDDEN_SH][3];
    must(environment_load(&(env_options){.up_z = true, .scale = 1.0}, &white, &log, &e), &e);
    const mat3 upright = gb->camera.world_from_camera;
    const hidden_place at = {gb, planes, outside, upright, upright, gb->camera.origin};
    must(hidden_light(&white, &at, 2, sh, &e), &e);
    environment_free(&white);
    return sh_irradiance_over_pi((const double(*)[3])sh, normal).x;
}

static double light_of(const gbuffer *gb, const plane_set *planes, vec3 normal)
{
    const openness open = openness_even(1.0);
    return light_in(gb, planes, &open, normal);
}

static gbuffer ground_with_ball(double fov)
{
    scene s = {.eye = v3(0, -6, 3), .target = v3(0, 0, 0)};
    scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), grey);
    scene_add_sphere(&s, v3(0, 0, 0.6), 0.6, grey);
    gbuffer gb;
    look(&s, 160, 90, fov, &gb);
    return gb;
}

// Half of a white sphere: (1 + cos) / 2 of the angle from the zenith, by coefficients up to l = 2.
static void ground_blocks_half(void **state)
{
    (void)state;
    error e = {0};
    gbuffer gb = ground_with_ball(60.0);
    plane_set planes, none = {0};
    must(planes_find(&gb, &planes, &e), &e);
    assert_int_equal(planes.count, 1);
    for (int k = 0; k < 2; k++) planes.planes[0].extent[k] *= 1e3; // as far as one sees
    for (int i = 0; i <= 6; i++) {
        double angle = i * M_PI / 6.0;
        vec3 n = v3(sin(angle), 0, cos(angle));
        assert_true(fabs(light_of(&gb, &none, n) - 1.0) < 1e-3);
        assert_true(fabs(light_of(&gb, &planes, n) - 0.5 * (1.0 + cos(angle))) < 0.03);
    }
    planes.planes[0].normal = v3_scale(planes.planes[0].normal, -1.0);
    planes.planes[0].offset *= -1.0;
    planes.planes[0].offset += 0.5; // the middle of the surfaces lies behind it
    assert_true(fabs(light_of(&gb, &planes, v3(0, 0, 1)) - 1.0) < 1e-3);
    gbuffer_free(&gb);
}

// A plane that the picture shows to be absent somewhere lets light through there, and none blocks beyond what is believed.
static void planes_block_where_they_are(void **state)
{
    (void)state;
    error e = {0};
    gbuffer gb = ground_with_ball(60.0);
    plane_set planes;
    must(planes_find(&gb, &planes, &e), &e);
    plane *p = &planes.planes[0];
    double all = light_of(&gb, &planes, v3(0, 0, -1));
    memset(p->cells, 0, sizeof p->cells);
    double hole = light_of(&gb, &planes, v3(0, 0, -1));
    p->extent[0] = p->extent[1] = 1e-9;
    assert_true(all < hole - 0.2 && hole < light_of(&gb, &planes, v3(0, 0, -1)) + 1e-6);
    gbuffer_free(&gb);
}

// What the planes leave is as open as the outside: everywhere, or towards one side.
static void the_outside_counts(void **state)
{
    (void)state;
    error e = {0};
    gbuffer gb = ground_with_ball(60.0);
    plane_set planes;
    must(planes_find(&gb, &planes, &e), &e);
    openness covered = openness_even(0.1), side = openness_even(0.0);
    for (int i = 0; i <= 6; i++) {
        double angle = i * M_PI / 6.0;
        vec3 n = v3(sin(angle), 0, cos(angle));
        assert_true(fabs(light_in(&gb, &planes, &covered, n) - 0.1 * light_of(&gb, &planes, n)) < 1e-6);
    }
    side.share[2 + OPENNESS_COLUMNS] = side.share[2 + OPENNESS_COLUMNS + 1] = 1.0; // of the horizon, from -x on
    side.low = v3(-10, -10, -10), side.high = v3(10, 10, 10);
    const plane_set none = {0};
    assert_true(light_in(&gb, &none, &side, v3(-1, 0, 0)) > 4.0 * fabs(light_in(&gb, &none, &side, v3(1, 0, 0))));
    gbuffer_free(&gb);
}

// The grid of the openness: its points, the seam, the poles, between two points.
static void openness_between_points(void **state)
{
    (void)state;
    openness o = openness_even(0.0);
    for (int i = 0; i < OPENNESS_COUNT; i++) o.share[i] = 0.01 * i;
    const vec3 middle = v3(0, 0, 0);
    o.low = v3(-2, -2, -2), o.high = v3(2, 2, 2);
    assert_true(fabs(openness_towards(&o, middle, v3(0, 0, 1)) - o.share[0]) < 1e-9);
    assert_true(fabs(openness_towards(&o, middle, v3(0, 0, -1)) - o.share[1]) < 1e-9);
    for (int k = 0; k < OPENNESS_COLUMNS; k++) {
        double around = 2.0 * M_PI * (0.5 - (double)k / OPENNESS_COLUMNS);
        double *row = o.share + 2 + OPENNESS_COLUMNS, next = row[(k + 1) % OPENNESS_COLUMNS];
        assert_true(fabs(openness_towards(&o, middle, v3(cos(around), sin(around), 0)) - row[k]) < 1e-9);
        around -= M_PI / OPENNESS_COLUMNS;
        assert_true(fabs(openness_towards(&o, middle, v3(cos(around), sin(around), 0)) - 0.5 * (row[k] + next)) < 1e-9);
    }
    // From beside the +x wall, the way to +y leaves the box in its corner.
    double corner = openness_towards(&o, middle, v3(sqrt(0.5), sqrt(0.5), 0));
    assert_true(fabs(openness_towards(&o, v3(2, 0, 0), v3(0, 1, 0)) - corner) < 1e-9);
}

// Nothing to see and no plane is normal input.
static void empty_frames(void **state)
{
    (void)state;
    gbuffer gb = ground_with_ball(60.0);
    plane_set none = {0};
    memset(gb.depth, 0, (size_t)gb.width * (size_t)gb.height * sizeof *gb.depth);
    assert_true(fabs(light_of(&gb, &none, v3(0, 0, 1)) - 1.0) < 1e-3);
    gbuffer_free(&gb);
}

// Posts stand far before bright ground. Steps of the march that go from the ground to a post and back pass over what lies
// between.
static void far_ground_does_not_light_itself(void **state)
{
    (void)state;
    rig r;
    error e = {0};
    scene s = {.eye = v3(0, -8, 1.6), .target = v3(0, 0, 1.2)};
    scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), v3(0.9, 0.9, 0.9));
    for (int i = -2; i <= 2; i++) scene_add_box(&s, v3(1.6 * i, 0, 1.1), v3(0.15, 0.15, 1.1), 20.0, v3(0.02, 0.02, 0.02));
    gbuffer gb;
    frame_result out;
    must(rig_open(&r, &(env_options){.up_z = true, .scale = 1.0}, &e), &e);
    look(&s, 240, 136, 55.0, &gb);
    pass_settings set = rig_settings(method_find("arc"), 1.0);
    set.planes = true, set.blur = 4, set.thickness = 0.3;
    must(rig_run(&r, &gb, method_find("arc"), &set, 1 << LAYER_INDIRECT, &out, &e), &e);
    double sum = 0.0, n = 0.0;
    for (int i = 0; i < gb.width * gb.height; i++) {
        if (gb.depth[i] == 0.0f) continue;
        vec3 p = gbuffer_position(&gb, i % gb.width, i / gb.width);
        p = v3_add(m3_apply(gb.camera.world_from_camera, p), gb.camera.origin);
        if (p.z > 1e-3 || p.y < 6.0 || p.y > 30.0) continue; // not ground behind the posts
        sum += (double)out.layers[LAYER_INDIRECT][3 * i], n += 1.0;
    }
    assert_true(n > 100.0);
    tracer t = scene_tracer(&s);
    double truth = truth_indirect(&t, v3(0.4, 10, 0), v3(0, 0, 1), &(truth_options){.rays = 4096}).x;
    printf("figure: ground behind posts: indirect %.4f, truth of a point there %.4f\n", sum / n, truth);
    assert_true(truth < 0.002 && sum / n < 0.005);
    rig_free_result(&out);
    gbuffer_free(&gb);
    rig_close(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ground_blocks_half), cmocka_unit_test(planes_block_where_they_are),
        cmocka_unit_test(the_outside_counts), cmocka_unit_test(openness_between_points),
        cmocka_unit_test(empty_frames),       cmocka_unit_test(far_ground_does_not_light_itself),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
