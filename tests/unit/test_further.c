// What further G-buffers tell of occlusion: where the frame shows nothing and they do, the error against rays falls.
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
#include "rig.h"
#include "scene_picture.h"
#include "truth.h"

enum { WIDTH = 320, HEIGHT = 180, STEP = 6 };
static const vec3 grey = {0.5, 0.5, 0.5};

// A floor and a wall, pillars, a crate behind a box, and a curtain that hangs beside the frame.
static scene hall(void)
{
    scene s = {.eye = v3(0, -4, 1.4), .target = v3(0, 2, 0.9), .radius = 0.9};
    scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), grey);
    scene_add_plane(&s, v3(0, 3, 0), v3(0, -1, 0), grey);
    scene_add_box(&s, v3(-0.9, 1.2, 0.5), v3(0.4, 0.3, 0.5), 20.0, grey);
    scene_add_box(&s, v3(-0.8, 2.2, 0.4), v3(0.3, 0.3, 0.4), 0.0, grey);
    scene_add_sphere(&s, v3(0.5, 1.0, 0.4), 0.4, grey);
    scene_add_box(&s, v3(1.3, 0.6, 1.5), v3(0.12, 0.12, 1.5), 0.0, grey);
    scene_add_quad(&s, v3(1.75, -0.4, 0.0), v3(0, 1.8, 0), v3(0, 0, 2.5), grey); // beside the frame
    scene_add_box(&s, v3(-1.9, 0.6, 0.8), v3(0.25, 0.5, 0.8), 0.0, grey);
    return s;
}

static gbuffer seen_from(const scene *s, vec3 eye, vec3 target, double fov)
{
    error e = {0};
    gbuffer gb;
    view v = view_perspective(WIDTH, HEIGHT, fov, 1.0);
    view_look(&v, eye, target, 0.0);
    must(scene_gbuffer(s, &v, &gb, &e), &e);
    return gb;
}

static world_view world_view_of(const gbuffer *gb)
{
    error e = {0};
    world_view v = {.eye = gb->camera.origin, .width = gb->width, .height = gb->height, .camera = gb->camera};
    v.surface = mem_pixels((size_t)gb->width * (size_t)gb->height, 4 * sizeof *v.surface, &e);
    for (int i = 0; i < gb->width * gb->height; i++) {
        v.surface[4 * i] = gb->depth[i] > 0.0f ? gb->depth[i] : -1.0f;
        for (int k = 0; k < 3; k++) v.surface[4 * i + 1 + k] = gb->normal[4 * i + k];
    }
    return v;
}

static float *run(const gbuffer *gb, const world_view *views, int count, double radius, layer_id layer)
{
    static rig r;
    error e = {0};
    frame_result out;
    must(rig_open(&r, NULL, &e), &e);
    pass_settings set = rig_settings(method_find("arc"), radius);
    set.thickness = 0.15 * radius, set.planes = true, set.blur = 4;
    for (int i = 0; i < count; i++) r.job.views[r.job.view_count++] = views[i];
    must(rig_run(&r, gb, method_find("arc"), &set, 1u << layer, &out, &e), &e);
    float *result = out.layers[layer];
    out.layers[layer] = NULL;
    rig_free_result(&out);
    r.job.view_count = 0; // they are the caller's
    rig_close(&r);
    return result;
}

static double truth_at(const scene *s, const gbuffer *gb, int x, int y)
{
    size_t i = 4 * (size_t)(y * WIDTH + x);
    const camera *c = &gb->camera;
    tracer t = scene_tracer(s);
    vec3 n = v3((double)gb->normal[i], (double)gb->normal[i + 1], (double)gb->normal[i + 2]);
    vec3 p = v3_add(c->origin, m3_apply(c->world_from_camera, gbuffer_position(gb, x, y)));
    return truth_occlusion(&t, p, m3_apply(c->world_from_camera, n),
                           &(truth_options){.radius = s->radius, .rays = 1024, .offset = 1e-5});
}

// Root mean squares of the error, without and with the views: of the whole picture, and where the frame guesses most and the
// views decide.
typedef struct errors {
    double all[2], decided[2];
    int count, decided_count;
} errors;

static errors errors_of(const scene *s, const gbuffer *gb, const world_view *views, int count)
{
    errors r = {0};
    float *sure[2], *occlusion[2];
    for (int k = 0; k < 2; k++) {
        sure[k] = run(gb, views, k * count, s->radius, LAYER_CONFIDENCE);
        occlusion[k] = run(gb, views, k * count, s->radius, LAYER_OCCLUSION);
    }
    for (int y = STEP / 2; y < HEIGHT; y += STEP)
        for (int x = STEP / 2; x < WIDTH; x += STEP) {
            int i = y * WIDTH + x;
            if (!(gb->depth[i] > 0.0f)) continue;
            double truth = truth_at(s, gb, x, y);
            bool decided = sure[0][i] < 0.7f && sure[1][i] > 0.9f;
            r.count++, r.decided_count += decided;
            for (int k = 0; k < 2; k++) {
                double off = (double)occlusion[k][i] - truth;
                r.all[k] += off * off, r.decided[k] += decided ? off * off : 0.0;
            }
        }
    for (int k = 0; k < 2; k++) {
        r.all[k] = sqrt(r.all[k] / r.count), r.decided[k] = sqrt(r.decided[k] / r.decided_count);
        free(sure[k]), free(occlusion[k]);
    }
    print_message("%d views: rms %.4f -> %.4f, where they decide (%d of %d) %.4f -> %.4f\n", count, r.all[0], r.all[1],
                  r.decided_count, r.count, r.decided[0], r.decided[1]);
    return r;
}

static void two_views_halve_the_error(void **state)
{
    (void)state;
    scene s = hall();
    gbuffer gb = seen_from(&s, s.eye, s.target, 42.0);
    gbuffer aside = seen_from(&s, v3(-2.2, -0.6, 2.0), v3(0.6, 1.6, 0.4), 80.0);
    gbuffer reverse = seen_from(&s, v3(0.3, 2.8, 1.7), v3(0.2, 0.5, 0.6), 100.0);
    world_view views[2] = {world_view_of(&aside), world_view_of(&reverse)};
    errors r = errors_of(&s, &gb, views, 2);
    assert_true(r.decided_count > r.count / 8);
    assert_true(r.decided[1] < 0.5 * r.decided[0]);
    assert_true(r.all[1] < 0.8 * r.all[0]);
    for (int i = 0; i < 2; i++) world_view_free(&views[i]);
    gbuffer_free(&gb), gbuffer_free(&aside), gbuffer_free(&reverse);
}

// Mean over the ball of `a` - `b`.
static double difference_on_ball(const gbuffer *gb, const float *a, const float *b)
{
    double sum = 0.0;
    int n = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        vec3 p = gbuffer_position(gb, i % WIDTH, i / WIDTH);
        vec3 off = v3_sub(v3_add(gb->camera.origin, m3_apply(gb->camera.world_from_camera, p)), v3(0.5, 1.0, 0.4));
        if (fabs(v3_length(off) - 0.4) > 1e-3) continue;
        sum += (double)a[i] - (double)b[i], n++;
    }
    assert_true(n > 500);
    return sum / n;
}

// What stands in a further view where the frame sees that there is nothing has moved since: it does not darken the ball.
static void the_frame_knows_better(void **state)
{
    (void)state;
    scene s = hall(), later = s;
    scene_add_box(&later, v3(0.5, 0.3, 0.65), v3(0.3, 0.05, 0.35), 0.0, grey); // before the ball
    gbuffer gb = seen_from(&s, s.eye, s.target, 42.0);
    gbuffer other = seen_from(&later, v3(-1.6, 1.6, 2.0), v3(0.5, 0.5, 0.4), 80.0);
    world_view moved = world_view_of(&other);
    float *alone = run(&gb, NULL, 0, s.radius, LAYER_OCCLUSION), *with = run(&gb, &moved, 1, s.radius, LAYER_OCCLUSION);
    double darker = difference_on_ball(&gb, alone, with);
    print_message("the ball: %.4f darker\n", darker);
    assert_true(darker < 0.0); // what the view shows beside it opens what was guessed to be blocked
    free(alone), free(with);
    world_view_free(&moved);
    gbuffer_free(&gb), gbuffer_free(&other);
}

// The frame itself, as one of the shot, changes nothing.
static void its_own_view_changes_nothing(void **state)
{
    (void)state;
    scene s = hall();
    gbuffer gb = seen_from(&s, s.eye, s.target, 42.0);
    world_view own = world_view_of(&gb);
    float *alone = run(&gb, NULL, 0, s.radius, LAYER_OCCLUSION), *with = run(&gb, &own, 1, s.radius, LAYER_OCCLUSION);
    assert_memory_equal(alone, with, sizeof *alone * WIDTH * HEIGHT);
    free(alone), free(with);
    world_view_free(&own);
    gbuffer_free(&gb);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_views_halve_the_error),
        cmocka_unit_test(the_frame_knows_better),
        cmocka_unit_test(its_own_view_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
