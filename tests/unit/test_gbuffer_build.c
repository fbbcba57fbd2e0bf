// gbuffer_build: cameras, validity and depth.
#include "gbuffer_scene.h"

static void test_perspective(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    gbuffer g = built();
    assert_exact(&g, 1e-5);
    assert_int_equal(g.camera.source, CAMERA_FROM_FIT);
    assert_true(g.camera.residual < 0.01 && g.camera.has_world && fabs(g.camera.fx / 180 - 1) < 1e-5);
    assert_int_equal(g.depth_kind, DEPTH_PLANAR);
    assert_false(g.normals_from_depth || g.position_is_camera_space);
    assert_true(g.depth_from_position && g.off_ray == 0 && g.valid > N / 3 && g.valid < N && g.evidence_count > 0);
    vec3 p = gbuffer_position(&g, W / 2, H / 2);
    double x, y;
    assert_true(camera_project(&g.camera, p, &x, &y) && fabs(x - W / 2.0 - 0.5) < 1e-9 && fabs(y - H / 2.0 - 0.5) < 1e-9);
    double radius = gbuffer_auto_radius(&g);
    assert_true(radius > 0.02 && radius < 2);
    gbuffer_free(&g);
}

static void test_radial_is_measured(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.radial = true;
    render(&s);
    gbuffer g = built();
    assert_exact(&g, 1e-5);
    assert_int_equal(g.depth_kind, DEPTH_RADIAL);
    gbuffer_free(&g);
}

static void test_orthographic(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_ORTHOGRAPHIC);
    render(&s);
    for (int with_depth = 1; with_depth >= 0; with_depth--) {
        if (!with_depth) drop(Z, Z);
        gbuffer g = built();
        assert_int_equal(g.camera.kind, CAMERA_ORTHOGRAPHIC);
        assert_exact(&g, 1e-5);
        assert_true(fabs(g.camera.fx / 25 - 1) < 1e-5);
        gbuffer_free(&g);
    }
    // A mirrored world: the fit alone cannot know, depth and normals can.
    for (int r = 0; r < 3; r++) s.camera.world_from_camera.m[r][0] = -s.camera.world_from_camera.m[r][0];
    render(&s);
    for (int with_depth = 1; with_depth >= 0; with_depth--) {
        if (!with_depth) drop(Z, Z);
        gbuffer g = built();
        assert_exact(&g, 1e-5);
        assert_true(m3_det(g.camera.world_from_camera) < 0);
        gbuffer_free(&g);
    }
}

static void test_backgrounds(void **state)
{
    (void)state;
    const double backgrounds[] = {0, INFINITY, (double)NAN, 1e10, 1e11, 1e30, -1};
    for (size_t i = 0; i < sizeof backgrounds / sizeof *backgrounds; i++)
        for (int p = 0; p < 3; p++) {
            scene s = base_scene(CAMERA_PERSPECTIVE);
            s.background = backgrounds[i], s.background_p = p == 0 ? 0 : p == 1 ? 1e30 : (double)NAN;
            render(&s);
            gbuffer g = built();
            assert_exact(&g, 1e-5);
            gbuffer_free(&g);
            drop(Z, Z); // P alone says it too
            g = built();
            assert_exact(&g, 1e-5);
            gbuffer_free(&g);
        }
}

// The world's origin may lie on a visible surface: the pixel that shows exactly (0, 0, 0) is no hole.
static void test_origin_is_a_place(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    size_t i = (size_t)(H / 2) * W + W / 4;
    assert_true(true_depth[i] > 0);
    s.shift = v3(-(double)pixels[PX][i], -(double)pixels[PY][i], -(double)pixels[PZ][i]);
    render(&s);
    pixels[PX][i] = pixels[PY][i] = pixels[PZ][i] = 0;
    gbuffer g = built();
    assert_exact(&g, 1e-5);
    gbuffer_free(&g);
    // The same P elsewhere, with a valid depth that does not agree, is missing data; so it is with a background depth.
    size_t wrong = (size_t)(H - 5) * W + 10;
    pixels[PX][wrong] = pixels[PY][wrong] = pixels[PZ][wrong] = 0;
    pixels[Z][i] = 1e10f;
    g = built();
    assert_true(g.depth[wrong] == 0 && g.depth[i] == 0);
    gbuffer_free(&g);
    pixels[Z][i] = (float)(1.5 * true_depth[i]); // in its pixel, but not at its depth
    g = built();
    assert_true(g.depth[i] == 0);
    gbuffer_free(&g);
}

static void test_bad_positions(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    uint64_t random = 17;
    for (size_t i = 0; i < N; i++)
        if (true_depth[i] > 0 && solve_random(&random) % 3 == 0)
            for (int c = PX; c <= PZ; c++) pixels[c][i] = (float)(solve_random(&random) % 1000) * 0.01f - 5;
    gbuffer g = built();
    assert_true(fabs(g.camera.fx / 180 - 1) < 1e-4);
    // Depth comes to the rescue, but for the few that happen to land near their own ray.
    double d, n;
    compare(&g, &d, &n, 1e-4, 1e-3);
    assert_true(d < 0.003 && n == 0);
    for (size_t i = 0; i < N; i++) assert_int_equal(g.depth[i] > 0, true_depth[i] > 0);
    gbuffer_free(&g);
}

static void test_moved_onto_the_ray(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        scene s = base_scene(kind ? CAMERA_ORTHOGRAPHIC : CAMERA_PERSPECTIVE);
        s.jitter = 1.0;
        render(&s);
        gbuffer g = built();
        double d, n, unmoved;
        compare(&g, &d, &n, 2e-3, 0.1);
        assert_true(d < 0.02 && n < 0.05);
        assert_true(g.off_ray > g.valid * 8 / 10);
        size_t off = 0;
        for (size_t i = 0; i < N; i++)
            off += true_depth[i] > 0 && pixels[Z][i] < 1e9f && fabs((double)pixels[Z][i] / true_depth[i] - 1) > 2e-3;
        unmoved = (double)off / (double)g.valid;
        assert_true(unmoved > 5 * d); // the picture as stored is clearly worse
        gbuffer_free(&g);
    }
}

// Normals that are not the surface's (bumps, interpolation) must not fling a jittered position along its ray.
static void test_move_is_restrained(void **state)
{
    (void)state;
    for (int tilt = 0; tilt < 2; tilt++) {
        scene s = base_scene(CAMERA_PERSPECTIVE);
        s.jitter = 1.0;
        render(&s);
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                size_t i = (size_t)y * W + (size_t)x;
                if ((x + 3 * y) % 7 || !(true_depth[i] > 0)) continue;
                // Nearly across the ray: seen at a cosine of 0.03 (grazing) or 0.12 (not quite).
                vec3 d = v3_normalize(v3((x + 0.5 - W / 2.0) / 180, (y + 0.5 - H / 2.0) / 180, 1));
                vec3 across = v3_normalize(v3_cross(d, v3(0, 1, 0)));
                vec3 n = v3_normalize(v3_sub(across, v3_scale(d, tilt ? 0.03 : 0.12)));
                put(NX, i, m3_apply(s.camera.world_from_camera, n));
            }
        gbuffer g = built();
        for (int y = 1; y < H - 1; y++)
            for (int x = 1; x < W - 1; x++) {
                size_t i = (size_t)y * W + (size_t)x;
                double low = INFINITY, high = 0;
                for (int j = 0; j < 9; j++) {
                    double d = true_depth[(size_t)(y + j / 3 - 1) * W + (size_t)(x + j % 3 - 1)];
                    low = fmin(low, d), high = fmax(high, d);
                }
                if (!(low > 0) || high > 1.03 * low) continue; // an edge
                assert_true(fabs((double)g.depth[i] / true_depth[i] - 1) < (tilt ? 0.6 : 1.6) * (high / low - 1) + 1e-3);
            }
        gbuffer_free(&g);
    }
}

static void test_half_positions(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.shift = v3(40, -90, 20);
    render(&s);
    static uint16_t half[3][N];
    for (int c = 0; c < 3; c++) {
        for (size_t i = 0; i < N; i++) half[c][i] = float_to_half(pixels[PX + c][i]);
        channels[PX + c].type = SAMPLE_HALF, channels[PX + c].data = half[c];
    }
    gbuffer g = built();
    assert_false(g.depth_from_position);
    double d, n;
    compare(&g, &d, &n, 1e-4, 0.02);
    assert_true(d == 0 && n < 0.01);
    gbuffer_free(&g);
}

static void test_far_from_the_origin(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.shift = v3(20000, -90000, 3000);
    render(&s);
    gbuffer g = built();
    double d, n;
    compare(&g, &d, &n, 1e-4, 0.01);
    assert_true(d == 0 && n < 0.01);
    gbuffer_free(&g);
}

static void test_depth_only(void **state)
{
    (void)state;
    for (int radial = 0; radial < 2; radial++) {
        scene s = base_scene(CAMERA_PERSPECTIVE);
        s.radial = radial;
        render(&s);
        drop(PX, NZ);
        gbuffer g;
        error e = {0};
        assert_false(try_build(NULL, (gbuffer_options){0}, &g, &e));
        assert_int_equal(e.code, ERR_INPUT);
        assert_non_null(strstr(e.message, "--fov"));
        double fov = 2 * atan(W / 360.0) * 180 / 3.14159265358979323846;
        resolve_options ro = {.depth = radial ? DEPTH_RADIAL : DEPTH_AUTO};
        g = built_with(&ro, (gbuffer_options){.fov = fov});
        double d, n;
        compare(&g, &d, &n, 1e-5, 0.05);
        assert_true(d == 0 && n < 0.03);
        for (size_t i = 0; i < N; i++) assert_int_equal(g.depth[i] > 0, true_depth[i] > 0);
        assert_true(g.normals_from_depth && !g.depth_from_position && !g.camera.has_world && g.camera.source == CAMERA_FROM_FLAG);
        gbuffer_free(&g);
    }
}

static void test_lens_given_with_positions(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    double fov = 2 * atan(W / 360.0) * 180 / 3.14159265358979323846;
    gbuffer g = built_with(NULL, (gbuffer_options){.fov = fov});
    assert_int_equal(g.camera.source, CAMERA_FROM_FLAG);
    assert_true(g.camera.has_world && g.camera.residual < 0.01);
    assert_exact(&g, 1e-5);
    gbuffer_free(&g);
}

static void test_one_plane(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.only_plane = true;
    render(&s);
    gbuffer g = built();
    assert_int_equal(g.camera.source, CAMERA_FROM_PLANE);
    assert_true(fabs(g.camera.fx / 180 - 1) < 1e-4);
    assert_exact(&g, 1e-5);
    gbuffer_free(&g);
    drop(Z, Z);
    error e = {0};
    assert_false(try_build(NULL, (gbuffer_options){0}, &g, &e));
    assert_non_null(strstr(e.message, "--camera"));
    assert_string_equal(e.file, "in.exr");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_perspective),        cmocka_unit_test(test_radial_is_measured),
        cmocka_unit_test(test_orthographic),       cmocka_unit_test(test_backgrounds),
        cmocka_unit_test(test_origin_is_a_place),  cmocka_unit_test(test_bad_positions),
        cmocka_unit_test(test_moved_onto_the_ray), cmocka_unit_test(test_move_is_restrained),
        cmocka_unit_test(test_half_positions),     cmocka_unit_test(test_far_from_the_origin),
        cmocka_unit_test(test_depth_only),         cmocka_unit_test(test_lens_given_with_positions),
        cmocka_unit_test(test_one_plane),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
