// Environments nobody would light with, colours no surface has, and bounces at no distance.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "hard.h"
#include "passes/method.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT };
enum { LIGHT = 1 << LAYER_OCCLUSION | 1 << LAYER_RADIANCE };

static gbuffer make(const scene *s)
{
    gbuffer gb;
    error e = {0};
    view v = view_perspective(WIDTH, HEIGHT, 60.0, 1.0);
    view_scene(&v, s);
    must(scene_gbuffer(s, &v, &gb, &e), &e);
    return gb;
}

typedef struct sky {
    const char *name;
    int width, height;
    float value;  // everywhere
    size_t spots; // texels of `spot`
    float spot;
    double least, most; // bounds of radiance, whatever is blocked; most 0: only finite
} sky;

static const sky skies[] = {
    {"black", 8, 4, 0.0f, 0, 0.0f, 0.0, 1e-30},
    {"constant 3", 64, 32, 3.0f, 0, 0.0f, 0.0, 3.0 + 1e-3},
    {"1 x 1", 1, 1, 2.0f, 0, 0.0f, 0.0, 2.0 + 1e-3},
    {"one hot texel of 1e6", 256, 128, 0.1f, 1, 1e6f, 0.0, 0.0},
    {"half negative", 32, 16, 1.0f, 256, -1.0f, 0.0, 1.0 + 1e-3}, // where all is, it is refused (tests/golden/hostile.sh)
    {"half NaN", 32, 16, 1.0f, 256, NAN, 0.0, 1.0 + 1e-3},
    {"infinite texels", 32, 16, 1.0f, 5, INFINITY, 0.0, 1.0 + 1e-3},
    {"1e30", 32, 16, 1e30f, 0, 0.0f, 0.0, 0.0},
    {"16384 wide", 16384, 8, 1.0f, 0, 0.0f, 0.0, 1.0 + 1e-3},
};

// Puts a sky in the place of the rig's.
static void light_with(rig *r, const sky *s)
{
    error e = {0};
    size_t n = (size_t)s->width * (size_t)s->height;
    float *rgb = malloc(3 * n * sizeof *rgb);
    assert_non_null(rgb);
    for (size_t i = 0; i < 3 * n; i++) rgb[i] = s->value;
    for (size_t i = 0; i < s->spots; i++)
        for (int k = 0; k < 3; k++) rgb[3 * ((n / 3 + 2 * i) % n) + (size_t)k] = s->spot;
    environment_free(&r->job.light.env);
    gpu_image_free(&r->job.light.image);
    gpu_image_free(&r->job.light.sunless.map);
    r->job.light.sunless = (pass_sunless){0};
    must(environment_prepare(rgb, s->width, s->height, &(env_options){.path = s->name, .up_z = true, .scale = 1.0},
                             &r->job.light.env, &r->log, &e),
         &e);
    must(pass_upload_environment(&r->job.g, &r->job.light.env, &r->job.light.image, &e), &e);
    free(rgb);
}

static void environments(void **state)
{
    hard *h = *state;
    scene s;
    scene_clutter(&s);
    gbuffer gb = make(&s);
    int frames = 0;
    for (size_t i = 0; i < sizeof skies / sizeof *skies; i++) {
        light_with(&h->rig, &skies[i]);
        for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
            frame_result out;
            error e = {0};
            pass_settings set = rig_settings(m, s.radius);
            set.thickness = m->thickness * s.radius;
            set.planes = true;
            set.samples = 16;
            must(rig_run(&h->rig, &gb, m, &set, LIGHT | (m->bounce ? 1u << LAYER_INDIRECT : 0u), &out, &e), &e);
            hard_check_layers(&out, skies[i].name);
            for (int p = 0; p < 3 * PIXELS && skies[i].most > 0.0; p++)
                if (!((double)out.layers[LAYER_RADIANCE][p] <= skies[i].most))
                    fail_msg("%s, %s: radiance %g", skies[i].name, m->name, (double)out.layers[LAYER_RADIANCE][p]);
            frames++;
            rig_free_result(&out);
        }
    }
    gbuffer_free(&gb);
    printf("figure: %d frames under %zu impossible skies finite and within the sky's own bounds\n", frames,
           sizeof skies / sizeof *skies);
}

// Invariant 5 of shaders/README.md for every bounce: never more than the blocked share times the brightest sender, at any number
// of samples, from 0.01 radii to touching.
static void grazing_bounce(void **state)
{
    static const double distances[] = {0.5, 0.01, 1e-4};
    static const int samples[] = {8, 64, 512, 2048};
    hard *h = *state;
    double worst = -INFINITY, lit = 0.0;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
        if (!m->bounce) continue;
        for (size_t d = 0; d < sizeof distances / sizeof *distances; d++) {
            scene s;
            scene_corner(&s, distances[d]);
            s.eye = v3(0.02, -distances[d] - 1.5, 0.8), s.target = v3(0, -0.1 * distances[d], 0.1 * distances[d]);
            gbuffer gb = make(&s);
            for (size_t n = 0; n < sizeof samples / sizeof *samples - !hard_whole(); n++) {
                frame_result out;
                error e = {0};
                pass_settings set = rig_settings(m, 1.0);
                set.samples = samples[n];
                must(rig_run(&h->rig, &gb, m, &set, LIGHT | 1u << LAYER_INDIRECT, &out, &e), &e);
                hard_check_layers(&out, "corner");
                for (int i = 0; i < PIXELS; i++) {
                    double blocked = strcmp(m->bounce->name, "arc") == 0 ? 1.0 - (double)out.layers[LAYER_RADIANCE][3 * i]
                                                                         : 1.0 - (double)out.layers[LAYER_OCCLUSION][i];
                    worst = fmax(worst, (double)out.layers[LAYER_INDIRECT][3 * i] - 0.8 * blocked);
                    lit += (double)out.layers[LAYER_INDIRECT][3 * i];
                }
                rig_free_result(&out);
            }
            gbuffer_free(&gb);
        }
    }
    printf("figure: bounce in a corner: at most %+.1e beyond blocked share x brightest sender\n", worst);
    assert_true(lit > 0.0 && worst < 1e-5);
}

// A closed white box: what is direct and what bounces never exceeds what is there.
static void furnace(void **state)
{
    hard *h = *state;
    scene s;
    scene_furnace(&s);
    gbuffer gb = make(&s);
    double worst = 0.0;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE))
        for (int n = 8; m->bounce && n <= 512; n *= 8) {
            frame_result out;
            error e = {0};
            pass_settings set = rig_settings(m, s.radius);
            set.samples = n;
            set.planes = true;
            set.thickness = m->thickness * s.radius;
            must(rig_run(&h->rig, &gb, m, &set, LIGHT | 1u << LAYER_INDIRECT, &out, &e), &e);
            for (int i = 0; i < 3 * PIXELS; i++)
                worst = fmax(worst, (double)out.layers[LAYER_RADIANCE][i] + (double)out.layers[LAYER_INDIRECT][i]);
            rig_free_result(&out);
        }
    gbuffer_free(&gb);
    printf("figure: white furnace: radiance + indirect at most %.6f\n", worst);
    assert_true(worst <= 1.0 + 1e-5);
}

// An albedo no surface has sends no negative light, and stays finite.
static void impossible_albedo(void **state)
{
    static const float albedos[] = {-0.5f, 0.0f, 1.5f, 100.0f, 1e30f};
    hard *h = *state;
    scene s;
    scene_clutter(&s);
    gbuffer gb = make(&s);
    int frames = 0;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE))
        for (size_t a = 0; m->bounce && a < sizeof albedos / sizeof *albedos; a++) {
            frame_result out;
            error e = {0};
            pass_settings set = rig_settings(m, s.radius);
            for (int i = 0; i < 4 * PIXELS; i++) gb.albedo[i] = i % 4 == 3 ? 0.0f : i % 8 < 4 ? albedos[a] : 0.5f;
            must(rig_run(&h->rig, &gb, m, &set, LIGHT | 1u << LAYER_INDIRECT, &out, &e), &e);
            hard_check_layers(&out, "impossible albedo");
            frames++;
            rig_free_result(&out);
        }
    gbuffer_free(&gb);
    printf("figure: albedo from -0.5 to 1e30: %d frames finite, no negative light\n", frames);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(grazing_bounce), cmocka_unit_test(furnace), cmocka_unit_test(impossible_albedo),
        cmocka_unit_test(environments), // last: it changes the light
    };
    return cmocka_run_group_tests_name("hard lights", tests, hard_open, hard_close);
}
