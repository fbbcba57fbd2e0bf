// The machinery in tests/lib: the brute-force truth (reference B) against closed forms, and the exact pictures of scenes.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "../lib/near.h"
#include "../lib/scene_picture.h"
#include "../lib/truth.h"
#include "light/environment.h"

#define RADIANS(degrees) ((degrees) * (M_PI / 180.0))

// --- Truth against closed forms ---

static double traced(const scene *s, double radius)
{
    tracer t = scene_tracer(s);
    return truth_occlusion(&t, s->point, v3(0, 0, 1), &(truth_options){.radius = radius, .rays = 40000});
}

static void wall_agrees_with_its_closed_form(void **state)
{
    (void)state;
    for (double a = 15.0; a < 180.0; a += 30.0) {
        scene s;
        scene_wall(&s, a, 0.3);
        assert_near(traced(&s, INFINITY), truth_wall(RADIANS(a)), 0.003);
        assert_near(traced(&s, 1.0), truth_wall_cutoff(RADIANS(a), 0.3, 1.0), 0.003);
        assert_near(traced(&s, 0.31), truth_wall_cutoff(RADIANS(a), 0.3, 0.31), 0.003);
    }
}

static void corner_agrees_with_its_closed_form(void **state)
{
    (void)state;
    for (double x = 0.05; x < 1.1; x += 0.2) {
        scene s;
        scene_corner(&s, x);
        assert_near(traced(&s, 1.0), truth_corner(x, 1.0), 0.003);
        assert_near(truth_wall_cutoff(M_PI_2, x, 1.0), truth_corner(x, 1.0), 1e-12);
    }
}

static void sphere_agrees_with_its_closed_form(void **state)
{
    (void)state;
    // Floating, resting, and half sunk: the last two show a sphere cut by the horizon.
    const double cases[][3] = {{0.5, 1.0, 0.7}, {0.5, 0.5, 0.9}, {0.5, 0.2, 0.6}, {0.5, -0.2, 0.6}, {0.5, 2.0, 0.0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        scene s;
        scene_sphere(&s, cases[i][0], cases[i][1], cases[i][2]);
        assert_near(traced(&s, INFINITY), truth_sphere(cases[i][0], cases[i][1], cases[i][2]), 0.003);
    }
    assert_near(truth_sphere(0.5, 1.0, 0.7), 1.0 - 0.25 * 1.0 / pow(1.49, 1.5), 1e-12); // r^2 h / d^3 above the horizon
}

static void slit_bar_and_patch_agree_with_their_closed_forms(void **state)
{
    (void)state;
    scene s;
    scene_slit(&s, 0.4, 0.7);
    assert_near(traced(&s, INFINITY), truth_slit(0.4, 0.7, 0.0), 0.003);
    s.point.y = 0.15;
    assert_near(traced(&s, INFINITY), truth_slit(0.4, 0.7, 0.15), 0.003);
    for (double y = -0.6; y < 1.0; y += 0.3) {
        scene_bar(&s, 0.2, 0.3, 0.5, y);
        assert_near(traced(&s, INFINITY), truth_bar(0.2, 0.3, 0.5, y), 0.003);
    }
    scene_patches(&s, 2.0, 0.8);
    assert_near(traced(&s, INFINITY), truth_patch(2.0, 0.8), 0.003);
}

static void radiance_and_indirect_have_the_layers_units(void **state)
{
    (void)state;
    scene s;
    truth_options o = {.rays = 4096};
    scene_tilted_plane(&s, 30.0, 2.0);
    tracer t = scene_tracer(&s);
    assert_near3(truth_radiance(&t, s.point, v3(0, -cos(RADIANS(30)), 0.5), &o), v3(1, 1, 1), 1e-12);
    // An endless corner: both sides see half the sky, and half of what one side sees is the other.
    scene_corner(&s, 0.4);
    assert_near3(truth_radiance(&t, s.point, v3(0, 0, 1), &o), v3(0.5, 0.5, 0.5), 0.005);
    assert_near3(truth_indirect(&t, s.point, v3(0, 0, 1), &o), v3(0.25 * 0.8, 0.25 * 0.6, 0.25 * 0.4), 0.005);
    // A furnace: no light enters, and everything is blocked.
    scene_furnace(&s);
    assert_near(truth_occlusion(&t, s.point, v3(0, 0, 1), &o), 0.0, 0.0);
}

static vec3 sky_z(void *data, vec3 d)
{
    (void)data;
    return v3(fmax(0.0, d.z), d.x > 0.0, 1.0);
}

static void radiance_integrates_a_sky(void **state)
{
    (void)state;
    scene s = {.shape_count = 0};
    tracer t = scene_tracer(&s);
    // (1/pi) integral of cos^2 = 2/3; half the directions.
    assert_near3(truth_radiance(&t, v3(0, 0, 0), v3(0, 0, 1), &(truth_options){.rays = 16384, .sky = sky_z}),
                 v3(2.0 / 3.0, 0.5, 1), 0.003);
}

// --- Ray caster and pictures ---

static void mesh_and_box_agree(void **state)
{
    (void)state;
    vec3 corners[8];
    for (int i = 0; i < 8; i++) corners[i] = v3(i & 1 ? 0.5 : -0.5, i & 2 ? 0.3 : -0.3, i & 4 ? 0.2 : -0.2);
    static const int faces[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                     {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
    scene box = {.shape_count = 0}, triangles = {.shape_count = 0};
    scene_add_box(&box, v3(0, 0, 0), v3(0.5, 0.3, 0.2), 0.0, v3(1, 0, 0));
    scene_add_mesh(&triangles, (mesh){corners, 8, faces, 12}, v3(1, 0, 0));
    mat3 turn = rotation_about(v3_normalize(v3(1, 2, 3)), 40.0);
    scene_place(&box, 2.0, turn, v3(10, 20, 30));
    scene_place(&triangles, 2.0, turn, v3(10, 20, 30));
    view v = view_perspective(64, 48, 50.0, 1.0);
    view_look(&v, v3(12, 16, 32), v3(10, 20, 30), 15.0);
    int hits = 0;
    for (int i = 0; i < 64 * 48; i++) {
        hit a, b;
        bool ha = scene_at_pixel(&box, &v, i % 64, i / 64, &a), hb = scene_at_pixel(&triangles, &v, i % 64, i / 64, &b);
        assert_int_equal(ha, hb);
        if (!ha) continue;
        hits++;
        assert_near(a.t, b.t, 1e-9);
        assert_near3(a.normal, b.normal, 1e-9);
    }
    assert_in_range(hits, 300, 2500);
}

static const view *every_camera(int i)
{
    static view v;
    v = i % 2 ? view_orthographic(80, 60, 7.0, i == 3 ? 1.5 : 1.0) : view_perspective(80, 60, 55.0, i == 4 ? 0.5 : 1.0);
    if (i >= 2) {
        v.camera.cx += 11.25;
        v.camera.cy -= 7.5;
    }
    if (i >= 3) view_crop(&v, (box2){-5, 3, 70, 50});
    return &v;
}

static void pictures_reproject_onto_their_pixels(void **state)
{
    (void)state;
    scene s;
    scene_clutter(&s);
    for (int i = 0; i < 5; i++) {
        view v = *every_camera(i);
        view_look(&v, s.eye, s.target, 20.0 * i);
        picture p;
        gbuffer g;
        error e = {0};
        assert_true(scene_picture(&s, &v, &p, &e));
        assert_true(scene_gbuffer(&s, &v, &g, &e));
        for (int k = 0; k < p.width * p.height; k++) {
            assert_int_equal(p.valid[k], g.depth[k] > 0.0f);
            if (!p.valid[k]) continue;
            double x, y, z;
            const float *q = p.position + 3 * k;
            assert_true(view_project(&v, v3((double)q[0], (double)q[1], (double)q[2]), &x, &y, &z));
            assert_near(x, k % p.width + 0.5, 1e-3);
            assert_near(y, k / p.width + 0.5, 1e-3);
            assert_near(z, (double)p.depth[k], 1e-5);
            assert_near((double)g.depth[k], (double)p.depth[k], 0.0);
        }
        assert_true(g.valid > 1000);
        picture_free(&p);
        free(g.depth), free(g.normal), free(g.albedo);
    }
}

static void views_follow_the_camera_convention(void **state)
{
    (void)state;
    vec3 o, a, b;
    view v = view_perspective(100, 60, 90.0, 0.5);
    view_ray(&v, 100.0, 30.0, &o, &a);
    assert_near3(a, v3(1, 1, 0), 1e-12); // 45 degrees to the right at the right border, t is planar depth
    view_ray(&v, 50.0, 60.0, &o, &a);
    assert_near3(a, v3(0, 1, -1.2), 1e-12); // down; a pixel half as wide as tall: 60 rows are as high as 120 columns are wide
    v = view_orthographic(100, 60, 8.0, 2.0);
    view_ray(&v, 0.0, 0.0, &o, &a);
    assert_near3(o, v3(-4, 0, 1.2), 1e-12);
    assert_near3(a, v3(0, 1, 0), 1e-12);
    view_look(&v, v3(1, 2, 3), v3(1, 2, 0),
              90.0); // straight down with y up, rolled clockwise: the picture's right is the world's -y
    assert_near3(m3_apply(v.camera.world_from_camera, v3(1, 0, 0)), v3(0, -1, 0), 1e-12);
    assert_near(m3_det(v.camera.world_from_camera), 1.0, 1e-12);
    view cropped = v;
    view_crop(&cropped, (box2){-10, 5, 49, 80});
    assert_int_equal(cropped.width, 60);
    view_ray(&v, 20.5, 30.5, &o, &a);
    view_ray(&cropped, 30.5, 25.5, &b, &a);
    assert_near3(o, b, 1e-12);
}

static void placing_scene_and_camera_changes_no_picture(void **state)
{
    (void)state;
    scene s;
    scene_clutter(&s);
    for (int i = 0; i < 2; i++) {
        view v = *every_camera(i);
        view_scene(&v, &s);
        scene moved = s;
        view other = v;
        mat3 turn = rotation_about(v3_normalize(v3(3, -1, 2)), 77.0);
        scene_place(&moved, 100.0, turn, v3(1e5, -2e5, 3e4));
        view_place(&other, 100.0, turn, v3(1e5, -2e5, 3e4));
        for (int k = 0; k < v.width * v.height; k += 7) {
            hit a, b;
            bool hit_a = scene_at_pixel(&s, &v, k % v.width, k / v.width, &a);
            assert_int_equal(hit_a, scene_at_pixel(&moved, &other, k % v.width, k / v.width, &b));
            if (hit_a) assert_near(b.t, 100.0 * a.t, 1e-6);
        }
    }
}

static void exr_files_hold_the_picture_and_the_background(void **state)
{
    (void)state;
    scene s;
    scene_sphere(&s, 0.5, 0.5, 1.0);
    view v = view_perspective(40, 30, 60.0, 1.0);
    view_look(&v, v3(0, -3, 0.5), v3(0, 0, 0.6), 0.0);
    error e = {0};
    exrio_file *f = scene_file(&s, &v, &(scene_exr_options){.convention = "blender", .edge_samples = 4}, &e);
    assert_non_null(f);
    const exrio_part *part = &f->parts[0];
    assert_int_equal(part->channel_count, 14);
    assert_string_equal(part->channels[0].name, "ViewLayer.Position.X");
    assert_string_equal(part->channels[13].name, "ViewLayer.Depth.Z");
    const float *depth = part->channels[13].data, *py = part->channels[1].data, *alpha = part->channels[12].data;
    assert_float_equal(depth[0], 1e10f, 0.0f); // the sky
    assert_float_equal(py[0], 0.0f, 0.0f);
    int partial = 0;
    for (int i = 0; i < 40 * 30; i++) partial += alpha[i] > 0.0f && alpha[i] < 1.0f;
    assert_true(partial > 5); // filtered edges against the sky
    scene_file_free(f);
    assert_null(scene_file(&s, &v, &(scene_exr_options){.convention = "nonsense"}, &e));
    assert_int_equal(e.code, ERR_USAGE);
}

static void written_files_read_back(void **state)
{
    (void)state;
    scene s;
    scene_corner(&s, 0.5);
    view v = view_orthographic(24, 16, 3.0, 1.0);
    view_scene(&v, &s);
    view_crop(&v, (box2){-2, 1, 25, 14});
    char path[] = "/tmp/ssdo_scene_XXXXXX.exr";
    int fd = mkstemps(path, 4);
    assert_true(fd >= 0);
    close(fd);
    error e = {0};
    scene_exr_options o = {.convention = "plain", .half_position = true, .no_beauty = true, .radial_depth = true};
    if (!scene_write(&s, &v, &o, path, &e)) fail_msg("%s", e.message);
    exrio_file *wanted = scene_file(&s, &v, &o, &e), *got;
    assert_true(exrio_file_open(path, &got, &e));
    for (int c = 0; c < got->parts[0].channel_count; c++) got->parts[0].channels[c].wanted = true;
    assert_true(exrio_file_load(got, 1, &e));
    assert_true(box2_equal(got->parts[0].data_window, v.data_window));
    assert_true(box2_equal(got->parts[0].display_window, v.display_window));
    assert_int_equal(got->parts[0].channel_count, 10);
    for (int c = 0; c < 10; c++) {
        const exrio_channel *a = &wanted->parts[0].channels[c], *b = got->parts[0].channels;
        while (strcmp(a->name, b->name)) b++;
        assert_int_equal(a->type, b->type);
        assert_memory_equal(a->data, b->data, 28 * 14 * sample_size(a->type));
    }
    exrio_file_close(got);
    scene_file_free(wanted);
    unlink(path);
}

// The environment as the truth's sky: a white map gives 1.
static void an_environment_is_a_sky(void **state)
{
    (void)state;
    environment env;
    error e = {0};
    log_t log;
    log_init(&log, LOG_QUIET);
    if (!environment_load(&(env_options){.scale = 0.5, .up_z = true}, &env, &log, &e)) fail_msg("%s", e.message);
    scene s;
    scene_corner(&s, 0.5);
    tracer t = scene_tracer(&s);
    truth_options o = {.sky = truth_environment_sky, .sky_data = &env};
    assert_near3(truth_radiance(&t, s.point, v3(0, 0, 1), &o), v3(0.25, 0.25, 0.25), 0.005);
    environment_free(&env);
    log_free(&log);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wall_agrees_with_its_closed_form),
        cmocka_unit_test(corner_agrees_with_its_closed_form),
        cmocka_unit_test(sphere_agrees_with_its_closed_form),
        cmocka_unit_test(slit_bar_and_patch_agree_with_their_closed_forms),
        cmocka_unit_test(radiance_and_indirect_have_the_layers_units),
        cmocka_unit_test(radiance_integrates_a_sky),
        cmocka_unit_test(mesh_and_box_agree),
        cmocka_unit_test(pictures_reproject_onto_their_pixels),
        cmocka_unit_test(views_follow_the_camera_convention),
        cmocka_unit_test(placing_scene_and_camera_changes_no_picture),
        cmocka_unit_test(exr_files_hold_the_picture_and_the_background),
        cmocka_unit_test(written_files_read_back),
        cmocka_unit_test(an_environment_is_a_sky),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
