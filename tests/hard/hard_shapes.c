// Geometry and windows at the edge of sense: coincident and one-pixel surfaces, checkerboards of depth, radii from a hundredth of
// a pixel to the whole frame, data windows of every size and place, nothing and everything in view.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "hard.h"
#include "passes/method.h"
#include "pipeline/frame.h"

static const char all_layers[] = "occlusion,radiance,indirect,composite,visibility,depthmask";

static void set_method(hard *h, const method *m, double radius)
{
    options_defaults(&h->rig.options);
    h->rig.options.method = m->name;
    h->rig.options.layers = all_layers;
    h->rig.options.bounce = m->bounce ? NULL : "ssdo";
    h->rig.options.radius_unit = RADIUS_WORLD;
    h->rig.options.radius = radius;
    h->rig.options.samples = 16;
    h->rig.options.fov = 50.0;
}

// --- windows ---

static exrio_file *window(box2 data, box2 display, double aspect)
{
    scene s;
    scene_clutter(&s);
    view v = view_perspective(box2_width(display), box2_height(display), 50.0, aspect);
    v.data_window = display, v.display_window = display;
    view_scene(&v, &s);
    view_crop(&v, data);
    return hard_file(&s, &v, &(scene_exr_options){0});
}

static void windows(void **state)
{
    static const box2 display = {0, 0, 63, 47};
    static const box2 cases[] = {{0, 0, 63, 47}, {-9, -7, 70, 55}, {10, 8, 40, 30},    {5, 5, 5, 5},
                                 {0, 3, 63, 3},  {20, 0, 20, 47},  {-50, -40, -8, -3}, {60, 40, 66, 50},
                                 {0, 0, 52, 46}, {-3, 11, 37, 41}, {62, 46, 63, 47}};
    int frames = 0;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE))
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
            for (int a = 0; a < 2 + hard_whole(); a++) {
                frame_result r;
                exrio_file *f = window(cases[i], display, a == 0 ? 1.0 : a == 1 ? 2.0 : 0.5);
                set_method(*state, m, 1.0);
                hard_run(*state, f, &r);
                hard_check_layers(&r, "a window");
                assert_int_equal(r.gb.width, box2_width(cases[i]));
                frames++;
                frame_free(&r);
                scene_file_free(f);
            }
    printf("figure: %d frames of 1 x 1 to overscan windows, pixel aspect .5, 1, 2: in bounds\n", frames);
}

// The same rays under other coordinates: no bit changes.
static void window_origin(void **state)
{
    static const int shifts[][2] = {{-1000, 777}, {123456, -4}};
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
        frame_result a, b;
        exrio_file *f = window((box2){0, 0, 60, 42}, (box2){0, 0, 60, 42}, 1.0);
        set_method(*state, m, 1.0);
        hard_run(*state, f, &a);
        for (size_t i = 0; i < 2; i++) {
            exrio_part *p = &f->parts[0];
            p->data_window = p->display_window = (box2){shifts[i][0], shifts[i][1], shifts[i][0] + 60, shifts[i][1] + 42};
            hard_run(*state, f, &b);
            assert_memory_equal(a.layers[LAYER_OCCLUSION], b.layers[LAYER_OCCLUSION], 61 * 43 * sizeof(float));
            assert_memory_equal(a.layers[LAYER_RADIANCE], b.layers[LAYER_RADIANCE], 3 * 61 * 43 * sizeof(float));
            frame_free(&b);
        }
        frame_free(&a);
        scene_file_free(f);
    }
    printf("figure: windows from -1000 to 123456: the same bits, all methods\n");
}

// --- depths ---

typedef float (*depth_fn)(int x, int y);
static float checkerboard(int x, int y) { return (x + y) % 2 ? 4.0f : 8.0f; }
static float columns(int x, int y) { return (void)y, x % 5 == 0 ? 3.0f : 9.0f; }
static float dots(int x, int y) { return x % 7 == 3 && y % 7 == 3 ? 2.0f : 9.0f; }
static float borders(int x, int y) { return (x / 64 + y / 64) % 2 || x == 0 || y == 0 || x == 95 || y == 71 ? 4.0f : 7.0f; }
static float fighting(int x, int y) { return nextafterf(5.0f, (x * 31 + y * 17) % 3 ? 9.0f : 1.0f); }
static float islands(int x, int y) { return ((unsigned)x * 2654435761u ^ (unsigned)y * 40503u) % 11 == 0 ? 5.0f : 0.0f; }
static float nothing(int x, int y) { return (void)x, (void)y, 0.0f; }
static float steep(int x, int y) { return (void)y, (float)exp(0.25 * x); }

static exrio_file *depth_frame(depth_fn fn)
{
    scene s = {0};
    view v = view_perspective(96, 72, 50.0, 1.0);
    scene_tilted_plane(&s, 0.0, 5.0);
    exrio_file *f = hard_file(&s, &v, &(scene_exr_options){.no_position = true});
    float *z = hard_channel(f, "Z");
    for (int y = 0; y < 72; y++)
        for (int x = 0; x < 96; x++) z[y * 96 + x] = fn(x, y);
    return f;
}

static void depths(void **state)
{
    static const struct {
        const char *name;
        depth_fn fn;
        double least; // of the mean occlusion
    } cases[] = {{"checkerboard", checkerboard, 0.0},
                 {"one-pixel columns", columns, 0.0},
                 {"one-pixel dots", dots, 0.5},
                 {"steps at tile and frame borders", borders, 0.5},
                 {"coincident surfaces", fighting, 0.9999},
                 {"lone pixels", islands, 0.5},
                 {"all background", nothing, 1.0},
                 {"1 to 1e10 across", steep, 0.0}};
    int bad = 0, frames = 0;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE))
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
            for (int own = 0; own < 2; own++) { // normals of the file, or from depth
                frame_result r;
                exrio_file *f = depth_frame(cases[i].fn);
                for (int k = 0; own && k < 3; k++) {
                    float *n = hard_channel(f, k == 0 ? "N.X" : k == 1 ? "N.Y" : "N.Z");
                    for (int j = 0; j < 96 * 72; j++) n[j] = 0.0f;
                }
                set_method(*state, m, 1.0);
                hard_run(*state, f, &r);
                hard_check_layers(&r, cases[i].name);
                double mean = 0.0;
                for (int j = 0; j < 96 * 72; j++) mean += (double)r.layers[LAYER_OCCLUSION][j] / (96 * 72);
                if (mean < cases[i].least)
                    print_error("%s, %s%s: mean occlusion %.6f\n", m->name, cases[i].name, own ? ", normals from depth" : "",
                                mean);
                bad += mean < cases[i].least;
                frames++;
                frame_free(&r);
                scene_file_free(f);
            }
    printf("figure: %d frames of impossible depth in bounds; coincident surfaces do not darken, background is 1\n", frames);
    assert_int_equal(bad, 0);
}

// --- radii ---

static void radii(void **state)
{
    static const double pixels[] = {0.01, 0.1, 1.0, 10.0, 100.0, 10000.0};
    double open = 1.0;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE))
        for (size_t i = 0; i < sizeof pixels / sizeof *pixels; i++) {
            frame_result r;
            hard *h = *state;
            exrio_file *f = window((box2){0, 0, 63, 47}, (box2){0, 0, 63, 47}, 1.0);
            set_method(h, m, pixels[i]);
            h->rig.options.radius_unit = RADIUS_PIXELS;
            hard_run(h, f, &r);
            hard_check_layers(&r, "a radius");
            double mean = 0.0;
            for (int j = 0; j < 64 * 48; j++) mean += (double)r.layers[LAYER_OCCLUSION][j] / (64 * 48);
            if (i == 0) open = fmin(open, mean);
            frame_free(&r);
            scene_file_free(f);
        }
    printf("figure: radii of .01 to 10000 pixels in bounds; at .01 pixels mean occlusion is at least %.5f\n", open);
    assert_true(open > 0.995);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(windows),
        cmocka_unit_test(window_origin),
        cmocka_unit_test(depths),
        cmocka_unit_test(radii),
    };
    return cmocka_run_group_tests_name("hard shapes", tests, hard_open, hard_close);
}
