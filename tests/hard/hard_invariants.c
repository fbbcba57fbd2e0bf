// What must not change the picture (shaders/README.md, invariants 1 and 4), for every method: an empty plane however it is seen,
// the scene's scale, its place and turn, mirroring, camera roll, and the size of the tiles.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "hard.h"
#include "passes/method.h"

enum { LIGHT = 1 << LAYER_OCCLUSION | 1 << LAYER_RADIANCE, WIDTH = 112, HEIGHT = 80 };

static gbuffer make(const scene *s, const view *v)
{
    gbuffer gb;
    error e = {0};
    must(scene_gbuffer(s, v, &gb, &e), &e);
    return gb;
}

// The program's own defaults.
static pass_settings defaults(const method *m, double radius)
{
    pass_settings set = rig_settings(m, radius);
    set.thickness = m->thickness * radius;
    set.blur = m->blur;
    set.planes = true;
    return set;
}

static unsigned layers_of(const method *m) { return LIGHT | (m->bounce ? 1u << LAYER_INDIRECT : 0u); }

static void run(hard *h, const gbuffer *gb, const method *m, const pass_settings *set, frame_result *out)
{
    error e = {0};
    must(rig_run(&h->rig, gb, m, set, layers_of(m), out, &e), &e);
    hard_check_layers(out, "invariants");
}

// --- an empty plane ---

typedef struct plane_case {
    double tilt, distance, fov, aspect, radius; // fov 0: orthographic; radius as a share of the distance
} plane_case;

// Pixels of the plane whose occlusion is not exactly 1, and the largest departure.
static size_t closed_pixels(hard *h, const method *m, const plane_case *c, double *worst, size_t *total)
{
    scene s = {0};
    frame_result r;
    scene_tilted_plane(&s, c->tilt, c->distance);
    view v = c->fov > 0.0 ? view_perspective(64, 48, c->fov, c->aspect) : view_orthographic(64, 48, 1.2 * c->distance, c->aspect);
    gbuffer gb = make(&s, &v);
    pass_settings set = defaults(m, c->radius * c->distance);
    set.samples = m->samples < 16 ? m->samples : 16;
    run(h, &gb, m, &set, &r);
    size_t closed = 0;
    for (int i = 0; i < 64 * 48; i++) {
        double off = fabs(1.0 - (double)r.layers[LAYER_OCCLUSION][i]);
        if (!(gb.depth[i] > 0.0f)) continue;
        closed += off > 0.0;
        ++*total;
        *worst = fmax(*worst, off);
    }
    rig_free_result(&r);
    gbuffer_free(&gb);
    return closed;
}

// Exactly open, every pixel, by every method.
static void plane_family(hard *h, const char *name, const plane_case *cases, int count)
{
    size_t closed = 0, total = 0;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE))
        for (int i = 0; i < count; i++) {
            double worst = 0.0;
            size_t n = closed_pixels(h, m, &cases[i], &worst, &total);
            if (n)
                print_error("%s, %s: tilt %g, distance %g, fov %g, aspect %g, radius %g: %zu pixels closed by up to %.3g\n", name,
                            m->name, cases[i].tilt, cases[i].distance, cases[i].fov, cases[i].aspect, cases[i].radius, n, worst);
            closed += n;
        }
    printf("figure: empty plane by %s: %zu of %zu pixels not exactly open, all methods\n", name, closed, total);
    assert_int_equal(closed, 0);
}

static void empty_planes(void **state)
{
    static const double tilts[] = {0.0, 0.1, 1.0, 10.0, 45.0, 70.0, 80.0, 85.0, 89.0, 89.5, 89.9};
    static const double distances[] = {1e-6, 1e-3, 1.0, 1e3, 1e6}, fovs[] = {1, 5, 20, 60, 90, 120, 150, 170};
    static const double radii[] = {1e-5, 1e-3, 0.1, 1.0, 10.0};
    plane_case c[64];
    int n = 0;
    for (size_t i = 0; i < sizeof tilts / sizeof *tilts; i++) {
        c[n++] = (plane_case){tilts[i], 10.0, 45.0, 1.0, 0.1};
        c[n++] = (plane_case){tilts[i], 10.0, 0.0, 1.0, 0.1};
    }
    plane_family(*state, "tilt", c, n);
    n = 0;
    for (size_t i = 0; i < sizeof distances / sizeof *distances; i++)
        for (int k = 0; k < 2; k++) c[n++] = (plane_case){k ? 60.0 : 30.0, distances[i], 45.0, 1.0, 0.1};
    plane_family(*state, "distance", c, n);
    n = 0;
    for (size_t i = 0; i < sizeof fovs / sizeof *fovs; i++)
        for (int k = 0; k < 2; k++) c[n++] = (plane_case){k ? 60.0 : 0.0, 10.0, fovs[i], 1.0, 0.1};
    plane_family(*state, "fov", c, n);
    n = 0;
    for (int k = 0; k < 4; k++) c[n++] = (plane_case){50.0, 10.0, k & 1 ? 0.0 : 45.0, k & 2 ? 2.0 : 0.5, 0.1};
    plane_family(*state, "aspect", c, n);
    n = 0;
    for (size_t i = 0; i < sizeof radii / sizeof *radii; i++)
        for (int k = 0; k < 2; k++) c[n++] = (plane_case){k ? 60.0 : 20.0, 10.0, 45.0, 1.0, radii[i]};
    plane_family(*state, "radius", c, n);
}

// --- what must not matter ---

typedef struct subject {
    scene scene;
    view view;
    gbuffer gb;
} subject;

static subject clutter(void)
{
    subject s = {0};
    scene_clutter(&s.scene);
    s.view = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&s.view, &s.scene);
    s.gb = make(&s.scene, &s.view);
    return s;
}

static void placed(const subject *s, double scale, mat3 turn, gbuffer *out)
{
    scene sc = s->scene;
    view v = s->view;
    scene_place(&sc, scale, turn, v3(0, 0, 0));
    view_place(&v, scale, turn, v3(0, 0, 0));
    *out = make(&sc, &v);
}

// Powers of two change no bit; other factors change the rounding of every number, and so now and then which side of a threshold
// a sample falls on: allowed is one of a slice's 64 directions at one pixel in ten thousand.
static void scale(void **state)
{
    static const double factors[] = {0x1p-20, 0x1p-10, 0x1p10, 0x1p20, 1e-6, 1e-3, 1e3, 1e6};
    enum { N = sizeof factors / sizeof *factors, POWERS_OF_TWO = 4 };
    subject s = clutter();
    double worst[2] = {0};
    FILE *t = hard_table(
        "10-scale",
        "**Scale**, scene and radius together: rms change of `occlusion` (powers of two: no bit of any layer changes)");
    hard_cell(t, "| method | 2^-20 | 2^-10 | 2^10 | 2^20 | 1e-6 | 1e-3 | 1e3 | 1e6 |\n| --- | --- | --- | --- | --- | --- | --- "
                 "| --- | --- |\n");
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
        frame_result a, b;
        pass_settings set = defaults(m, s.scene.radius);
        run(*state, &s.gb, m, &set, &a);
        hard_cell(t, "| `%s` ", m->name);
        for (int i = 0; i < N; i++) {
            gbuffer gb;
            placed(&s, factors[i], m3_identity(), &gb);
            pass_settings scaled = defaults(m, s.scene.radius * factors[i]);
            run(*state, &gb, m, &scaled, &b);
            difference d = hard_compare(&a, &b, LAYER_OCCLUSION, NULL), l = hard_compare(&a, &b, LAYER_RADIANCE, NULL);
            double *most = &worst[i >= POWERS_OF_TWO];
            *most = fmax(*most, fmax(d.rms, l.rms));
            if (m->bounce && i < POWERS_OF_TWO) *most = fmax(*most, hard_compare(&a, &b, LAYER_INDIRECT, NULL).rms);
            hard_cell(t, "| %.0e ", d.rms);
            rig_free_result(&b);
            gbuffer_free(&gb);
        }
        hard_cell(t, "|\n");
        rig_free_result(&a);
    }
    hard_table_end(t);
    gbuffer_free(&s.gb);
    printf("figure: scale 2^-20 .. 2^20: rms change %.1e; 1e-6 .. 1e6: %.1e (worst of all methods)\n", worst[0], worst[1]);
    assert_true(worst[0] == 0.0 && worst[1] < 1e-4);
}

static void flip(const gbuffer *from, bool x_flip, bool y_flip, bool transpose, gbuffer *to)
{
    error e = {0};
    scene nothing = {0};
    view v = view_perspective(transpose ? from->height : from->width, transpose ? from->width : from->height, 50.0, 1.0);
    must(scene_gbuffer(&nothing, &v, to, &e), &e);
    const camera *c = &from->camera;
    to->camera = *c;
    to->camera.fx = transpose ? c->fy : c->fx, to->camera.fy = transpose ? c->fx : c->fy;
    double cx = x_flip ? from->width - c->cx : c->cx, cy = y_flip ? from->height - c->cy : c->cy;
    to->camera.cx = transpose ? cy : cx, to->camera.cy = transpose ? cx : cy;
    to->extent = from->extent, to->valid = from->valid;
    for (int y = 0; y < from->height; y++)
        for (int x = 0; x < from->width; x++) {
            int u = x_flip ? from->width - 1 - x : x, w = y_flip ? from->height - 1 - y : y;
            size_t i = (size_t)y * (size_t)from->width + (size_t)x;
            size_t j = transpose ? (size_t)u * (size_t)to->width + (size_t)w : (size_t)w * (size_t)to->width + (size_t)u;
            const float *n = from->normal + 4 * i;
            float nx = x_flip ? -n[0] : n[0], ny = y_flip ? -n[1] : n[1];
            to->depth[j] = from->depth[i];
            to->normal[4 * j] = transpose ? ny : nx, to->normal[4 * j + 1] = transpose ? nx : ny, to->normal[4 * j + 2] = n[2];
            memcpy(to->albedo + 4 * j, from->albedo + 4 * i, 4 * sizeof(float));
        }
}

// The result of a flipped frame, turned back.
static void unflip(const frame_result *from, bool x_flip, bool y_flip, bool transpose, frame_result *like)
{
    for (int l = 0; l < LAYER_COUNT; l++) {
        size_t channels = strlen(layer_table[l]->channels);
        if (!from->layers[l]) continue;
        for (int y = 0; y < like->gb.height; y++)
            for (int x = 0; x < like->gb.width; x++) {
                int u = x_flip ? like->gb.width - 1 - x : x, w = y_flip ? like->gb.height - 1 - y : y;
                size_t i = (size_t)y * (size_t)like->gb.width + (size_t)x;
                size_t j =
                    transpose ? (size_t)u * (size_t)from->gb.width + (size_t)w : (size_t)w * (size_t)from->gb.width + (size_t)u;
                memcpy(like->layers[l] + channels * i, from->layers[l] + channels * j, channels * sizeof(float));
            }
    }
}

static void mirror_and_roll(void **state)
{
    static const struct {
        const char *name;
        bool x, y, transpose;
    } turns[] = {{"mirrored", true, false, false}, {"rolled by 180", true, true, false}, {"rolled by 90", false, true, true}};
    subject s = clutter();
    double mean = 0.0, ratio = 0.0;
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
        frame_result a, b, other;
        pass_settings set = defaults(m, s.scene.radius), seeded = set;
        seeded.seed = 1;
        run(*state, &s.gb, m, &set, &a);
        run(*state, &s.gb, m, &seeded, &other);
        difference noise = hard_compare(&a, &other, LAYER_OCCLUSION, NULL);
        for (size_t k = 0; k < sizeof turns / sizeof *turns; k++) {
            gbuffer gb;
            flip(&s.gb, turns[k].x, turns[k].y, turns[k].transpose, &gb);
            run(*state, &gb, m, &set, &b);
            unflip(&b, turns[k].x, turns[k].y, turns[k].transpose, &other);
            difference d = hard_compare(&a, &other, LAYER_OCCLUSION, NULL), l = hard_compare(&a, &other, LAYER_RADIANCE, NULL);
            printf("%s, %s: mean %+.5f, rms %.5f = %.2f of the noise between two seeds; radiance mean %+.5f\n", turns[k].name,
                   m->name, d.mean, d.rms, d.rms / noise.rms, l.mean);
            mean = fmax(mean, fmax(fabs(d.mean), fabs(l.mean)));
            ratio = fmax(ratio, d.rms / noise.rms);
            rig_free_result(&b);
            gbuffer_free(&gb);
        }
        rig_free_result(&a);
        rig_free_result(&other);
    }
    gbuffer_free(&s.gb);
    printf("figure: mirror and roll: mean change at most %.5f, rms at most %.2f of the noise between two seeds, all methods\n",
           mean, ratio);
    assert_true(mean < 0.001 && ratio < 1.5);
}

// The size of the pieces that the GPU is given is nobody's business.
static void tiles(void **state)
{
    static const char *const sizes[] = {"8", "24", "64", "4096"};
    subject s = clutter();
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) {
        frame_result a, b;
        pass_settings set = defaults(m, s.scene.radius);
        unsetenv("SSDO_TILE");
        run(*state, &s.gb, m, &set, &a);
        for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
            setenv("SSDO_TILE", sizes[i], 1);
            run(*state, &s.gb, m, &set, &b);
            assert_int_equal(b.tile_size, atoi(sizes[i]));
            for (int l = 0; l < LAYER_COUNT; l++)
                if (a.layers[l])
                    assert_memory_equal(a.layers[l], b.layers[l],
                                        WIDTH * HEIGHT * sizeof(float) * strlen(layer_table[l]->channels));
            rig_free_result(&b);
        }
        rig_free_result(&a);
    }
    unsetenv("SSDO_TILE");
    gbuffer_free(&s.gb);
    printf("figure: tiles of 8, 24, 64, 4096 pixels: the same bits, all methods\n");
}

// hard_invariants [FILTER]
int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(empty_planes),
        cmocka_unit_test(scale),
        cmocka_unit_test(mirror_and_roll),
        cmocka_unit_test(tiles),
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests_name("hard invariants", tests, hard_open, hard_close);
}
