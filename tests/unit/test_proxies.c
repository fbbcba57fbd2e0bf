// --proxies: spheres the camera does not see, against closed forms and ray-cast truth; the file format.
// SSDO_UPDATE_SAMPLES=1 writes samples/proxies/.
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
#include "reference.h"
#include "rig.h"
#include "scene_picture.h"
#include "truth.h"

enum { LIGHT = 1 << LAYER_OCCLUSION | 1 << LAYER_RADIANCE, PIXELS = 150 };

static gbuffer shoot(const scene *s, const view *v)
{
    gbuffer gb;
    error e = {0};
    must(scene_gbuffer(s, v, &gb, &e), &e);
    return gb;
}

// The rig's frames carry no proxies of their own: this one filters with them.
static void run(rig *r, const gbuffer *gb, const char *name, pass_settings set, unsigned layers, proxy_set spheres,
                frame_result *out)
{
    error e = {0};
    r->proxies = spheres;
    must(rig_run(r, gb, method_find(name), &set, layers, out, &e), &e);
    out->proxies = (proxy_set){0}; // borrowed
}

// A ball over a plane, which the picture does not show.
typedef struct plane_and_ball {
    rig r;
    scene all; // with the ball
    gbuffer gb;
    tracer t;
} plane_and_ball;

static void open_plane(plane_and_ball *p, bool light, double fov, double plane_albedo, const sphere_proxy *ball)
{
    error e = {0};
    scene s = {0};
    must(rig_open(&p->r, light ? &(env_options){.up_z = true, .scale = 1.0} : NULL, &e), &e);
    scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), v3(plane_albedo, plane_albedo, plane_albedo));
    view v = view_perspective(40, 30, fov, 1.0);
    view_look(&v, v3(0.4, -4, 2.5), v3(0, 0, 0), 0.0);
    p->gb = shoot(&s, &v);
    p->all = s;
    if (ball) scene_add_sphere(&p->all, ball->centre, ball->radius, v3(ball->albedo[0], ball->albedo[1], ball->albedo[2]));
    p->t = scene_tracer(&p->all);
}

static void close_plane(plane_and_ball *p)
{
    gbuffer_free(&p->gb);
    rig_close(&p->r);
}

static vec3 world_at(const gbuffer *gb, int i)
{
    const camera *c = &gb->camera;
    return v3_add(c->origin, m3_apply(c->world_from_camera, gbuffer_position(gb, i % gb->width, i / gb->width)));
}

static void sphere_over_a_plane_is_exact(void **state)
{
    (void)state;
    static const double heights[] = {2.0, 0.6, 0.0, -0.3}; // of the centre: floating, standing, dipping into the ground
    rig r;
    error e = {0};
    must(rig_open(&r, &(env_options){.up_z = true, .scale = 1.0}, &e), &e);
    static const char *names[] = {"arc", "hemisphere"};
    for (size_t h = 0; h < 4; h++)
        for (int m = 0; m < 4; m++) {
            scene s = {0};
            frame_result out;
            scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), v3(0.5, 0.5, 0.5));
            view v = m & 1 ? view_orthographic(90, 60, 5.0, 1.0) : view_perspective(90, 60, 50.0, 1.0);
            view_look(&v, v3(0.4, -4, 2.5), v3(0, 0, 0), 10.0);
            gbuffer gb = shoot(&s, &v);
            sphere_proxy ball = {v3(0.2, 0.1, heights[h]), 0.6, {0.5, 0.5, 0.5}};
            pass_settings set = rig_settings(method_find(names[m / 2]), 1e4);
            set.samples = 16;
            run(&r, &gb, names[m / 2], set, LIGHT, (proxy_set){&ball, 1}, &out);
            double worst = 0.0, least = 1.0;
            for (int i = 0; i < 90 * 60; i++) {
                vec3 w = world_at(&gb, i);
                if (gb.depth[i] <= 0.0f || hypot(w.x - 0.2, w.y - 0.1) < 0.65) continue;
                double truth = truth_sphere(0.6, heights[h], hypot(w.x - 0.2, w.y - 0.1));
                worst = fmax(worst, fabs((double)out.layers[LAYER_OCCLUSION][i] - truth) / truth);
                worst = fmax(worst, fabs((double)out.layers[LAYER_RADIANCE][3 * i + 1] - truth) / truth);
                least = fmin(least, truth);
            }
            print_message("%s, height %.1f: off by %.2g of the analytic value at most, which goes down to %.3f\n", names[m / 2],
                          heights[h], worst, least);
            assert_true(worst < 1e-3 && least < 0.96);
            rig_free_result(&out);
            gbuffer_free(&gb);
        }
    rig_close(&r);
}

// Only the part of the sphere within the radius counts.
static void reach_ends_at_the_radius(void **state)
{
    (void)state;
    static plane_and_ball p;
    frame_result out;
    sphere_proxy ball = {v3(0, 0, 1.0), 0.6, {0.5, 0.5, 0.5}};
    open_plane(&p, false, 40.0, 0.5, &ball);
    for (double radius = 0.5; radius < 1.4; radius += 0.2) {
        run(&p.r, &p.gb, "arc", rig_settings(method_find("arc"), radius), 1 << LAYER_OCCLUSION, (proxy_set){&ball, 1}, &out);
        for (int i = 7; i < 40 * 30; i += 53) {
            truth_options o = {.radius = radius, .rays = 10000, .offset = 1e-5, .seed = 1};
            if (p.gb.depth[i] <= 0.0f) continue;
            assert_near((double)out.layers[LAYER_OCCLUSION][i], truth_occlusion(&p.t, world_at(&p.gb, i), v3(0, 0, 1), &o),
                        0.006);
        }
        rig_free_result(&out);
    }
    close_plane(&p);
}

// A sphere's light arrives: against the ray-cast bounce under a white sky.
static void spheres_send_light(void **state)
{
    (void)state;
    static plane_and_ball p;
    frame_result out;
    sphere_proxy ball = {v3(0, 0, 1.1), 0.6, {0.8, 0.4, 0.1}};
    open_plane(&p, true, 50.0, 0.0, &ball);
    pass_settings set = rig_settings(method_find("arc"), 2.0);
    p.r.options.bounce = "arc";
    run(&p.r, &p.gb, "arc", set, LIGHT | 1 << LAYER_INDIRECT, (proxy_set){&ball, 1}, &out);
    double got[3] = {0}, truth[3] = {0};
    for (int i = 7; i < 40 * 30; i += 31) {
        truth_options o = {.rays = 900, .bounce_rays = 64, .offset = 1e-5, .seed = 3};
        if (p.gb.depth[i] <= 0.0f) continue;
        vec3 w = truth_indirect(&p.t, world_at(&p.gb, i), v3(0, 0, 1), &o);
        const float *x = out.layers[LAYER_INDIRECT] + 3 * i;
        got[0] += (double)x[0], got[1] += (double)x[1], got[2] += (double)x[2];
        truth[0] += w.x, truth[1] += w.y, truth[2] += w.z;
    }
    print_message("bounce of a sphere: %.3f %.3f %.3f of the truth\n", got[0] / truth[0], got[1] / truth[1], got[2] / truth[2]);
    for (int k = 0; k < 3; k++) assert_near(got[k] / truth[k], 1.0, 0.05);
    rig_free_result(&out);
    close_plane(&p);
}

// A second sphere behind the first, seen from every receiver, changes nothing; two apart block what each does alone.
static void what_two_block_counts_once(void **state)
{
    (void)state;
    static plane_and_ball p;
    frame_result a, b, both, twice;
    open_plane(&p, false, 40.0, 0.5, NULL);
    sphere_proxy left = {v3(-1.5, 0, 0.9), 0.5, {0}}, right = {v3(1.5, 0, 0.9), 0.5, {0}}, two[] = {left, right},
                 same[] = {left, left};
    pass_settings set = rig_settings(method_find("arc"), 1e4);
    run(&p.r, &p.gb, "arc", set, 1 << LAYER_OCCLUSION, (proxy_set){&left, 1}, &a);
    run(&p.r, &p.gb, "arc", set, 1 << LAYER_OCCLUSION, (proxy_set){&right, 1}, &b);
    run(&p.r, &p.gb, "arc", set, 1 << LAYER_OCCLUSION, (proxy_set){two, 2}, &both);
    run(&p.r, &p.gb, "arc", set, 1 << LAYER_OCCLUSION, (proxy_set){same, 2}, &twice);
    for (int i = 0; i < 40 * 30; i++) {
        double x = (double)a.layers[LAYER_OCCLUSION][i], y = (double)b.layers[LAYER_OCCLUSION][i];
        assert_near((double)twice.layers[LAYER_OCCLUSION][i], x, 1e-6);
        assert_near((double)both.layers[LAYER_OCCLUSION][i], x + y - 1.0, 1e-6);
    }
    rig_free_result(&a), rig_free_result(&b), rig_free_result(&both), rig_free_result(&twice);
    close_plane(&p);
}

// ---- the example: a crate that hangs beside the picture, out of the camera's sight, as four spheres

static void seen(scene *s)
{
    scene_add_plane(s, v3(0, 0, 0), v3(0, 0, 1), v3(0.6, 0.6, 0.6));
    scene_add_box(s, v3(0.5, 0.2, 0.25), v3(0.2, 0.3, 0.25), 25.0, v3(0.2, 0.4, 0.7));
    scene_add_sphere(s, v3(-0.1, -0.4, 0.15), 0.15, v3(0.7, 0.3, 0.2));
}

static void unseen(scene *s) { scene_add_box(s, v3(-1.3, -0.3, 0.75), v3(0.35, 0.5, 0.4), 0.0, v3(0.7, 0.6, 0.4)); }

static int stand_ins(sphere_proxy *list)
{
    int n = 0;
    for (int y = -1; y <= 1; y++)
        for (int z = 0; z < 2; z++) list[n++] = (sphere_proxy){v3(-1.15, 0.44 * y, 0.58 + 0.34 * z), 0.32, {0.7, 0.6, 0.4}};
    return n;
}

static view example_view(void)
{
    view v = view_perspective(240, 160, 38.0, 1.0);
    view_look(&v, v3(0.3, -3.0, 1.5), v3(0.25, 0, 0.1), 0.0);
    return v;
}

static void write_example(const scene *s, const view *v, const sphere_proxy *list, int count)
{
    error e = {0};
    must(scene_write(s, v, &(scene_exr_options){.convention = "blender", .compression = 3}, "samples/proxies/beside.exr", &e),
         &e);
    FILE *f = fopen("samples/proxies/beside.json", "w");
    assert_non_null(f);
    fprintf(f, "{\n  \"spheres\": [\n");
    for (int i = 0; i < count; i++)
        fprintf(f, "    {\"centre\": [%g, %g, %g], \"radius\": %g, \"albedo\": [%g, %g, %g]}%s\n", list[i].centre.x,
                list[i].centre.y, list[i].centre.z, list[i].radius, list[i].albedo[0], list[i].albedo[1], list[i].albedo[2],
                i + 1 < count ? "," : "");
    fprintf(f, "  ]\n}\n");
    fclose(f);
}

typedef struct errors {
    double occlusion, radiance, indirect;
} errors;

static errors errors_of(const frame_result *out, const pixel *pixels, int n, vec3 truth[][3])
{
    errors x = {0};
    double scale[3] = {0};
    for (int k = 0; k < n; k++) {
        int i = pixels[k].y * out->gb.width + pixels[k].x;
        double o = (double)out->layers[LAYER_OCCLUSION][i] - truth[k][0].x,
               r = (double)out->layers[LAYER_RADIANCE][3 * i] - truth[k][1].x,
               b = (double)out->layers[LAYER_INDIRECT][3 * i] - truth[k][2].x;
        x.occlusion += o * o, x.radiance += r * r, x.indirect += b * b;
        for (int c = 0; c < 3; c++) scale[c] += truth[k][c].x;
    }
    return (errors){sqrt(x.occlusion / n), sqrt(x.radiance / n) / (scale[1] / n), sqrt(x.indirect / n) / (scale[2] / n)};
}

static void the_example_moves_towards_truth(void **state)
{
    (void)state;
    rig r;
    scene s = {0}, all = {0};
    error e = {0};
    layer l;
    static pixel pixels[PIXELS];
    static vec3 truth[PIXELS][3];
    sphere_proxy list[16];
    const double radius = 1.5;
    must(rig_open(&r, &(env_options){.up_z = true, .scale = 1.0}, &e), &e);
    seen(&s), seen(&all), unseen(&all);
    int count = stand_ins(list);
    view v = example_view();
    gbuffer gb = shoot(&s, &v);
    gbuffer whole = shoot(&all, &v); // with the crate: the same picture, for the camera does not see it
    assert_memory_equal(gb.depth, whole.depth, 240 * 160 * sizeof(float));
    must(layer_build(&gb, &l, &e), &e);
    int n = reference_pixels(&l, PIXELS, pixels);
    tracer t = scene_tracer(&all);
    for (int k = 0; k < n; k++) {
        int i = pixels[k].y * 240 + pixels[k].x;
        const float *c = gb.normal + 4 * i;
        vec3 normal = m3_apply(gb.camera.world_from_camera, v3((double)c[0], (double)c[1], (double)c[2]));
        vec3 at = v3_add(world_at(&gb, i), v3_scale(normal, 1e-5));
        truth_options near = {.radius = radius, .rays = 1600, .seed = 5}, far = {.rays = 1600, .bounce_rays = 36, .seed = 6};
        truth[k][0].x = truth_occlusion(&t, at, normal, &near);
        truth[k][1] = truth_radiance(&t, at, normal, &far);
        truth[k][2] = truth_indirect(&t, at, normal, &far);
    }
    frame_result without, with;
    pass_settings set = rig_settings(method_find("arc"), radius);
    set.thickness = 0.3 * radius, set.planes = true, set.samples = 256, set.blur = 4;
    r.options.bounce = "arc";
    run(&r, &gb, "arc", set, LIGHT | 1 << LAYER_INDIRECT, (proxy_set){0}, &without);
    run(&r, &gb, "arc", set, LIGHT | 1 << LAYER_INDIRECT, (proxy_set){list, count}, &with);
    errors a = errors_of(&without, pixels, n, truth), b = errors_of(&with, pixels, n, truth);
    printf("figure: proxies: occlusion rmse %.4f -> %.4f, radiance relative rmse %.3f -> %.3f, indirect %.2f -> %.2f\n",
           a.occlusion, b.occlusion, a.radiance, b.radiance, a.indirect, b.indirect);
    assert_true(b.occlusion < 0.65 * a.occlusion);
    assert_true(b.radiance < 0.5 * a.radiance);
    assert_true(b.indirect < 0.9 * a.indirect); // .84; .79 if what is hidden sent all that its cover does
    if (getenv("SSDO_UPDATE_SAMPLES")) write_example(&s, &v, list, count);
    rig_free_result(&without), rig_free_result(&with);
    layer_free(&l);
    gbuffer_free(&gb), gbuffer_free(&whole);
    rig_close(&r);
}

// ---- files

static void put(const char *path, const char *text)
{
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static void files_are_read_or_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *complaint;
    } bad[] = {{"{", "JSON"},
               {"[]", "one JSON object"},
               {"{\"sphere\": []}", "\"spheres\""},
               {"{\"spheres\": [{\"centre\": [1, 2], \"radius\": 1}]}", "sphere 1 needs a \"centre\""},
               {"{\"spheres\": [{\"centre\": [1, 2, 3], \"radius\": 0}]}", "\"radius\" above 0"},
               {"{\"spheres\": [{\"centre\": [1, 2, 3], \"radius\": 1}, 7]}", "sphere 2 is not"},
               {"{\"spheres\": [{\"centre\": [1, 2, 3], \"radius\": 1, \"albedo\": 2}]}", "\"albedo\""}};
    char path[64];
    snprintf(path, sizeof path, "/tmp/ssdo_proxies_%d.json", (int)getpid());
    proxy_set set;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        error e = {0};
        put(path, bad[i].text);
        assert_false(proxies_load(path, &set, &e));
        assert_int_equal(e.code, ERR_USAGE);
        assert_string_equal(e.file, path);
        if (!strstr(e.message, bad[i].complaint)) fail_msg("'%s' does not say '%s'", e.message, bad[i].complaint);
    }
    error e = {0};
    put(path, "{\"spheres\": [{\"centre\": [1, 2, 3.5], \"radius\": 4}, {\"centre\": [0, 0, 0], \"radius\": 1, \"albedo\": [0.1, "
              "0.2, 0.3]}]}");
    must(proxies_load(path, &set, &e), &e);
    assert_int_equal(set.count, 2);
    assert_near3(set.spheres[0].centre, v3(1, 2, 3.5), 0.0);
    assert_near(set.spheres[0].radius, 4.0, 0.0);
    assert_near(set.spheres[0].albedo[2], 0.5, 0.0);
    assert_near(set.spheres[1].albedo[2], 0.3, 0.0);
    proxies_free(&set);
    remove(path);
    assert_false(proxies_load(path, &set, &e));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_read_or_refused),  cmocka_unit_test(sphere_over_a_plane_is_exact),
        cmocka_unit_test(reach_ends_at_the_radius),   cmocka_unit_test(spheres_send_light),
        cmocka_unit_test(what_two_block_counts_once), cmocka_unit_test(the_example_moves_towards_truth),
    };
    return cmocka_run_group_tests_name("proxies", tests, NULL, NULL);
}
