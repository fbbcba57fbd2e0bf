// Reference A in tests/lib: the estimators on recorded layers, against closed forms and their own expectations.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "../lib/near.h"
#include "../lib/reference.h"
#include "../lib/scene_picture.h"
#include "../lib/truth.h"

#define RADIANS(degrees) ((degrees) * (M_PI / 180.0))

typedef struct bench {
    gbuffer g;
    layer l;
} bench;

static void setup(bench *b, const scene *s, const view *v)
{
    error e = {0};
    assert_true(scene_gbuffer(s, v, &b->g, &e));
    assert_true(layer_build(&b->g, &b->l, &e));
}

static void teardown(bench *b)
{
    layer_free(&b->l);
    free(b->g.depth), free(b->g.normal), free(b->g.albedo);
}

static void slice_measure_is_the_integral(void **state)
{
    (void)state;
    const double normals[] = {-1.3, -0.8, 0.0, 0.3, 0.8};
    for (size_t i = 0; i < sizeof normals / sizeof *normals; i++) {
        double n = normals[i];
        for (double t = n - M_PI_2; t <= n + M_PI_2; t += 0.2) {
            double sum = 0.0;
            for (int k = 0; k < 4000; k++) {
                double at = t * (k + 0.5) / 4000.0;
                sum += fabs(sin(at)) * cos(at - n) * t / 4000.0;
            }
            assert_near(reference_slice_measure(t, n), sum, 1e-6);
        }
        double open = reference_slice_measure(n + M_PI_2, n) - reference_slice_measure(n - M_PI_2, n);
        assert_near(open, cos(n) + n * sin(n), 1e-12);
    }
}

static void an_empty_plane_is_open(void **state)
{
    (void)state;
    for (int i = 0; i < 10; i++) {
        scene s;
        scene_tilted_plane(&s, 21.5 * (i / 2), i < 5 ? 2.0 : 200.0); // 0 .. 86 degrees
        view v = i % 2 ? view_orthographic(96, 72, 0.7 * s.target.y, 1.25) : view_perspective(96, 72, 20.0 + 8.0 * i, 0.8);
        view_look(&v, s.eye, s.target, 13.0 * i);
        v.camera.origin.y -= i % 2 ? 5.0 * s.target.y : 0.0; // an orthographic camera must stand before all of the plane
        bench b;
        setup(&b, &s, &v);
        pixel pixels[8];
        int n = reference_pixels(&b.l, 8, pixels);
        assert_true(n >= 4);
        for (int k = 0; k < n; k++) {
            reference_slice_options slices = {.radius = s.radius, .thickness = 0.5 * s.radius, .slices = 16};
            assert_near(reference_horizon(&b.l, pixels[k], &slices), 1.0, 1e-6);
            assert_near(reference_bitmask(&b.l, pixels[k], &slices), 1.0, 1e-6);
            assert_near(reference_hbao(&b.l, pixels[k], &(reference_hbao_options){s.radius, 0.0, 16, 64}), 1.0, 0.0);
            assert_near(reference_hemisphere(&b.l, pixels[k], &(reference_hemisphere_options){s.radius, 8, 8, 8}), 1.0, 0.0);
            assert_near(reference_alchemy(&b.l, pixels[k], &(reference_alchemy_options){.radius = s.radius}), 0.0, 0.0);
            reference_ssdo_options o = {
                .radius = s.radius, .thickness = INFINITY, .elevations = 16, .azimuths = 16, .distances = 8};
            reference_ssdo_result r = reference_ssdo(&b.l, pixels[k], &o);
            assert_near(r.occlusion, 1.0, 0.0);
            assert_near(r.visibility, 1.0, 0.0);
            assert_near3(r.radiance, v3(1, 1, 1), 1e-12);
        }
        teardown(&b);
    }
}

// A view of the wall scene in which the ball of radius 1 around the point near the foot is wholly in the picture.
static pixel wall_view(const scene *s, int kind, view *v)
{
    *v = kind ? view_orthographic(240, 180, 4.0, 1.2) : view_perspective(240, 180, 45.0, 1.0);
    view_look(v, s->eye, v3(0, 0, 0.2), 10.0 * kind);
    double x, y, z;
    view_project(v, s->point, &x, &y, &z);
    return (pixel){(int)x, (int)y};
}

// Ground distance from the foot of what the pixel really shows.
static double foot_distance(const scene *s, const view *v, pixel p)
{
    hit h;
    assert_true(scene_at_pixel(s, v, p.x, p.y, &h));
    assert_near(h.position.z, 0.0, 1e-9);
    return -h.position.y;
}

static void slices_agree_on_the_wall(void **state)
{
    (void)state;
    for (int i = 0; i < 12; i++) {
        double a = 30.0 + 30.0 * (i / 4); // 30, 60, 90: a wall that leans over would hide its own foot
        scene s;
        scene_wall(&s, a, i & 1 ? 0.15 : 0.6);
        view v;
        pixel p = wall_view(&s, (i >> 1) & 1, &v);
        bench b;
        setup(&b, &s, &v);
        double x = foot_distance(&s, &v, p), wanted = truth_wall_cutoff(RADIANS(a), x, 1.0);
        reference_slice_options o = {.radius = 1.0, .thickness = 0.3};
        assert_near(reference_horizon(&b.l, p, &o), wanted, 1e-3);
        assert_near(reference_bitmask(&b.l, p, &o), wanted, 1e-3);
        o.thickness = INFINITY;
        assert_near(reference_bitmask(&b.l, p, &o), wanted, 1e-3);
        teardown(&b);
    }
}

// The bar from straight above: a horizon cannot see under it, a bitmask with the bar's own thickness can.
static void thickness_lets_light_under_the_bar(void **state)
{
    (void)state;
    scene s;
    scene_bar(&s, 0.2, 0.1, 0.5, 0.4);
    view v = view_orthographic(600, 200, 15.0, 1.0); // 40 pixels a unit: the bar's edges lie between pixels
    view_look(&v, v3(0, 0, 10), v3(0, 0, 0), 0.0);
    bench b;
    setup(&b, &s, &v);
    pixel p = {300, 100 - 16};
    hit h;
    assert_true(scene_at_pixel(&s, &v, p.x, p.y, &h));
    assert_near(h.position.z, 0.0, 1e-9);
    double y = fabs(h.position.y);
    reference_slice_options o = {.radius = INFINITY, .thickness = 0.1, .slices = 256};
    assert_near(reference_bitmask(&b.l, p, &o), truth_bar(0.2, 0.1, 0.5, y), 0.01);
    // All below the bar's upper edges counts as blocked: the shadow of a solid wall of the same outline.
    assert_near(reference_horizon(&b.l, p, &o), 0.5 + 0.5 * sin(atan2(y - 0.1, 0.6)), 0.01);
    teardown(&b);
}

// Arcs that lie within other arcs count once: a second bar, hidden from the point by the first one.
static void nested_arcs_count_once(void **state)
{
    (void)state;
    view v = view_orthographic(400, 200, 10.0, 1.0);
    view_look(&v, v3(0, 0, 10), v3(0, 0, 0), 0.0);
    double open[2];
    for (int i = 0; i < 2; i++) {
        scene s;
        scene_bar(&s, 0.2, 0.2, 0.4, 0.0);
        if (i) scene_add_box(&s, v3(0, -0.8, 1.4), v3(100, 0.05, 0.1), 0.0, v3(1, 1, 1));
        bench b;
        setup(&b, &s, &v);
        open[i] =
            reference_bitmask(&b.l, (pixel){200, 100 - 16}, &(reference_slice_options){.radius = INFINITY, .thickness = 0.2});
        teardown(&b);
    }
    assert_true(open[0] < 0.9);
    assert_near(open[1], open[0], 1e-9);
}

static void ssdo_meets_its_expectation_at_the_corner(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        scene s;
        scene_corner(&s, i & 1 ? 0.2 : 0.6);
        view v;
        pixel p = wall_view(&s, i >> 1, &v);
        bench b;
        setup(&b, &s, &v);
        double x = foot_distance(&s, &v, p);
        reference_ssdo_options o = {.radius = 1.0, .thickness = INFINITY};
        reference_ssdo_result r = reference_ssdo(&b.l, p, &o);
        assert_near(r.occlusion, truth_corner_point_test(x, 1.0), 1e-3);
        assert_near(r.radiance.x, r.occlusion, 1e-12); // white sky
        // A thin surface lets samples far behind it see the sky again.
        o.thickness = 0.05;
        assert_true(reference_ssdo(&b.l, p, &o).occlusion > r.occlusion + 0.02);
        teardown(&b);
    }
}

static float *constant_radiance(const gbuffer *g, float value)
{
    size_t n = 4 * (size_t)g->width * (size_t)g->height;
    float *r = malloc(n * sizeof *r);
    for (size_t i = 0; i < n; i++) r[i] = value;
    return r;
}

static void ssdo_bounce_is_bounded_and_coloured(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        scene s;
        scene_corner(&s, i ? 0.5 : 0.03);
        view v;
        pixel p = wall_view(&s, 0, &v);
        bench b;
        setup(&b, &s, &v);
        float *sender = constant_radiance(&b.g, 1.0f);
        double last = 0.0;
        for (int n = 8; n <= 2048; n *= 4) {
            reference_ssdo_options o = {
                .radius = 1.0, .thickness = INFINITY, .sender_radiance = sender, .patches = n, .fade_start = 1.0};
            o.elevations = o.azimuths = 32;
            reference_ssdo_result r = reference_ssdo(&b.l, p, &o);
            assert_true(r.indirect.x > 0.02);
            assert_true(r.indirect.x <= (1.0 - r.occlusion) * 0.8 + 1e-6); // blocked share x brightest sender
            assert_true(r.indirect.x >= last - 1e-9);                      // smaller patches, sharper kernel
            assert_near(r.indirect.y / r.indirect.x, 0.6 / 0.8, 1e-2);     // the wall's colour (the ground cannot send to itself)
            last = r.indirect.x;
            o.fade_start = 0.0;
            assert_true(reference_ssdo(&b.l, p, &o).indirect.x < r.indirect.x);
        }
        free(sender);
        teardown(&b);
    }
}

// The bounce of the corner, summed in world space from the exact geometry: the sender of a sample behind the wall is the point of
// the wall on the sample's view ray. Radiance 1, albedo .8, the fade of `o`.
static double corner_bounce(vec3 eye, vec3 point, const reference_ssdo_options *o)
{
    const int n = 64, steps = 16;
    double area = M_PI * o->radius * o->radius / o->patches, form = 0.0, sent = 0.0, blocked = 0.0, all = 0.0;
    for (int i = 0; i < n * n * steps; i++) {
        double cosine = (i / steps / n + 0.5) / n, phi = 2.0 * M_PI * (i / steps % n + 0.5) / n,
               sine = sqrt(1.0 - cosine * cosine);
        vec3 w = v3(sine * cos(phi), sine * sin(phi), cosine),
             s = v3_add(point, v3_scale(w, o->radius * (i % steps + 0.5) / steps));
        all += cosine;
        if (s.y <= 0.0) continue;
        blocked += cosine;
        vec3 to = v3_sub(v3_add(eye, v3_scale(v3_sub(s, eye), -eye.y / (s.y - eye.y))), point);
        double d = v3_length(to), f = area * (to.y / d) * (to.z / d) / (M_PI * d * d + area);
        form += f;
        sent += 0.8 * f * fmin(1.0, fmax(0.0, (1.0 - d / o->radius) / (1.0 - o->fade_start)));
    }
    double samples = (double)n * n * steps, share = blocked / all;
    return sent / samples * o->patches * fmin(1.0, share / (form / samples * o->patches));
}

static void ssdo_bounce_agrees_with_its_sum(void **state)
{
    (void)state;
    scene s;
    scene_corner(&s, 0.4);
    view v;
    pixel p = wall_view(&s, 0, &v);
    bench b;
    setup(&b, &s, &v);
    hit h;
    assert_true(scene_at_pixel(&s, &v, p.x, p.y, &h));
    float *sender = constant_radiance(&b.g, 1.0f);
    for (int n = 2; n <= 128; n *= 4) {
        reference_ssdo_options o = {
            .radius = 1.0, .thickness = INFINITY, .sender_radiance = sender, .patches = n, .fade_start = 0.25};
        assert_near(reference_ssdo(&b.l, p, &o).indirect.x, corner_bounce(s.eye, h.position, &o), 1e-3);
    }
    free(sender);
    teardown(&b);
}

static vec3 sky_of_world(void *data, vec3 d)
{
    (void)data;
    return v3(d.x > 0.0, d.z > 0.0, 0.0);
}

static void ssdo_asks_the_sky_for_world_directions(void **state)
{
    (void)state;
    scene s = {.eye = {0, -3, 3}};
    scene_add_plane(&s, v3(0, 0, 0), v3(0, 0, 1), v3(1, 1, 1));
    view v = view_perspective(32, 32, 40.0, 1.0);
    view_look(&v, s.eye, v3(0, 0, 0), 30.0);
    bench b;
    setup(&b, &s, &v);
    reference_ssdo_options o = {.radius = 0.5, .thickness = INFINITY, .sky = sky_of_world};
    assert_near3(reference_ssdo(&b.l, (pixel){16, 16}, &o).radiance, v3(0.5, 1, 0), 0.002);
    teardown(&b);
}

// A round pit of radius rho and depth h seen from above, the receiver in its middle: a tap outside the pit adds
// 2 pi c h / max(c^2, r^2 + h^2). Uniform in radius: (2 pi c / R) (atan(b / h) - atan(rho / h)), b = sqrt(R^2 - h^2).
// Uniform in area: (2 pi c h / R^2) ln(R^2 / (rho^2 + h^2)).
static void alchemy_agrees_with_its_integral(void **state)
{
    (void)state;
    const double radius = 1.0, h = 0.3, rho = 0.4, c = 0.1 * radius;
    scene s = {.shape_count = 0};
    scene_add_plane(&s, v3(0, 10, 0), v3(0, -1, 0), v3(1, 1, 1));
    view v = view_orthographic(401, 301, 2.4, 0.75);
    bench b;
    setup(&b, &s, &v);
    for (int i = 0; i < 401 * 301; i++) {
        vec3 at = b.l.surfels[i].position;
        b.l.surfels[i].position.z -= hypot(at.x, at.y) > rho ? h : 0.0;
    }
    reference_alchemy_options o = {.radius = radius, .radii = 256};
    double edge = sqrt(radius * radius - h * h);
    assert_near(reference_alchemy(&b.l, (pixel){200, 150}, &o), 2 * M_PI * c / radius * (atan(edge / h) - atan(rho / h)), 0.003);
    o.measure = TAPS_UNIFORM_IN_AREA;
    double area = 2 * M_PI * c * h / (radius * radius) * log(radius * radius / (rho * rho + h * h));
    assert_near(reference_alchemy(&b.l, (pixel){200, 150}, &o), area, 0.003);
    o.bias = 0.1;
    assert_near(reference_alchemy(&b.l, (pixel){200, 150}, &o), area * (h - 0.1) / h, 0.003);
    teardown(&b);
}

static void pixels_are_valid_distinct_and_fixed(void **state)
{
    (void)state;
    scene s;
    scene_sphere(&s, 0.5, 0.5, 1.0);
    view v = view_perspective(160, 90, 60.0, 1.0);
    view_look(&v, v3(0, -3, 0.5), v3(0, 0, 0.6), 0.0);
    bench b;
    setup(&b, &s, &v);
    assert_true(b.g.valid < 160 * 90);
    static pixel first[4096], again[4096];
    static unsigned char seen[160 * 90];
    int n = reference_pixels(&b.l, 4096, first);
    assert_in_range(n, 1500, 4096);
    assert_int_equal(reference_pixels(&b.l, 4096, again), n);
    assert_memory_equal(first, again, (size_t)n * sizeof *first);
    for (int i = 0; i < n; i++) {
        assert_non_null(layer_at(&b.l, first[i].x, first[i].y));
        assert_int_equal(seen[first[i].y * 160 + first[i].x]++, 0);
    }
    teardown(&b);
}

// Not a closed form, but every reference must be near the truth where the camera sees all that matters: open ground.
static void references_are_near_the_truth_on_clutter(void **state)
{
    (void)state;
    scene s;
    scene_clutter(&s);
    view v = view_perspective(160, 120, 60.0, 1.0);
    view_scene(&v, &s);
    bench b;
    setup(&b, &s, &v);
    pixel pixels[64];
    int n = reference_pixels(&b.l, 64, pixels);
    tracer t = scene_tracer(&s);
    double horizon = 0.0, bitmask = 0.0, nothing = 0.0;
    for (int i = 0; i < n; i++) {
        hit h;
        assert_true(scene_at_pixel(&s, &v, pixels[i].x, pixels[i].y, &h));
        double truth = truth_occlusion(&t, h.position, h.normal, &(truth_options){.radius = s.radius, .rays = 1024});
        reference_slice_options o = {.radius = s.radius, .thickness = 0.5 * s.radius, .slices = 32};
        horizon += pow(reference_horizon(&b.l, pixels[i], &o) - truth, 2.0);
        bitmask += pow(reference_bitmask(&b.l, pixels[i], &o) - truth, 2.0);
        nothing += pow(1.0 - truth, 2.0);
    }
    assert_true(sqrt(horizon / n) < 0.12);
    assert_true(sqrt(bitmask / n) < 0.12);
    assert_true(nothing > 4.0 * bitmask);
    teardown(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slice_measure_is_the_integral),
        cmocka_unit_test(an_empty_plane_is_open),
        cmocka_unit_test(slices_agree_on_the_wall),
        cmocka_unit_test(thickness_lets_light_under_the_bar),
        cmocka_unit_test(nested_arcs_count_once),
        cmocka_unit_test(ssdo_meets_its_expectation_at_the_corner),
        cmocka_unit_test(ssdo_bounce_is_bounded_and_coloured),
        cmocka_unit_test(ssdo_bounce_agrees_with_its_sum),
        cmocka_unit_test(ssdo_asks_the_sky_for_world_directions),
        cmocka_unit_test(alchemy_agrees_with_its_integral),
        cmocka_unit_test(pixels_are_valid_distinct_and_fixed),
        cmocka_unit_test(references_are_near_the_truth_on_clutter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
