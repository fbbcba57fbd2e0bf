// The layer confidence: closed forms on a plane, and rays against the picture on scenes with foreground and borders.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "must.h"
#include "rig.h"
#include "scene_picture.h"
#include "truth.h"

enum { WIDTH = 128, HEIGHT = 96, SAMPLES = 2048, DIRECTIONS = 24, POINTS = 96 };

static int open_rig(void **state)
{
    static rig r;
    error e = {0};
    must(rig_open(&r, NULL, &e), &e);
    *state = &r;
    return 0;
}

static int close_rig(void **state)
{
    rig_close(*state);
    return 0;
}

static float *confidence_of(rig *r, const scene *s, const view *v, double radius)
{
    error e = {0};
    gbuffer gb;
    frame_result out;
    const method *m = method_default();
    pass_settings set = rig_settings(m, radius);
    set.samples = SAMPLES;
    must(scene_gbuffer(s, v, &gb, &e), &e);
    must(rig_run(r, &gb, m, &set, 1 << LAYER_CONFIDENCE, &out, &e), &e);
    float *confidence = out.layers[LAYER_CONFIDENCE];
    out.layers[LAYER_CONFIDENCE] = NULL;
    rig_free_result(&out);
    gbuffer_free(&gb);
    return confidence;
}

// Seen straight from above through parallel rays, a pixel at the distance k R from the border does not know the directions that
// lie beyond it on the unit disc.
static double beside_border(double k) { return k >= 1.0 ? 1.0 : 1.0 - (acos(k) - k * sqrt(1.0 - k * k)) / M_PI; }

static void plane_knows_all_but_beyond_the_border(void **state)
{
    const double radius = 0.8, pixel = 4.0 / WIDTH;
    scene s = {0};
    scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), v3(0.5, 0.5, 0.5));
    view v = view_orthographic(WIDTH, HEIGHT, 4.0, 1.0);
    view_look(&v, v3(0, 0, 3), v3(0, 0, 0), 0.0);
    float *confidence = confidence_of(*state, &s, &v, radius);
    for (int x = 0; x < WIDTH / 2; x++) {
        double got = (double)confidence[HEIGHT / 2 * WIDTH + x], wanted = beside_border((x + 0.5) * pixel / radius);
        if (!(fabs(got - wanted) < 0.01)) fail_msg("%d pixels from the border %.4f, expected %.4f", x, got, wanted);
    }
    assert_true(confidence[HEIGHT / 2 * WIDTH + WIDTH / 2] == 1.0f);
    free(confidence);
}

static void nothing_is_guessed_of_the_background(void **state)
{
    scene s = {0};
    scene_add_disc(&s, v3(0, 0, 0), v3(0, 0, 1), 0.5, v3(0.5, 0.5, 0.5));
    view v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_look(&v, v3(0, 0, 3), v3(0, 0, 0), 0.0);
    float *confidence = confidence_of(*state, &s, &v, 0.4);
    for (int i = 0; i < WIDTH * HEIGHT; i++) assert_true(confidence[i] == 1.0f);
    free(confidence);
}

// ---- rays

typedef struct eye {
    const scene *s;
    const view *v;
    tracer t;
} eye;

// Whether the camera sees a place: nothing is in front of it, within the frame.
static bool sees(const eye *e, vec3 at, double *in_front)
{
    double x, y, z;
    vec3 origin, direction;
    hit h;
    if (!view_project(e->v, at, &x, &y, &z) || x < 0 || y < 0 || x >= e->v->width || y >= e->v->height) {
        *in_front = INFINITY;
        return false;
    }
    view_ray(e->v, x, y, &origin, &direction);
    *in_front = e->t.closest(e->t.data, origin, direction, 1e-9, INFINITY, &h) ? h.t - z : INFINITY;
    return *in_front > 0.0;
}

// The ray passes a surface that the camera sees, or the camera sees all of it.
static bool is_decided(const eye *e, vec3 from, vec3 along)
{
    bool seen_last = true, all = true;
    double gap;
    for (int i = 1; i <= POINTS; i++) {
        bool seen = sees(e, v3_add(from, v3_scale(along, (double)i / POINTS)), &gap);
        double low = (i - 1.0) / POINTS, high = (double)i / POINTS;
        for (int k = 0; k < 20 && seen != seen_last; k++) {
            double middle = 0.5 * (low + high);
            if (sees(e, v3_add(from, v3_scale(along, middle)), &gap) == seen_last)
                low = middle;
            else
                high = middle;
        }
        if (seen != seen_last && sees(e, v3_add(from, v3_scale(along, low)), &gap) == seen_last && fabs(gap) < 1e-4) return true;
        seen_last = seen;
        all = all && seen;
    }
    return all;
}

static double traced(const eye *e, const hit *h, double radius)
{
    int decided = 0;
    vec3 from = v3_add(h->position, v3_scale(h->normal, 1e-6));
    for (int i = 0; i < DIRECTIONS * DIRECTIONS; i++)
        decided += is_decided(e, from, v3_scale(truth_direction(h->normal, i, DIRECTIONS, 1), radius));
    return (double)decided / (DIRECTIONS * DIRECTIONS);
}

static void compare(rig *r, const scene *s, const view *v, double radius, const char *name)
{
    enum { STEP = 8 };
    double squares = 0.0, sum = 0.0, least = 1.0;
    int n = 0;
    const eye e = {s, v, scene_tracer(s)};
    float *confidence = confidence_of(r, s, v, radius);
    for (int y = STEP / 2; y < HEIGHT; y += STEP)
        for (int x = STEP / 2; x < WIDTH; x += STEP) {
            hit h;
            if (!scene_at_pixel(s, v, x, y, &h)) continue;
            double wanted = traced(&e, &h, radius), off = (double)confidence[y * WIDTH + x] - wanted;
            squares += off * off, sum += off, least = fmin(least, wanted), n++;
        }
    print_message("%s: rms %.4f, mean %+.4f, the least %.2f\n", name, sqrt(squares / n), sum / n, least);
    assert_true(n > 100 && least < 0.5);
    // What is left is the size of the pixels: at twice as many a side it is .03 and .006.
    assert_true(sqrt(squares / n) < 0.06 && fabs(sum / n) < 0.02);
    free(confidence);
}

static void rays_decide_as_much(void **state)
{
    scene s;
    scene_clutter(&s);
    view v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&v, &s);
    compare(*state, &s, &v, s.radius, "clutter");
    compare(*state, &s, &v, 2.0 * v3_length(v3_sub(s.eye, s.target)), "the eye in the ball");
    view o = view_orthographic(WIDTH, HEIGHT, 4.0, 1.0);
    view_scene(&o, &s);
    compare(*state, &s, &o, s.radius, "orthographic");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(plane_knows_all_but_beyond_the_border, open_rig, close_rig),
        cmocka_unit_test_setup_teardown(nothing_is_guessed_of_the_background, open_rig, close_rig),
        cmocka_unit_test_setup_teardown(rays_decide_as_much, open_rig, close_rig),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
