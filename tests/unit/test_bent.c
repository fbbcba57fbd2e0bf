// The bent layer: the mean open direction of the cosine-weighted hemisphere, against closed forms, and its space.
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

#include "must.h"
#include "near.h"
#include "pipeline/frame.h"
#include "rig.h"
#include "scene_picture.h"

enum { BENT = 1 << LAYER_BENT | 1 << LAYER_OCCLUSION };

static gbuffer shoot(const scene *s, const view *v)
{
    gbuffer gb;
    error e = {0};
    must(scene_gbuffer(s, v, &gb, &e), &e);
    return gb;
}

static vec3 at(const float *v, int i) { return v3((double)v[3 * i], (double)v[3 * i + 1], (double)v[3 * i + 2]); }

static vec3 normal_of(const gbuffer *gb, int i)
{
    const float *n = gb->normal + 4 * i;
    return m3_apply(gb->normal_from_camera, v3((double)n[0], (double)n[1], (double)n[2]));
}

static void empty_plane_gives_the_normal(void **state)
{
    (void)state;
    static const double tilts[] = {0.0, 30.0, 60.0, 85.0};
    rig r;
    error e = {0};
    must(rig_open(&r, NULL, &e), &e);
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE))
        for (size_t t = 0; method_makes(m, MAKES_BENT) && t < sizeof tilts / sizeof *tilts; t++)
            for (int kind = 0; kind < 3; kind++) {
                scene s = {0};
                frame_result out;
                scene_tilted_plane(&s, tilts[t], 10.0);
                view v = kind == 1 ? view_orthographic(61, 40, 12.0, 1.0) : view_perspective(61, 40, 60.0, 1.0);
                gbuffer gb = shoot(&s, &v);
                pass_settings set = rig_settings(m, 1.0);
                set.samples = 16, set.size = kind == 2 ? SIZE_HALF : SIZE_FULL, set.blur = kind;
                must(rig_run(&r, &gb, m, &set, BENT, &out, &e), &e);
                for (int i = 0; i < 61 * 40; i++)
                    assert_near3(at(out.layers[LAYER_BENT], i), gb.depth[i] > 0.0f ? normal_of(&gb, i) : v3(0, 0, 0), 1e-6);
                rig_free_result(&out);
                gbuffer_free(&gb);
            }
    rig_close(&r);
}

// At distance x from the foot of a perpendicular wall, which blocks within R: 2/3 n minus the mean over the blocked directions,
// summed over the hemisphere. The wall rises at y = 0, the point lies at y = -x.
static vec3 corner_bent(double x, double radius)
{
    enum { STEPS = 800 };
    vec3 open = v3(0, 0, 0);
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; j < STEPS; j++) {
            double sine = sqrt((i + 0.5) / STEPS), phi = 2.0 * M_PI * (j + 0.5) / STEPS; // cosine-weighted
            vec3 w = v3(sine * cos(phi), sine * sin(phi), sqrt(1.0 - sine * sine));
            if (w.y <= 0.0 || x / w.y > radius) open = v3_add(open, w);
        }
    return v3_normalize(open);
}

// Angle in degrees between the layer's mean direction around the scene's point and the closed form.
static double off_at_corner(rig *r, const char *name, double x, double radius, int samples)
{
    scene s = {0};
    error e = {0};
    frame_result out;
    scene_corner(&s, x);
    view v = view_perspective(240, 180, 70.0, 1.0);
    view_look(&v, v3(0.4, -1.6, 0.9), v3(0, 0, 0.45), 0.0);
    gbuffer gb = shoot(&s, &v);
    const method *m = method_find(name);
    pass_settings set = rig_settings(m, radius);
    set.samples = samples, set.planes = true;
    if (strcmp(name, "arc") == 0) set.thickness = 0.3 * radius;
    must(rig_run(r, &gb, m, &set, BENT, &out, &e), &e);
    double px, py;
    vec3 sum = v3(0, 0, 0);
    assert_true(camera_project(&gb.camera, camera_from_world(&gb.camera, s.point), &px, &py));
    for (int dx = -20; dx <= 20; dx++) {
        int i = (int)py * gb.width + (int)px + dx;
        assert_near(v3_length(at(out.layers[LAYER_BENT], i)), 1.0, 1e-6);
        sum = v3_add(sum, at(out.layers[LAYER_BENT], i));
    }
    vec3 expected = corner_bent(x, radius);
    double off = acos(fmin(1.0, v3_dot(v3_normalize(sum), expected))) * 180.0 / M_PI;
    print_message("%s, x = %.2f, R = %g, %d samples: %.2f degrees off; the bent normal leans by %.1f\n", name, x, radius, samples,
                  off, acos(expected.z) * 180.0 / M_PI);
    rig_free_result(&out);
    gbuffer_free(&gb);
    return off;
}

static void corner_leans_as_it_should(void **state)
{
    (void)state;
    rig r;
    error e = {0};
    must(rig_open(&r, NULL, &e), &e);
    // Without a cutoff the lean is atan((2/3) / (pi/3)), 32.48 degrees.
    assert_near(acos(corner_bent(0.1, INFINITY).z) * 180.0 / M_PI, atan(2.0 / M_PI) * 180.0 / M_PI, 0.05);
    static const char *names[] = {"arc", "gtao", "bitmask"};
    for (int k = 0; k < 3; k++)
        for (int i = 1; i <= 3; i++) assert_true(off_at_corner(&r, names[k], 0.15 * i, 0.6, 2048) < 1.0);
    rig_close(&r);
}

// In the space of the file's normals: an empty plane's layer is the file's own normal, whatever that is written in.
static void space_is_the_normals(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        scene s = {0};
        error e = {0};
        options o;
        log_t log;
        job j;
        frame_result r;
        char input[64], output[64];
        snprintf(input, sizeof input, "/tmp/ssdo_bent_in_%d.exr", (int)getpid());
        snprintf(output, sizeof output, "/tmp/ssdo_bent_out_%d.exr", (int)getpid());
        scene_sphere(&s, 1.0, 1.0, 2.0);
        view v = view_perspective(90, 60, 50.0, 1.0);
        view_scene(&v, &s);
        scene_exr_options eo = {.convention = k == 0 ? "blender" : "plain", .camera_space = k == 2, .no_normal = k == 3};
        must(scene_write(&s, &v, &eo, input, &e), &e);
        options_defaults(&o);
        o.layers = "bent", o.radius_unit = RADIUS_WORLD, o.radius = 1e-4, o.output_float = true, o.fov = 50.0, o.blur = 0;
        log_init(&log, LOG_QUIET);
        job_open(&j, &o, &log);
        must(frame_run(&j, input, output, &r, &e), &e);
        // Nothing within 1e-4 of anything: every bent normal is the normal. In camera space y is up and z backwards.
        const gbuffer *gb = &r.gb;
        const mat3 y_up = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
        mat3 space = k == 2 ? y_up : v.camera.world_from_camera;
        int n = 0;
        for (int i = 0; i < 90 * 60; i++) {
            if (gb->depth[i] <= 0.0f) continue;
            const float *c = gb->normal + 4 * i;
            assert_near3(at(r.layers[LAYER_BENT], i), m3_apply(space, v3((double)c[0], (double)c[1], (double)c[2])), 2e-3);
            n++;
        }
        assert_true(n > 2000);
        frame_free(&r);
        job_close(&j);
        log_free(&log);
        remove(input), remove(output);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(empty_plane_gives_the_normal),
                                       cmocka_unit_test(corner_leans_as_it_should), cmocka_unit_test(space_is_the_normals)};
    return cmocka_run_group_tests_name("bent", tests, NULL, NULL);
}
