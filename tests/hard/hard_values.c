// What no renderer should write but some do: NaN, infinities, huge, tiny and impossible values in every channel, and normals of
// every wrong kind, through the whole program and every method.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "hard.h"
#include "passes/method.h"
#include "pipeline/frame.h"

enum { WIDTH = 72, HEIGHT = 54, PIXELS = WIDTH * HEIGHT };

static const char all_layers[] = "occlusion,radiance,indirect,composite,visibility,depthmask";

static exrio_file *clutter(void)
{
    scene s;
    scene_clutter(&s);
    view v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&v, &s);
    return hard_file(&s, &v, &(scene_exr_options){.edge_samples = 2});
}

static void set_method(hard *h, const method *m)
{
    options_defaults(&h->rig.options);
    h->rig.options.method = m->name;
    h->rig.options.layers = all_layers;
    h->rig.options.bounce = m->bounce ? NULL : "ssdo";
    h->rig.options.radius_unit = RADIUS_WORLD;
    h->rig.options.radius = 1.0;
    h->rig.options.samples = 16;
}

static bool warned(const hard *h, const char *key)
{
    int n = 0;
    for (int i = 0; i < h->rig.log.warning_count; i++) n += strcmp(h->rig.log.keys[i], key) == 0;
    assert_true(n <= 1);
    return n == 1;
}

static void forget_warnings(hard *h)
{
    log_free(&h->rig.log);
    log_init(&h->rig.log, LOG_QUIET);
}

// --- every channel, every value ---

static const char *const channels[] = {"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "Z", "albedo.R", "R", "A"};
enum { CHANNELS = sizeof channels / sizeof *channels };
static const float values[] = {NAN, INFINITY, -INFINITY, 1e10f, 1e30f, -3e38f, 1e-40f, 0.0f, -1.0f};
enum { VALUES = sizeof values / sizeof *values };

static bool chosen(size_t i, int share) { return i * 2654435761u % 97u < (unsigned)share; }

// Runs a file with one channel spoilt. With half of the channel gone the program may refuse, because it cannot know the camera;
// then its error names an option. Returns whether it ran.
static bool spoil(hard *h, int channel, float value, int share, frame_result *r)
{
    exrio_file *f = clutter();
    float *v = hard_channel(f, channels[channel]);
    char what[96];
    error e = {0};
    assert_non_null(v);
    for (size_t i = 0; i < PIXELS; i++)
        if (chosen(i, share)) v[i] = value;
    snprintf(what, sizeof what, "%g in %d of 97 pixels of %s", (double)value, share, channels[channel]);
    bool ran = hard_frame(h, hard_write(h, f, "in"), r, &e);
    if (ran) hard_check_layers(r, what);
    if (!ran && (share < 49 || e.code != ERR_INPUT || !strstr(e.message, "--"))) fail_msg("%s: %s", what, e.message);
    scene_file_free(f);
    return ran;
}

static void every_value(void **state)
{
    hard *h = *state;
    int ran = 0, refused = 0;
    double worst = 0.0;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
        frame_result clean, r;
        set_method(h, m);
        exrio_file *f = clutter();
        hard_run(h, f, &clean);
        scene_file_free(f);
        hard_check_layers(&clean, "clean");
        for (int c = 0; c < CHANNELS; c++)
            for (int v = 0; v < VALUES; v++)
                for (int share = 1; share <= 97; share += 48) {
                    if (!hard_whole() && (c + v + share) % (m == method_default() ? 3 : 11))
                        continue; // the share of the fast subset
                    bool ok = spoil(h, c, values[v], share, &r);
                    ran += ok, refused += !ok;
                    double rms = ok && share == 1 ? hard_compare(&clean, &r, LAYER_OCCLUSION, NULL).rms : 0.0;
                    if (rms > 0.02)
                        print_error("%s: %g in 1 of 97 pixels of %s: occlusion moves by %.4f rms\n", m->name, (double)values[v],
                                    channels[c], rms);
                    worst = fmax(worst, rms);
                    frame_free(&r);
                }
        frame_free(&clean);
    }
    assert_true(worst < 0.03);
    printf("figure: bad values: %d frames finite and in bounds, %d refused; 1 %% bad pixels move occlusion elsewhere by at most "
           "%.4f rms\n",
           ran, refused, worst);
}

static void warnings_say_the_share(void **state)
{
    static const struct {
        int channel;
        float value;
        int share;
        const char *key;
    } cases[] = {{0, NAN, 3, "bad-positions"},
                 {1, 1e6f, 3, "bad-positions"},
                 {3, NAN, 3, "bad-normals"},
                 {7, INFINITY, 3, "bad-colours"},
                 {8, NAN, 3, "bad-colours"}};
    hard *h = *state;
    frame_result r;
    set_method(h, method_default());
    exrio_file *f = clutter();
    forget_warnings(h);
    hard_run(h, f, &r);
    frame_free(&r);
    scene_file_free(f);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) assert_false(warned(h, cases[i].key));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int twice = 0; twice < 2; twice++) {
            if (!twice) forget_warnings(h);
            assert_true(spoil(h, cases[i].channel, cases[i].value, cases[i].share, &r));
            if (!warned(h, cases[i].key))
                fail_msg("%g in %s raises no warning", (double)cases[i].value, channels[cases[i].channel]);
            frame_free(&r);
        }
    printf("figure: a defect in 3 %% of the pixels is said once, with its share, for positions, normals and colours\n");
}

// --- normals ---

typedef void (*normal_fn)(size_t i, float n[3]);
static void flipped(size_t i, float n[3]) { (void)i, n[0] = -n[0], n[1] = -n[1], n[2] = -n[2]; }
static void some_flipped(size_t i, float n[3])
{
    if (i % 3 == 0) flipped(i, n);
}
static void zero(size_t i, float n[3]) { (void)i, n[0] = n[1] = n[2] = 0.0f; }
static void some_zero(size_t i, float n[3])
{
    if (i % 3 == 0) zero(i, n);
}
static void lengthened(size_t i, float n[3])
{
    for (int k = 0; k < 3; k++) n[k] *= i % 2 ? 0.05f : 20.0f;
}
static void encoded(size_t i, float n[3])
{
    (void)i;
    for (int k = 0; k < 3; k++) n[k] = 0.5f + 0.5f * n[k];
}
static void not_numbers(size_t i, float n[3]) { n[i % 3] = NAN; }

// Pixels whose 3 x 3 neighbours continue their surface: where depth can tell which way a surface faces.
static void mark_inside(const gbuffer *g, unsigned char *inside)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            size_t i = (size_t)y * WIDTH + (size_t)x;
            inside[i] = x > 0 && y > 0 && x < WIDTH - 1 && y < HEIGHT - 1;
            for (int k = 0; inside[i] && k < 9; k++) {
                size_t j = (size_t)(y + k / 3 - 1) * WIDTH + (size_t)(x + k % 3 - 1);
                const float *a = g->normal + 4 * i, *b = g->normal + 4 * j;
                bool same =
                    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] > 0.8f && fabsf(g->depth[i] - g->depth[j]) < 0.1f * g->depth[i];
                inside[i] = same && g->depth[j] > 0.0f;
            }
        }
}

// Normals of a wrong kind are turned, scaled, decoded or rebuilt: the picture is about that of the right ones.
static void wrong_normals(void **state)
{
    static const struct {
        const char *name;
        normal_fn change;
        double most; // rms change of occlusion
    } kinds[] = {{"flipped", flipped, 0.01},        {"a third flipped", some_flipped, 0.02},  {"zero", zero, 0.05},
                 {"a third zero", some_zero, 0.05}, {"lengths .05 and 20", lengthened, 1e-6}, {"encoded 0..1", encoded, 1e-3},
                 {"NaN", not_numbers, 0.05}};
    hard *h = *state;
    FILE *t = hard_table("30-normals", "**Normals** of a wrong kind: rms change of `occlusion` away from edges (a third flipped, "
                                       "zero and NaN: rebuilt from depth, with a warning)");
    hard_cell(t, "| method |");
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) hard_cell(t, " %s |", kinds[k].name);
    hard_cell(t, "\n| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    double worst = 0.0;
    int bad = 0;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
        frame_result clean, r;
        set_method(h, m);
        exrio_file *f = clutter();
        hard_run(h, f, &clean);
        scene_file_free(f);
        static unsigned char inside[PIXELS];
        mark_inside(&clean.gb, inside);
        hard_cell(t, "| `%s` |", m->name);
        for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
            f = clutter();
            float *n[3] = {hard_channel(f, "N.X"), hard_channel(f, "N.Y"), hard_channel(f, "N.Z")};
            for (size_t i = 0; i < PIXELS; i++) {
                float v[3] = {n[0][i], n[1][i], n[2][i]};
                kinds[k].change(i, v);
                for (int c = 0; c < 3; c++) n[c][i] = v[c];
            }
            hard_run(h, f, &r);
            hard_check_layers(&r, kinds[k].name);
            double rms = hard_compare(&clean, &r, LAYER_OCCLUSION, inside).rms;
            if (rms > kinds[k].most) print_error("%s, normals %s: %.5f\n", m->name, kinds[k].name, rms);
            bad += rms > kinds[k].most;
            worst = fmax(worst, rms);
            hard_cell(t, " %.4f |", rms);
            frame_free(&r);
            scene_file_free(f);
        }
        hard_cell(t, "\n");
        frame_free(&clean);
    }
    hard_table_end(t);
    printf("figure: wrong normals move occlusion away from edges by at most %.4f rms, all methods\n", worst);
    assert_int_equal(bad, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_value),
        cmocka_unit_test(warnings_say_the_share),
        cmocka_unit_test(wrong_normals),
    };
    return cmocka_run_group_tests_name("hard values", tests, hard_open, hard_close);
}
