// What the file's own numbers lose: a world far from its origin, half floats, a position sampled off its pixel. The picture may
// lose what the numbers lost, and nothing more: the same rounded numbers moved back to the origin give the same picture.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/half.h"
#include "hard.h"
#include "passes/method.h"
#include "pipeline/frame.h"

enum { WIDTH = 96, HEIGHT = 72, PIXELS = WIDTH * HEIGHT };

static void set_method(hard *h, const method *m, double radius)
{
    options_defaults(&h->rig.options);
    h->rig.options.method = m->name;
    h->rig.options.layers = "occlusion,radiance";
    h->rig.options.radius_unit = RADIUS_WORLD;
    h->rig.options.radius = radius;
    h->rig.options.samples = m->samples < 64 ? m->samples : 64;
}

static exrio_file *clutter(bool with_depth)
{
    scene s;
    scene_clutter(&s);
    view v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&v, &s);
    return hard_file(&s, &v, &(scene_exr_options){.no_depth = !with_depth});
}

static const char *const axes[3] = {"P.X", "P.Y", "P.Z"};

// Every surface's P moved by `by` and rounded to float, then with `back` moved to where it was: the same loss near the origin.
static void move(exrio_file *f, vec3 by, bool back)
{
    const double d[3] = {by.x, by.y, by.z};
    float *p[3];
    for (int k = 0; k < 3; k++) p[k] = hard_channel(f, axes[k]);
    for (size_t i = 0; i < PIXELS; i++) {
        if (p[0][i] == 0.0f && p[1][i] == 0.0f && p[2][i] == 0.0f) continue;
        for (int k = 0; k < 3; k++) {
            float moved = (float)((double)p[k][i] + d[k]);
            p[k][i] = back ? (float)((double)moved - d[k]) : moved;
        }
    }
}

// Positions on a grid of 2^-12 units: moving them by a whole number of units up to 2^11 loses nothing.
static void put_on_grid(exrio_file *f)
{
    for (int k = 0; k < 3; k++) {
        float *p = hard_channel(f, axes[k]);
        for (size_t i = 0; i < PIXELS; i++) p[i] = rintf(p[i] * 4096.0f) / 4096.0f;
    }
}

static void exact_translation(void **state)
{
    double worst = 0.0;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
        frame_result a, b;
        exrio_file *f = clutter(false), *g = clutter(false); // Z would be finer than the grid, and win
        put_on_grid(f);
        put_on_grid(g);
        move(g, v3(1024, -512, 256), false);
        set_method(*state, m, 1.0);
        hard_run(*state, f, &a);
        hard_run(*state, g, &b);
        difference d = hard_compare(&a, &b, LAYER_OCCLUSION, NULL), l = hard_compare(&a, &b, LAYER_RADIANCE, NULL);
        printf("%s: exact translation moves occlusion by %.2e rms, radiance by %.2e\n", m->name, d.rms, l.rms);
        worst = fmax(worst, fmax(d.rms, l.rms));
        frame_free(&a);
        frame_free(&b);
        scene_file_free(f);
        scene_file_free(g);
    }
    printf("figure: exactly representable translation: at most %.1e rms, all methods\n", worst);
    assert_true(worst < 1e-4);
}

// Occlusion against the clean file's; with `back` against the file that holds the same loss at the origin.
static double moved_by(hard *h, double distance, bool with_depth, bool back, const frame_result *clean, bool *refused)
{
    frame_result r;
    error e = {0};
    exrio_file *f = clutter(with_depth);
    if (distance > 0.0) move(f, v3(distance, -0.7 * distance, 0.3 * distance), back);
    *refused = !hard_frame(h, hard_write(h, f, "moved"), &r, &e);
    double rms = NAN;
    if (!*refused) {
        hard_check_layers(&r, "far from the origin");
        rms = hard_compare(clean, &r, LAYER_OCCLUSION, NULL).rms;
    } else if (e.code != ERR_INPUT || !e.message[0])
        fail_msg("%g away: %s", distance, e.message);
    frame_free(&r);
    scene_file_free(f);
    return rms;
}

static void far_from_the_origin(void **state)
{
    static const double distances[] = {1e3, 1e4, 1e5, 1e6, 1e7, 1e8};
    enum { N = sizeof distances / sizeof *distances };
    FILE *t =
        hard_table("11-offset", "**A world far from its origin**, P in 32-bit floats, a scene 8 units across: rms change of "
                                "`occlusion`; beside it what the same rounded positions do at the origin");
    hard_cell(t, "| distance | spacing of P | with Z | the file's loss | without Z | the file's loss |\n| --- | --- | --- | --- "
                 "| --- | --- |\n");
    double extra = 0.0;
    frame_result clean[2];
    set_method(*state, method_default(), 1.0);
    for (int z = 0; z < 2; z++) {
        exrio_file *f = clutter(z == 0);
        hard_run(*state, f, &clean[z]);
        scene_file_free(f);
    }
    for (int i = 0; i < N; i++) {
        hard_cell(t, "| %.0e | %.2g |", distances[i], (double)(nextafterf((float)distances[i], INFINITY) - (float)distances[i]));
        for (int z = 0; z < 2; z++) {
            bool refused, refused_back;
            double rms = moved_by(*state, distances[i], z == 0, false, &clean[z], &refused);
            double own = moved_by(*state, distances[i], z == 0, true, &clean[z], &refused_back);
            printf("offset %g, %s Z: %.5f rms, the file's own loss %.5f\n", distances[i], z ? "without" : "with", rms, own);
            for (int k = 0; k < 2; k++) hard_cell(t, (k ? refused_back : refused) ? " refused |" : " %.4f |", k ? own : rms);
            if (!refused && !refused_back) extra = fmax(extra, rms - own);
            if (refused && !refused_back) fail_msg("refused %g away, but not at the origin with the same loss", distances[i]);
        }
        hard_cell(t, "\n");
    }
    for (int z = 0; z < 2; z++) frame_free(&clean[z]);
    hard_table_end(t);
    printf("figure: far from the origin (1e3 .. 1e8): at most %.4f rms beyond what the file itself lost\n", extra);
    assert_true(extra < 0.002);
}

// --- half positions ---

static void to_half(exrio_file *f, const char *name)
{
    for (int i = 0; i < f->parts[0].channel_count; i++) {
        exrio_channel *c = &f->parts[0].channels[i];
        if (strcmp(c->name, name) != 0) continue;
        for (size_t j = 0; j < PIXELS; j++) { // in place: a half is never ahead of its float
            float v = ((float *)c->data)[j];
            ((uint16_t *)c->data)[j] = float_to_half(v);
        }
        c->type = SAMPLE_HALF;
    }
}

static void half_positions(void **state)
{
    static const double distances[] = {0.0, 10.0, 100.0, 1000.0};
    FILE *t = hard_table("12-half",
                         "**P in half floats**, a scene 8 units across at a distance from its origin: rms change of `occlusion`");
    hard_cell(t, "| distance | spacing of P | with Z (float) | without Z |\n| --- | --- | --- | --- |\n");
    double near = 0.0;
    for (size_t i = 0; i < sizeof distances / sizeof *distances; i++) {
        hard_cell(t, "| %g | %.2g |", distances[i], exp2(floor(log2(fmax(distances[i], 4.0))) - 10.0));
        for (int z = 0; z < 2; z++) {
            frame_result clean, r;
            error e = {0};
            exrio_file *f = clutter(z == 0);
            set_method(*state, method_default(), 1.0);
            hard_run(*state, f, &clean);
            move(f, v3(distances[i], 0, 0), false);
            for (int k = 0; k < 3; k++) to_half(f, axes[k]);
            bool ran = hard_frame(*state, hard_write(*state, f, "half"), &r, &e);
            double rms = ran ? hard_compare(&clean, &r, LAYER_OCCLUSION, NULL).rms : NAN;
            if (ran) hard_check_layers(&r, "half positions");
            hard_cell(t, ran ? " %.4f |" : " refused |", rms);
            printf("half, %g away, %s Z: %.5f rms %s\n", distances[i], z ? "without" : "with", rms, e.message);
            if (i == 0) near = fmax(near, rms);
            frame_free(&r);
            frame_free(&clean);
            scene_file_free(f);
        }
        hard_cell(t, "\n");
    }
    hard_table_end(t);
    printf("figure: half positions at the origin: %.4f rms\n", near);
    assert_true(near < 0.03);
}

// --- P sampled anywhere in its pixel ---

static double noise(uint32_t *s) { return (double)((*s = *s * 1664525u + 1013904223u) >> 8) / 16777216.0 - 0.5; }

// Cosine between a pixel's view ray and its normal.
static double seen_at(const gbuffer *g, size_t i)
{
    vec3 p = gbuffer_position(g, (int)(i % WIDTH), (int)(i / WIDTH));
    const float *n = g->normal + 4 * i;
    return fabs(v3_dot(v3_normalize(p), v3((double)n[0], (double)n[1], (double)n[2])));
}

// Exact to 0.002 down to 12 degrees between the view and the plane, for every method.
static void jittered_plane(void **state)
{
    static const double tilts[] = {10.0, 45.0, 70.0, 80.0};
    double worst = 0.0, grazing = 0.0;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE))
        for (size_t i = 0; i < sizeof tilts / sizeof *tilts; i++) {
            scene s = {0};
            uint32_t seed = 7;
            frame_result r;
            scene_tilted_plane(&s, tilts[i], 10.0);
            view v = view_perspective(WIDTH, HEIGHT, 40.0, 1.0);
            exrio_file *f = hard_file(&s, &v, &(scene_exr_options){0});
            tracer t = scene_tracer(&s);
            float *p[3], *z = hard_channel(f, "Z");
            for (int k = 0; k < 3; k++) p[k] = hard_channel(f, axes[k]);
            for (size_t j = 0; j < PIXELS; j++) {
                vec3 o, d;
                hit at;
                view_ray(&v, (double)(j % WIDTH) + 0.5 + noise(&seed), (double)(j / WIDTH) + 0.5 + noise(&seed), &o, &d);
                if (!t.closest(t.data, o, d, 0.0, INFINITY, &at)) continue;
                p[0][j] = (float)at.position.x, p[1][j] = (float)at.position.y, p[2][j] = (float)at.position.z,
                z[j] = (float)at.t;
            }
            hard *h = *state;
            set_method(h, m, 1.0);
            h->rig.options.layers = "occlusion";
            h->rig.options.fov = 40.0;
            hard_run(h, f, &r);
            double here = 0.0;
            size_t at = 0;
            for (size_t j = 0; j < PIXELS; j++) {
                if (!(r.gb.depth[j] > 0.0f)) continue;
                double closed = 1.0 - (double)r.layers[LAYER_OCCLUSION][j];
                if (seen_at(&r.gb, j) < 0.2)
                    grazing = fmax(grazing, closed);
                else if (closed > here)
                    here = closed, at = j;
            }
            printf("%s: tilt %g: occlusion at least %.5f, at (%zu, %zu)\n", m->name, tilts[i], 1.0 - here, at % WIDTH,
                   at / WIDTH);
            worst = fmax(worst, here);
            frame_free(&r);
            scene_file_free(f);
        }
    printf("figure: P anywhere in its pixel on a tilted plane: occlusion at least %.5f, within 12 degrees of grazing %.3f, all "
           "methods\n",
           1.0 - worst, 1.0 - grazing);
    assert_true(worst <= 0.002);
}

// --- turned worlds ---

// The world and its camera turned together, all in floats.
static void turned_world(void **state)
{
    scene s;
    scene_clutter(&s);
    view v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&v, &s);
    exrio_file *f = hard_file(&s, &v, &(scene_exr_options){0});
    mat3 turn = m3_mul(rotation_about(v3(1, 0, 0), 33.0), rotation_about(v3(0, 0, 1), 71.0));
    scene_place(&s, 1.0, turn, v3(0, 0, 0));
    view_place(&v, 1.0, turn, v3(0, 0, 0));
    exrio_file *g = hard_file(&s, &v, &(scene_exr_options){0});
    double worst = 0.0;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
        frame_result a, b;
        set_method(*state, m, 1.0);
        hard_run(*state, f, &a);
        hard_run(*state, g, &b);
        difference d = hard_compare(&a, &b, LAYER_OCCLUSION, NULL), l = hard_compare(&a, &b, LAYER_RADIANCE, NULL);
        printf("%s: turning the world moves occlusion by %.2e rms (worst %.2e), radiance by %.2e\n", m->name, d.rms, d.worst,
               l.rms);
        worst = fmax(worst, fmax(d.rms, l.rms));
        frame_free(&a);
        frame_free(&b);
    }
    scene_file_free(f);
    scene_file_free(g);
    printf("figure: world and camera turned: at most %.1e rms, all methods\n", worst);
    assert_true(worst < 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_translation), cmocka_unit_test(far_from_the_origin), cmocka_unit_test(half_positions),
        cmocka_unit_test(jittered_plane),    cmocka_unit_test(turned_world),
    };
    return cmocka_run_group_tests_name("hard precision", tests, hard_open, hard_close);
}
