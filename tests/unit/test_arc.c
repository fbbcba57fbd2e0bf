// arc against closed forms, its planes and its bounce. The slice methods against their references: test_convergence, test_bias.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "must.h"
#include "rig.h"
#include "scene_picture.h"
#include "truth.h"

// --- Closed forms ---

// Mean occlusion of arc over the pixels around the scene's point, as far as they lie on the ground.
static double at_point(const scene *s, double radius, const char *name, double thickness, int samples)
{
    static rig r;
    error e = {0};
    must(rig_open(&r, NULL, &e), &e);
    view v = view_perspective(192, 144, 40.0, 1.0);
    view_scene(&v, s);
    gbuffer gb;
    frame_result out;
    must(scene_gbuffer(s, &v, &gb, &e), &e);
    pass_settings set = rig_settings(method_find(name), radius);
    set.samples = samples;
    set.thickness = thickness;
    must(rig_run(&r, &gb, method_find(name), &set, 1 << LAYER_OCCLUSION, &out, &e), &e);
    double x, y, sum = 0.0;
    assert_true(camera_project(&gb.camera, camera_from_world(&gb.camera, s->point), &x, &y));
    for (int k = 0; k < 25; k++) sum += (double)out.layers[LAYER_OCCLUSION][((int)y + k / 5 - 2) * gb.width + (int)x + k % 5 - 2];
    rig_free_result(&out);
    gbuffer_free(&gb);
    rig_close(&r);
    return sum / 25.0;
}

static void agrees(const char *what, double got, double wanted, double tolerance)
{
    print_message("%s: %.5f, error %+.5f\n", what, got, got - wanted);
    if (!(fabs(got - wanted) <= tolerance)) fail_msg("%s: got %.4f, wanted %.4f within %g", what, got, wanted, tolerance);
}

static void arc_agrees_with_closed_forms(void **state)
{
    (void)state;
    static const char *const names[] = {"arc", "gtao"};
    for (int i = 0; i < 2; i++) {
        scene s;
        for (double a = 60.0; a < 130.0; a += 30.0) {
            scene_wall(&s, a, 0.3);
            agrees("wall with cutoff", at_point(&s, 1.0, names[i], 0.5, 4096), truth_wall_cutoff(a * M_PI / 180.0, 0.3, 1.0),
                   0.01);
        }
        for (double x = 0.1; x < 1.1; x += 0.3) {
            scene_corner(&s, x);
            agrees("corner with cutoff", at_point(&s, 1.0, names[i], 0.5, 4096), truth_corner(x, 1.0), 0.01);
        }
    }
    scene s;
    scene_slit(&s, 0.4, 0.7);
    agrees("slit", at_point(&s, 10.0, "arc", 5.0, 4096), truth_slit(0.4, 0.7, 0.0), 0.02);
}

// --- Planes ---

static void planes_are_found_where_they_are(void **state)
{
    (void)state;
    scene s;
    scene_corner(&s, 0.5);
    view v = view_perspective(200, 150, 50.0, 1.0);
    view_scene(&v, &s);
    gbuffer gb;
    error e = {0};
    must(scene_gbuffer(&s, &v, &gb, &e), &e);
    plane_set found, again;
    must(planes_find(&gb, &found, &e) && planes_find(&gb, &again, &e), &e);
    assert_int_equal(found.count, 2);
    assert_memory_equal(&found, &again, sizeof found);
    const vec3 wanted[2] = {{0, 0, 1}, {0, -1, 0}}; // ground and wall, in either order
    for (int k = 0; k < 2; k++) {
        double best = -1.0, share = 0.0;
        for (int i = 0; i < 2; i++) {
            vec3 n = m3_apply(gb.camera.world_from_camera, found.planes[i].normal);
            best = fmax(best, v3_dot(n, wanted[k]));
            share += found.planes[i].share;
        }
        assert_true(best > 1.0 - 1e-6);
        assert_true(share > 0.99);
    }
    gbuffer_free(&gb);
}

// A plane with bumps of a share of the depth and swaying normals.
static plane_set uneven(double bumps, double sway)
{
    scene s = {0};
    scene_tilted_plane(&s, 20.0, 10.0);
    view v = view_perspective(200, 150, 40.0, 1.0);
    gbuffer gb;
    error e = {0};
    plane_set found;
    must(scene_gbuffer(&s, &v, &gb, &e), &e);
    for (int i = 0; i < gb.width * gb.height; i++) {
        double x = 0.21 * (i % gb.width), y = 0.17 * (i / gb.width);
        float *n = gb.normal + 4 * i;
        vec3 m = v3_normalize(v3((double)n[0] + sway * cos(x), (double)n[1] + sway * sin(y), (double)n[2]));
        n[0] = (float)m.x, n[1] = (float)m.y, n[2] = (float)m.z;
        gb.depth[i] *= (float)(1.0 + bumps * (2.0 * fmod(x + 0.7 * y, 1.0) - 1.0));
    }
    must(planes_find(&gb, &found, &e), &e);
    gbuffer_free(&gb);
    return found;
}

static void uneven_ground_is_told_from_planes(void **state)
{
    (void)state;
    plane_set flat = uneven(0.0, 0.0), bumpy = uneven(0.03, 0.25), rugged = uneven(0.5, 0.25);
    assert_int_equal(flat.count, 1);
    assert_int_equal(flat.uneven, 0);
    assert_int_equal(bumpy.uneven, 1);
    plane ground = bumpy.planes[bumpy.count];
    assert_true(v3_dot(ground.normal, flat.planes[0].normal) > cos(3.0 * M_PI / 180.0));
    assert_true(fabs(ground.offset / flat.planes[0].offset - 1.0) < 0.02);
    assert_int_equal(rugged.uneven, 0);
}

// A wall of 200 x 150 pixels, and a patch of w x h pixels that is parallel to it and stands before it.
static plane_set patch(int w, int h)
{
    scene s = {0};
    scene_tilted_plane(&s, 0.0, 10.0);
    view v = view_perspective(200, 150, 40.0, 1.0);
    gbuffer gb;
    error e = {0};
    plane_set found;
    must(scene_gbuffer(&s, &v, &gb, &e), &e);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) gb.depth[(y + 75 - h / 2) * gb.width + x + 100 - w / 2] *= 0.8f;
    must(planes_find(&gb, &found, &e), &e);
    gbuffer_free(&gb);
    return found;
}

static void belief_grows_with_the_plane(void **state)
{
    (void)state;
    double last = 0.0, jump = 0.0;
    for (int w = 6; w <= 100; w++) {
        plane_set found = patch(w, 14);
        double now = found.count > 1 ? found.planes[1].belief : 0.0;
        assert_true(found.planes[0].belief == 1.0 && now >= last);
        jump = fmax(jump, now - last);
        last = now;
    }
    assert_true(last == 1.0);
    assert_true(jump < 0.1);
}

static void a_line_of_samples_has_a_width(void **state)
{
    (void)state;
    plane_set found = patch(200, 1);
    assert_int_equal(found.count, 2);
    const double *extent = found.planes[1].extent;
    assert_true(fmin(extent[0], extent[1]) > 0.0 && fmin(extent[0], extent[1]) < 0.01 * fmax(extent[0], extent[1]));
}

// A box on the ground, the camera above it: from the far side of the ground nothing of the box's back is seen, and nothing but
// the ground is a large plane. With a wall that the box hides in part, the wall's plane must darken what it may darken only.
static void planes_never_touch_an_empty_plane(void **state)
{
    (void)state;
    rig r;
    error e = {0};
    must(rig_open(&r, NULL, &e), &e);
    for (double tilt = 0.0; tilt < 89.0; tilt += 22.0) {
        scene s = {0};
        scene_tilted_plane(&s, tilt, 10.0);
        view v = view_perspective(96, 64, 60.0, 1.0);
        gbuffer gb;
        frame_result out;
        must(scene_gbuffer(&s, &v, &gb, &e), &e);
        pass_settings set = rig_settings(method_find("arc"), 5.0);
        set.planes = true;
        must(rig_run(&r, &gb, method_find("arc"), &set, 1 << LAYER_OCCLUSION, &out, &e), &e);
        for (int i = 0; i < gb.width * gb.height; i++) assert_true(out.layers[LAYER_OCCLUSION][i] == 1.0f);
        rig_free_result(&out);
        gbuffer_free(&gb);
    }
    rig_close(&r);
}

// The ground between the viewer and a low screen-filling wall: what the frame cuts off, the wall's plane gives back.
static void a_plane_goes_on_beyond_the_frame(void **state)
{
    (void)state;
    scene s;
    scene_corner(&s, 0.3);
    view v = view_perspective(160, 120, 40.0, 1.0);
    view_look(&v, v3(0, -1.0, 2.0), v3(0, -0.3, 0), 0.0); // looks down: only a strip of the wall is inside
    rig r;
    error e = {0};
    must(rig_open(&r, NULL, &e), &e);
    gbuffer gb;
    must(scene_gbuffer(&s, &v, &gb, &e), &e);
    double x, y, seen[2];
    assert_true(camera_project(&gb.camera, camera_from_world(&gb.camera, v3(0, -0.3, 0)), &x, &y));
    for (int planes = 0; planes < 2; planes++) {
        frame_result out;
        pass_settings set = rig_settings(method_find("arc"), 3.0);
        set.planes = planes;
        set.samples = 1024;
        must(rig_run(&r, &gb, method_find("arc"), &set, 1 << LAYER_OCCLUSION, &out, &e), &e);
        seen[planes] = (double)out.layers[LAYER_OCCLUSION][(int)y * gb.width + (int)x];
        rig_free_result(&out);
    }
    double truth = truth_corner(0.3, 3.0);
    print_message("beyond the frame: without planes %.3f, with %.3f, truth %.3f\n", seen[0], seen[1], truth);
    assert_true(fabs(seen[1] - truth) < 0.03);
    assert_true(fabs(seen[1] - truth) <= fabs(seen[0] - truth));
    gbuffer_free(&gb);
    rig_close(&r);
}

// --- Light ---

// The bounce of arc: bounded by what is blocked times the brightest sender, for any number of samples, also at a corner.
static void bounce_is_bounded(void **state)
{
    (void)state;
    rig r;
    error e = {0};
    must(rig_open(&r, &(env_options){.up_z = true, .scale = 1.0}, &e), &e);
    scene s;
    scene_corner(&s, 0.01);
    view v = view_perspective(96, 72, 50.0, 1.0);
    view_scene(&v, &s);
    gbuffer gb;
    must(scene_gbuffer(&s, &v, &gb, &e), &e);
    for (int n = 8; n <= 2048; n *= 4)
        for (int planes = 0; planes < 2; planes++) {
            frame_result out;
            pass_settings set = rig_settings(method_find("arc"), s.radius);
            set.samples = n;
            set.planes = planes;
            must(rig_run(&r, &gb, method_find("arc"), &set, 1 << LAYER_RADIANCE | 1 << LAYER_INDIRECT, &out, &e), &e);
            double most = 0.0;
            for (int i = 0; i < 3 * gb.width * gb.height; i++) {
                double direct = (double)out.layers[LAYER_RADIANCE][i], indirect = (double)out.layers[LAYER_INDIRECT][i];
                if (direct + indirect > 1.0 + 1e-5) fail_msg("N=%d: %.6f + %.6f in a white sky", n, direct, indirect);
                most = fmax(most, indirect);
            }
            assert_true(most > 0.05);
            rig_free_result(&out);
        }
    gbuffer_free(&gb);
    rig_close(&r);
}

static int runs_of(const frame_result *r, const char *name)
{
    int n = 0;
    for (int i = 0; i < r->timing_count; i++) n += strcmp(r->timings[i].name, name) == 0;
    return n;
}

// A picture's light bounces in the march of the sky's light, at both sizes of the frame, to the bit as in a march of its own; and
// what nobody asked for is not marched for.
static void one_march_makes_the_layers_of_two(void **state)
{
    (void)state;
    enum { W = 96, H = 72 };
    enum { SKY = 1 << LAYER_RADIANCE, BOUNCE = 1 << LAYER_INDIRECT, VISIBILITY = 1 << LAYER_VISIBILITY };
    static float beauty[4 * W * H];
    rig lit, dark; // without light there is no march that the bounce could join
    error e = {0};
    must(rig_open(&lit, &(env_options){.up_z = true, .scale = 1.0}, &e), &e);
    must(rig_open(&dark, NULL, &e), &e);
    scene s;
    scene_clutter(&s);
    view v = view_perspective(W, H, 50.0, 1.0);
    view_scene(&v, &s);
    gbuffer gb;
    must(scene_gbuffer(&s, &v, &gb, &e), &e);
    for (int i = 0; i < 4 * W * H; i++) beauty[i] = (float)(i * 7919 % 1000) * 0.002f;
    gb.beauty = beauty;
    for (int half = 0; half < 2; half++) {
        frame_result both, sky, bounce;
        pass_settings set = rig_settings(method_find("arc"), s.radius);
        set.planes = true, set.relight = false, set.size = half ? SIZE_HALF : SIZE_FULL, set.blur = 3;
        lit.options.bounce = dark.options.bounce = "arc";
        must(rig_run(&lit, &gb, method_find("arc"), &set, SKY | BOUNCE | VISIBILITY, &both, &e), &e);
        must(rig_run(&lit, &gb, method_find("arc"), &set, SKY | VISIBILITY, &sky, &e), &e);
        must(rig_run(&dark, &gb, method_find("arc"), &set, BOUNCE, &bounce, &e), &e);
        assert_memory_equal(both.layers[LAYER_RADIANCE], sky.layers[LAYER_RADIANCE], 3 * W * H * sizeof(float));
        assert_memory_equal(both.layers[LAYER_VISIBILITY], sky.layers[LAYER_VISIBILITY], W * H * sizeof(float));
        assert_memory_equal(both.layers[LAYER_INDIRECT], bounce.layers[LAYER_INDIRECT], 3 * W * H * sizeof(float));
        assert_int_equal(runs_of(&both, "arc light+bounce"), 1);
        assert_int_equal(runs_of(&both, "arc light") + runs_of(&both, "arc bounce"), 0);
        assert_int_equal(runs_of(&sky, "arc light"), 1);
        assert_int_equal(runs_of(&bounce, "arc bounce"), 1);
        assert_int_equal(runs_of(&bounce, "arc light") + runs_of(&bounce, "arc light+bounce"), 0);
        rig_free_result(&both);
        rig_free_result(&sky);
        rig_free_result(&bounce);
    }
    gb.beauty = NULL;
    gbuffer_free(&gb);
    rig_close(&lit);
    rig_close(&dark);
}

// test_arc [FILTER]
int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arc_agrees_with_closed_forms),      cmocka_unit_test(planes_are_found_where_they_are),
        cmocka_unit_test(uneven_ground_is_told_from_planes), cmocka_unit_test(belief_grows_with_the_plane),
        cmocka_unit_test(a_line_of_samples_has_a_width),     cmocka_unit_test(planes_never_touch_an_empty_plane),
        cmocka_unit_test(a_plane_goes_on_beyond_the_frame),  cmocka_unit_test(bounce_is_bounded),
        cmocka_unit_test(one_march_makes_the_layers_of_two),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests_name("arc", tests, NULL, NULL);
}
