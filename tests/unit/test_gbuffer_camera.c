// The camera fit on synthetic points: exact, float, jittered, damaged, orthographic, mirrored, on one plane.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "gbuffer/camera.h"
#include "gbuffer/camera_header.h"
#include "gbuffer/camera_solve.h"
#include "gbuffer/solve.h"

enum { W = 640, H = 360, COUNT = 4000 };

static camera_point points[COUNT];
static double depths[COUNT];

static double uniform(uint64_t *state) { return (double)(solve_random(state) >> 11) * 0x1p-53; }

static mat3 pose(double yaw, double pitch, double roll, bool mirrored)
{
    double a = cos(yaw), b = sin(yaw), c = cos(pitch), d = sin(pitch), f = cos(roll), g = sin(roll);
    mat3 y = {{{a, 0, b}, {0, 1, 0}, {-b, 0, a}}}, x = {{{1, 0, 0}, {0, c, -d}, {0, d, c}}},
         z = {{{f, -g, 0}, {g, f, 0}, {0, 0, 1}}};
    mat3 flip = {{{mirrored ? -1.0 : 1.0, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return m3_mul(flip, m3_mul(y, m3_mul(x, z)));
}

static camera truth(camera_kind kind, bool mirrored)
{
    camera c = {.kind = kind, .fx = 700, .fy = 700, .cx = W / 2.0, .cy = H / 2.0, .has_world = true};
    if (kind == CAMERA_ORTHOGRAPHIC) c.fx = c.fy = 80;
    c.world_from_camera = pose(0.7, -0.4, 0.2, mirrored);
    c.origin = v3(3, -2, 5);
    return c;
}

// Points at pixel centres, depths between near and far; `plane`: all on one tilted plane.
static void observe(const camera *c, double near, double far, bool plane, uint64_t seed)
{
    for (int i = 0; i < COUNT; i++) {
        double x = floor(uniform(&seed) * W) + 0.5, y = floor(uniform(&seed) * H) + 0.5;
        double u = (x - c->cx) / c->fx, v = (y - c->cy) / c->fy, t = uniform(&seed);
        double z = near + (far - near) * t;
        bool perspective = c->kind == CAMERA_PERSPECTIVE;
        if (plane) z = perspective ? 4.0 / (1.0 + 0.3 * u - 0.5 * v) : 6.0 + 0.3 * u - 0.5 * v;
        vec3 p = perspective ? v3(u * z, v * z, z) : v3(u, v, z);
        points[i] = (camera_point){v3_add(m3_apply(c->world_from_camera, p), c->origin), x, y};
        depths[i] = z;
    }
}

static void round_to_float(void)
{
    for (int i = 0; i < COUNT; i++) {
        vec3 *w = &points[i].world;
        *w = v3((float)w->x, (float)w->y, (float)w->z);
    }
}

static void spoil(double share, uint64_t seed)
{
    for (int i = 0; i < COUNT; i++)
        if (uniform(&seed) < share)
            points[i].world = v3(20 * uniform(&seed) - 10, 20 * uniform(&seed) - 10, 20 * uniform(&seed) - 10);
}

static void assert_camera(const camera *found, const camera *c, double relative, double length)
{
    assert_int_equal(found->kind, c->kind);
    assert_true(fabs(found->fx / c->fx - 1) < relative);
    assert_true(fabs(found->fy / c->fy - 1) < relative);
    if (c->kind == CAMERA_PERSPECTIVE) {
        assert_true(hypot(found->cx - c->cx, found->cy - c->cy) < relative * c->fx);
        assert_true(v3_length(v3_sub(found->origin, c->origin)) < length);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            assert_true(fabs(found->world_from_camera.m[i][j] - c->world_from_camera.m[i][j]) < 10 * relative);
}

static camera fitted(void)
{
    camera found;
    error e = {0};
    if (!camera_fit(points, COUNT, &found, &e)) fail_msg("%s", e.message);
    return found;
}

static void test_exact(void **state)
{
    (void)state;
    camera c = truth(CAMERA_PERSPECTIVE, false);
    observe(&c, 2, 12, false, 1);
    camera found = fitted();
    assert_true(found.residual >= 0 && found.residual < 1e-6);
    assert_true(found.inliers == 1.0);
    assert_true(found.source == CAMERA_FROM_FIT && found.has_world);
    assert_camera(&found, &c, 1e-8, 1e-7);
}

static void test_off_centre_not_square_mirrored(void **state)
{
    (void)state;
    for (int i = 0; i < 8; i++) {
        camera c = truth(CAMERA_PERSPECTIVE, i & 1);
        if (i & 2) c.cx += 150, c.cy -= 400;
        if (i & 4) c.fy *= 1.9;
        c.world_from_camera = pose(0.5 * i, 0.3 * i, 1.0 * i, i & 1);
        observe(&c, 2, 12, false, 2);
        camera found = fitted();
        assert_true(found.residual < 1e-6);
        assert_camera(&found, &c, 1e-7, 1e-6);
        assert_true((m3_det(found.world_from_camera) < 0) == (i & 1));
    }
}

static void test_float_positions(void **state)
{
    (void)state;
    camera c = truth(CAMERA_PERSPECTIVE, false);
    observe(&c, 2, 12, false, 3);
    round_to_float();
    camera found = fitted();
    assert_true(found.residual < 1e-3);
    assert_camera(&found, &c, 1e-6, 1e-5);

    // Far from the origin of the world the positions are coarse (a 4096th here, about half a pixel), the fit is not.
    c.origin = v3(3000, -2000, 5000);
    observe(&c, 2, 12, false, 3);
    round_to_float();
    found = fitted();
    assert_camera(&found, &c, 1e-4, 2e-3);
}

// A closest filter keeps a sample anywhere in the pixel.
static void test_jitter(void **state)
{
    (void)state;
    camera c = truth(CAMERA_PERSPECTIVE, false);
    observe(&c, 2, 12, false, 4);
    uint64_t random = 99;
    for (int i = 0; i < COUNT; i++) points[i].x += uniform(&random) - 0.5, points[i].y += uniform(&random) - 0.5;
    camera found = fitted();
    assert_true(found.residual > 0.3 && found.residual < 0.5);
    assert_camera(&found, &c, 2e-4, 1e-2);
}

static void test_bad_points(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        camera c = truth(CAMERA_PERSPECTIVE, i == 1);
        if (i == 2) c.cx += 300;
        observe(&c, 2, 12, false, 5);
        spoil(i == 3 ? 0.45 : 0.35, 7);
        camera found = fitted();
        assert_camera(&found, &c, 1e-6, 1e-5);
        assert_true(found.inliers > 0.5 && found.inliers < 0.7);
    }
}

// Bad points that agree with each other (a reflection, another object's pass): no reweighting gets out of that, drawing does.
static void test_conspiring_points(void **state)
{
    (void)state;
    camera c = truth(CAMERA_PERSPECTIVE, false);
    observe(&c, 2, 12, false, 12);
    mat3 turn = pose(1.1, 0.6, -2.0, false);
    for (int i = 0; i < COUNT; i++)
        if (i % 5 < 2) points[i].world = v3_add(v3_scale(m3_apply(turn, points[i].world), 2.0), v3(40, -10, 3));
    camera found = fitted();
    assert_camera(&found, &c, 1e-6, 1e-5);
}

static void test_refine(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        camera c = truth(kind ? CAMERA_ORTHOGRAPHIC : CAMERA_PERSPECTIVE, false), start = c;
        observe(&c, 2, 12, false, 13);
        start.world_from_camera = m3_mul(pose(0.1, -0.08, 0.15, false), c.world_from_camera);
        start.origin = v3_add(c.origin, v3(0.2, 0.3, -0.1));
        start.fx *= 1.1, start.fy *= 0.93;
        unsigned all = FREE_FX | FREE_FY | FREE_CENTRE | FREE_POSE;
        double spread;
        assert_true(camera_refine(&start, points, NULL, NULL, COUNT, all, &spread));
        assert_true(spread > 0 && spread < 1e-2);
        assert_camera(&start, &c, 1e-8, 1e-7);
    }
}

static void test_horizon(void **state)
{
    (void)state;
    // A floor that reaches 10^5 times its nearest distance, and a few things on it.
    camera c = truth(CAMERA_PERSPECTIVE, false);
    observe(&c, 2, 12, false, 6);
    for (int i = 0; i < COUNT; i++) {
        double u = (points[i].x - c.cx) / c.fx, v = (points[i].y - c.cy) / c.fy, z = depths[i];
        if (i % 10) z = v > 1e-5 ? 1.0 / v : 1e5;
        points[i].world = v3_add(m3_apply(c.world_from_camera, v3(u * z, v * z, z)), c.origin);
    }
    round_to_float();
    camera found = fitted();
    assert_true(found.residual < 1e-2);
    assert_camera(&found, &c, 1e-4, 1e-3);
}

static void test_orthographic(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        camera c = truth(CAMERA_ORTHOGRAPHIC, false);
        if (i == 1) c.fy = 120;
        observe(&c, 2, 12, false, 8);
        if (i == 2) spoil(0.35, 3);
        if (i == 1) round_to_float();
        camera found = fitted();
        assert_camera(&found, &c, 1e-6, 0);
        assert_true(found.residual < 1e-3);
        for (int j = 0; j < COUNT && i != 2; j++) assert_true(camera_from_world(&found, points[j].world).z > 0);
    }
}

// Many views, so that no lucky one hides a fragile decision between the two kinds: under parallel rays the perspective fit is
// nonsense, and must not get to choose the points that the two are compared on.
static void test_kind_is_robust(void **state)
{
    (void)state;
    uint64_t random = 31;
    for (int i = 0; i < 24; i++) {
        camera c = truth(i & 1 ? CAMERA_ORTHOGRAPHIC : CAMERA_PERSPECTIVE, false);
        c.world_from_camera = pose(6.28 * uniform(&random), 3 * uniform(&random) - 1.5, 6.28 * uniform(&random), false);
        observe(&c, 2, 12, false, 40 + (uint64_t)i);
        round_to_float();
        spoil(0.1 + 0.3 * uniform(&random), 70 + (uint64_t)i);
        camera found = fitted();
        assert_camera(&found, &c, 1e-5, 1e-4);
    }
}

// worldToNDC as renderers write it (row vectors): 0..1 and y down, -1..1 and y up, w backwards, transposed.
static void test_header(void **state)
{
    (void)state;
    box2 display = {0, 0, W - 1, H - 1}, data = {40, 10, W - 1, H - 1};
    camera c = truth(CAMERA_PERSPECTIVE, false), found;
    observe(&c, 2, 12, false, 14);
    for (int i = 0; i < COUNT; i++) points[i].x -= 40, points[i].y -= 10; // data-window pixels
    for (int form = 0; form < 4; form++) {
        double m[4][4] = {{0}};
        for (int axis = 0; axis < 4; axis++) {
            vec3 unit = v3(axis == 0, axis == 1, axis == 2);
            vec3 p = axis < 3 ? m3_apply(m3_transpose(c.world_from_camera), unit) : camera_from_world(&c, v3(0, 0, 0));
            double x = (c.fx * p.x + c.cx * p.z) / W, y = (c.fy * p.y + c.cy * p.z) / H, sign = form == 2 ? -1 : 1;
            if (form) x = 2 * x - p.z, y = p.z - 2 * y;
            int r = axis;
            m[r][0] = sign * x, m[r][1] = sign * y, m[r][2] = p.z, m[r][3] = sign * p.z;
        }
        if (form == 3)
            for (int a = 0; a < 4; a++)
                for (int b = 0; b < a; b++) {
                    double swap = m[a][b];
                    m[a][b] = m[b][a], m[b][a] = swap;
                }
        for (int with_points = 0; with_points < 2; with_points++) {
            if (form == 3 && !with_points) continue; // not tried then
            assert_true(camera_from_ndc(m, data, display, points, with_points ? COUNT : 0, &found));
            camera expected = c;
            expected.cx -= 40, expected.cy -= 10;
            assert_int_equal(found.source, CAMERA_FROM_HEADER);
            assert_true(found.has_world == (with_points || form != 2));
            if (found.has_world)
                assert_camera(&found, &expected, 1e-9, 1e-8);
            else
                assert_true(fabs(found.fx / c.fx - 1) < 1e-9 && fabs(found.cx - expected.cx) < 1e-6);
        }
        // A header that is not this picture's is refused.
        for (int r = 0; r < 4; r++) m[r][0] += 0.03 * m[r][3];
        assert_false(camera_from_ndc(m, data, display, points, COUNT, &found));
    }
}

static void test_one_plane(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++)
        for (int as_float = 0; as_float < 2; as_float++) {
            camera c = truth(kind ? CAMERA_ORTHOGRAPHIC : CAMERA_PERSPECTIVE, false), found;
            observe(&c, 2, 12, true, 9);
            if (as_float) round_to_float();
            error e = {0};
            assert_false(camera_fit(points, COUNT, &found, &e));
            assert_int_equal(e.code, ERR_INPUT);
            assert_non_null(strstr(e.message, "--fov"));
            assert_non_null(strstr(e.message, "--ortho"));
            assert_non_null(strstr(e.message, "--camera"));
            e = (error){0};
            if (!camera_fit_plane(points, depths, COUNT, 1.0, c.cx, c.cy, &found, &e)) fail_msg("%s", e.message);
            assert_int_equal(found.source, CAMERA_FROM_PLANE);
            assert_camera(&found, &c, as_float ? 1e-5 : 1e-7, as_float ? 1e-4 : 1e-6);
        }
}

static void test_plane_with_bad_points(void **state)
{
    (void)state;
    camera c = truth(CAMERA_PERSPECTIVE, false), found;
    c.fy = 2.0 * c.fx;
    observe(&c, 2, 12, true, 9);
    spoil(0.35, 11);
    error e = {0};
    assert_true(camera_fit_plane(points, depths, COUNT, 2.0, c.cx, c.cy, &found, &e));
    assert_camera(&found, &c, 1e-6, 1e-5);
}

static void test_hopeless(void **state)
{
    (void)state;
    camera c = truth(CAMERA_PERSPECTIVE, false), found;
    observe(&c, 2, 12, false, 1);
    error e = {0};
    assert_false(camera_fit(points, 5, &found, &e));
    assert_non_null(strstr(e.message, "too few"));
    assert_false(camera_fit_plane(points, depths, 2, 1.0, c.cx, c.cy, &found, &(error){0}));
    spoil(1.0, 1);
    e = (error){0};
    assert_false(camera_fit(points, COUNT, &found, &e));
    assert_int_equal(e.code, ERR_INPUT);
    for (int i = 0; i < COUNT; i++) points[i].world = v3(NAN, INFINITY, 0);
    assert_false(camera_fit(points, COUNT, &found, &(error){0}));
    for (int i = 0; i < COUNT; i++) points[i].world = v3(1, 2, 3);
    assert_false(camera_fit(points, COUNT, &found, &(error){0}));
}

static void test_flags(void **state)
{
    (void)state;
    box2 display = {0, 0, 199, 99}, data = {-10, 20, 150, 80};
    camera c;
    camera_from_fov(90, data, display, 2.0, &c);
    assert_true(fabs(c.fx - 100) < 1e-9 && fabs(c.fy - 200) < 1e-9 && c.cx == 110 && c.cy == 30 && !c.has_world);
    camera_from_ortho(4.0, data, display, 1.0, &c);
    assert_true(c.kind == CAMERA_ORTHOGRAPHIC && c.fx == 50 && c.fy == 50 && c.cx == 110);
}

static bool from_text(const char *text, camera *c, error *e)
{
    char path[] = "/tmp/ssdo_camera_XXXXXX";
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_true(write(fd, text, strlen(text)) == (ssize_t)strlen(text));
    close(fd);
    box2 display = {0, 0, 199, 99}, data = {10, 0, 199, 99};
    bool good = camera_from_json(path, data, display, 1.0, c, e);
    unlink(path);
    return good;
}

static void test_json(void **state)
{
    (void)state;
    camera c;
    error e = {0};
    assert_true(from_text("{\"fov\": 90}", &c, &e));
    assert_true(fabs(c.fx - 100) < 1e-9 && c.cx == 90 && !c.has_world);
    assert_true(from_text("{\"focal_px\": [120, 130], \"principal\": [60, 40], \"world_from_camera\": "
                          "[[1,0,0,7],[0,0,-1,8],[0,1,0,9],[0,0,0,1]]}",
                          &c, &e));
    assert_true(c.fx == 120 && c.fy == 130 && c.cx == 50 && c.cy == 40 && c.has_world);
    assert_true(c.origin.x == 7 && c.origin.y == 8 && c.origin.z == 9);
    // Camera y up is world z: our y is down, so a point above the eye has a negative y; the view goes along world y.
    vec3 p = camera_from_world(&c, v3(7, 11, 10));
    assert_true(p.x == 0 && p.y == -1 && p.z == 3);
    assert_true(from_text("{\"ortho_width\": 5}", &c, &e) && c.kind == CAMERA_ORTHOGRAPHIC && c.fx == 40);
    static const char *const bad[] = {"{}",
                                      "[1]",
                                      "nonsense",
                                      "{\"fov\": 0}",
                                      "{\"fov\": \"wide\"}",
                                      "{\"fov\": 190}",
                                      "{\"focal_px\": [1]}",
                                      "{\"fov\": 40, \"ortho_width\": 3}",
                                      "{\"fov\": 40, \"world_from_camera\": [[1,0,0,0]]}",
                                      "{\"fov\": 40, \"world_from_camera\": [[1,1,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        e = (error){0};
        if (from_text(bad[i], &c, &e)) fail_msg("accepted: %s", bad[i]);
        assert_int_equal(e.code, ERR_USAGE);
        assert_true(e.file[0] != 0);
    }
    e = (error){0};
    assert_false(camera_from_json("/nonexistent/camera.json", (box2){0}, (box2){0}, 1, &c, &e));
    assert_int_equal(e.code, ERR_USAGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exact),
        cmocka_unit_test(test_off_centre_not_square_mirrored),
        cmocka_unit_test(test_float_positions),
        cmocka_unit_test(test_jitter),
        cmocka_unit_test(test_bad_points),
        cmocka_unit_test(test_horizon),
        cmocka_unit_test(test_orthographic),
        cmocka_unit_test(test_one_plane),
        cmocka_unit_test(test_plane_with_bad_points),
        cmocka_unit_test(test_hopeless),
        cmocka_unit_test(test_flags),
        cmocka_unit_test(test_json),
        cmocka_unit_test(test_conspiring_points),
        cmocka_unit_test(test_refine),
        cmocka_unit_test(test_kind_is_robust),
        cmocka_unit_test(test_header),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
