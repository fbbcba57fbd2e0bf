// A camera that slides past a still scene by fractions of a pixel: how much each method's occlusion changes from frame to frame
// beyond the change of the truth. The truth is brute force on the scene's whole geometry, with the same rays for every frame.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "hard.h"
#include "passes/method.h"
#include "truth.h"

enum { WIDTH = 96, HEIGHT = 64, FRAMES = 5, STRIDE = 3, RAYS = 576 };
static const double step = 0.3; // pixels at the scene's middle

typedef struct shot {
    scene scene;
    gbuffer gb[FRAMES];
    float *truth[FRAMES]; // NaN where it is not known
} shot;

static void make_shot(shot *s)
{
    error e = {0};
    scene_clutter(&s->scene);
    for (int f = 0; f < FRAMES; f++) {
        view v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
        view_scene(&v, &s->scene);
        double far = v3_length(v3_sub(s->scene.target, s->scene.eye));
        double(*m)[3] = v.camera.world_from_camera.m;
        vec3 right = v3(m[0][0], m[1][0], m[2][0]);
        v.camera.origin = v3_add(v.camera.origin, v3_scale(right, f * step * far / v.camera.fx));
        must(scene_gbuffer(&s->scene, &v, &s->gb[f], &e), &e);
        s->truth[f] = malloc(WIDTH * HEIGHT * sizeof(float));
        tracer t = scene_tracer(&s->scene);
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) {
                hit h;
                float *to = &s->truth[f][y * WIDTH + x];
                *to = NAN;
                if (x % STRIDE || y % STRIDE || !scene_at_pixel(&s->scene, &v, x, y, &h)) continue;
                *to = (float)truth_occlusion(&t, h.position, h.normal,
                                             &(truth_options){.radius = s->scene.radius, .rays = RAYS, .seed = 1});
            }
    }
}

// rms over frames and pixels of the change from one frame to the next: ours, the truth's, and of the one minus the other.
typedef struct change {
    double ours, truth, apart;
} change;

static change flicker(hard *h, const shot *s, const method *m)
{
    float *before = NULL;
    double ours = 0.0, apart = 0.0, truth = 0.0, n = 0.0;
    for (int f = 0; f < FRAMES; f++) {
        frame_result r;
        error e = {0};
        pass_settings set = rig_settings(m, s->scene.radius);
        set.thickness = m->thickness * s->scene.radius;
        set.blur = m->blur;
        set.planes = true;
        must(rig_run(&h->rig, &s->gb[f], m, &set, 1u << LAYER_OCCLUSION, &r, &e), &e);
        for (int i = 0; before && i < WIDTH * HEIGHT; i++) {
            double t = (double)s->truth[f][i] - (double)s->truth[f - 1][i];
            double o = (double)r.layers[LAYER_OCCLUSION][i] - (double)before[i];
            if (isnan(t)) continue;
            ours += o * o, apart += (o - t) * (o - t), truth += t * t, n += 1.0;
        }
        free(before);
        before = r.layers[LAYER_OCCLUSION];
        r.layers[LAYER_OCCLUSION] = NULL;
        rig_free_result(&r);
    }
    free(before);
    return (change){sqrt(ours / n), sqrt(truth / n), sqrt(apart / n)};
}

static void sliding_camera(void **state)
{
    static shot s;
    make_shot(&s);
    FILE *t = hard_table(
        "20-flicker",
        "**Flicker**, a camera sliding by 0.3 pixels a frame, 96 x 64 pixels: rms change of `occlusion` from frame to frame");
    hard_cell(t, "| method | ours | the truth's own | beyond it | ours minus the truth's, pixel by pixel |\n| --- | --- | --- | "
                 "--- | --- |\n");
    double first = INFINITY;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
        change c = flicker(*state, &s, m);
        printf("%s%s: %.4f rms a frame, the truth %.4f: %+.4f beyond it; pixel by pixel %.4f\n",
               m == method_default() ? "figure: flicker, " : "", m->name, c.ours, c.truth, c.ours - c.truth, c.apart);
        hard_cell(t, "| `%s` | %.4f | %.4f | %+.4f | %.4f |\n", m->name, c.ours, c.truth, c.ours - c.truth, c.apart);
        if (m == method_default()) first = c.ours - c.truth;
    }
    hard_table_end(t);
    for (int f = 0; f < FRAMES; f++) gbuffer_free(&s.gb[f]), free(s.truth[f]);
    assert_true(first <= 0.01); // of the default
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sliding_camera)};
    return cmocka_run_group_tests_name("hard flicker", tests, hard_open, hard_close);
}
