// gbuffer_build: normals, coverage, colours, radius, windows, threads.
#include <sys/wait.h>
#include <unistd.h>

#include "gbuffer_scene.h"

static void test_camera_space_positions(void **state)
{
    (void)state;
    // OpenGL's axes: y up, z backwards, for P and N, under names that do not promise world space.
    static char *const plain[] = {"P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "Z"};
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    for (size_t i = 0; i < N; i++) {
        if (!(true_depth[i] > 0)) continue;
        vec3 p = v3((double)pixels[PX][i], (double)pixels[PY][i], (double)pixels[PZ][i]), c = camera_from_world(&s.camera, p);
        put(PX, i, v3(c.x, -c.y, -c.z));
        put(NX, i, v3(true_normal[i].x, -true_normal[i].y, -true_normal[i].z));
    }
    for (int c = PX; c <= Z; c++) channels[c].name = plain[c];
    gbuffer g = built();
    assert_true(g.position_is_camera_space && !g.camera.has_world);
    assert_exact(&g, 1e-5);
    gbuffer_free(&g);
}

// Normals in camera space, or stored as 0..1, beside world positions: measured, not believed.
static void test_odd_normals(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    for (int odd = 0; odd < 4; odd++) {
        render(&s);
        for (size_t i = 0; i < N; i++) {
            vec3 n = true_normal[i], w = v3((double)pixels[NX][i], (double)pixels[NY][i], (double)pixels[NZ][i]);
            if (odd == 0) n = v3(n.x, -n.y, -n.z);
            if (odd == 1) n = v3(n.x, -n.y, n.z);
            if (odd == 2) n = v3(w.x * 0.5 + 0.5, w.y * 0.5 + 0.5, w.z * 0.5 + 0.5);
            if (odd == 3) n = v3(n.x * 0.5 + 0.5, -n.y * 0.5 + 0.5, -n.z * 0.5 + 0.5);
            put(NX, i, n);
        }
        gbuffer g = built();
        assert_false(g.normals_from_depth);
        assert_exact(&g, 1e-5);
        gbuffer_free(&g);
    }
}

static void test_damaged_normals(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    uint64_t random = 21;
    for (size_t i = 0; i < N; i++) {
        uint64_t what = solve_random(&random) % 8;
        for (int c = NX; c <= NZ; c++) {
            if (what == 0) pixels[c][i] = 0;
            if (what == 1) pixels[c][i] = NAN;
            if (what == 2) pixels[c][i] *= -1; // the back of a double-sided surface
            if (what == 3) pixels[c][i] *= 0.4f;
        }
    }
    gbuffer g = built();
    double d, n;
    compare(&g, &d, &n, 1e-5, 0.05);
    assert_true(d == 0 && n < 0.02);
    gbuffer_free(&g);
}

// Opaque film: alpha is 1 throughout, coverage is the length of the averaged normal; transparent film: alpha.
static void test_coverage(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.averaged_edges = true, s.no_ground = true;
    for (int film = 0; film < 2; film++) {
        render(&s);
        for (size_t i = 0; film && i < N; i++) {
            vec3 n = v3((double)pixels[NX][i], (double)pixels[NY][i], (double)pixels[NZ][i]);
            pixels[A][i] = (float)(0.5 * v3_length(n));
            if (true_depth[i] > 0 && true_normal[i].z < -0.3) pixels[A][i] = 0.9f;
        }
        gbuffer g = built_with(NULL, (gbuffer_options){.need = NEED_COVERAGE});
        size_t soft = 0, fringe = 0;
        for (int y = 1; y < H - 1; y++)
            for (int x = 1; x < W - 1; x++) {
                size_t i = (size_t)y * W + (size_t)x;
                double k = (double)g.coverage[i];
                int around = 0;
                for (int j = 0; j < 9; j++) around += true_depth[(size_t)(y + j / 3 - 1) * W + (size_t)(x + j % 3 - 1)] > 0;
                assert_true(k >= 0 && k <= 1);
                if (around == 0) assert_true(k < 0.75);
                if (around == 9) assert_true(k == 1);
                if (around > 0 && around < 9) {
                    vec3 n = v3((double)pixels[NX][i], (double)pixels[NY][i], (double)pixels[NZ][i]);
                    assert_true(fabs(k - (film ? (double)pixels[A][i] : fmin(v3_length(n), 1))) < 1e-6);
                    soft += k > 0.1 && k < 0.9;
                }
                if (g.depth[i] == 0 && k > 0) {
                    const float *n = g.normal + 4 * i;
                    assert_true(fabs(sqrt((double)(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])) - 1) < 1e-5);
                    fringe++;
                }
                if (g.depth[i] == 0 && k == 0) assert_true(g.normal[4 * i] == 0 && g.normal[4 * i + 2] == 0);
            }
        assert_true(soft > 20 && fringe > 10);
        gbuffer_free(&g);
    }
}

static void test_colours(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    pixels[R][0] = NAN, pixels[G][0] = INFINITY, pixels[B][0] = -INFINITY, pixels[A][0] = 0.5f;
    pixels[AR][1] = 1e38f, pixels[ROUGH][2] = 7;
    gbuffer g = built_with(NULL, (gbuffer_options){.need = NEED_ALBEDO | NEED_BEAUTY | NEED_MATERIAL | NEED_EMISSION});
    assert_true(g.beauty[0] == 0 && g.beauty[1] == 1e30f && g.beauty[2] == 0 && g.beauty[3] == 0.5f && g.has_alpha);
    assert_true(g.albedo[4] == 1e30f && g.albedo[5] == 0.5f && g.albedo[7] == 0);
    assert_true(g.material[0] == 0.3f && g.material[1] == 0 && g.material[4] == 1);
    assert_null(g.emission);
    assert_null(g.diffuse_direct);
    assert_null(g.coverage);
    size_t i = (size_t)7 * W + 9;
    assert_true(g.beauty[4 * i] == 9 && g.beauty[4 * i + 1] == 7 && g.beauty[4 * i + 3] == 1);
    gbuffer_free(&g);
    drop(A, A);
    g = built_with(NULL, (gbuffer_options){.need = NEED_BEAUTY});
    assert_true(g.beauty[3] == 1 && !g.has_alpha);
    assert_null(g.albedo);
    gbuffer_free(&g);
}

static void test_nothing_there(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.no_ground = s.only_plane = true;
    render(&s);
    gbuffer g = built_with(NULL, (gbuffer_options){.need = NEED_COVERAGE | NEED_ALBEDO});
    assert_true(g.valid == 0 && g.extent == 0 && gbuffer_auto_radius(&g) == 0 && g.camera.fx > 0);
    gbuffer_free(&g);
}

// The radius scales with the scene.
static void test_radius_is_unit_free(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    gbuffer g = built();
    double radius = gbuffer_auto_radius(&g);
    gbuffer_free(&g);
    for (int c = PX; c <= PZ; c++)
        for (size_t i = 0; i < N; i++) pixels[c][i] *= 1024;
    for (size_t i = 0; i < N; i++) pixels[Z][i] *= pixels[Z][i] < 1e9f ? 1024 : 1;
    g = built();
    assert_true(fabs(gbuffer_auto_radius(&g) / radius / 1024 - 1) < 1e-5);
    gbuffer_free(&g);
}

// A crop: the data window is a part of the display window, and the centre of projection lies off its middle.
static void test_data_window(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.camera.cx += 70, s.camera.cy -= 40;
    render(&s);
    part.data_window = (box2){30, 50, 30 + W - 1, 50 + H - 1};
    part.display_window = (box2){0, 0, 299, 199};
    gbuffer g = built();
    assert_exact(&g, 1e-5);
    assert_true(g.width == W && g.height == H && g.data_window.x0 == 30 && fabs(g.camera.cx - W / 2.0 - 70) < 0.01);
    gbuffer_free(&g);
}

static void test_same_bits_for_any_threads(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.jitter = 1.0;
    render(&s);
    gbuffer g[2];
    for (int i = 0; i < 2; i++) {
        resolution r;
        error e = {0};
        assert_true(resolve_channels(&file, &(resolve_options){0}, &r, NULL, &e));
        assert_true(gbuffer_build(&file, &r, &(gbuffer_options){.need = NEED_COVERAGE, .threads = i ? 7 : 1}, &g[i], NULL, &e));
    }
    assert_memory_equal(g[0].depth, g[1].depth, N * sizeof(float));
    assert_memory_equal(g[0].normal, g[1].normal, 4 * N * sizeof(float));
    assert_memory_equal(g[0].coverage, g[1].coverage, N * sizeof(float));
    assert_true(g[0].extent == g[1].extent && g[0].off_ray == g[1].off_ray);
    for (int i = 0; i < 2; i++) gbuffer_free(&g[i]);
}

// What a build comes to when its n-th allocation fails: 0 the same depths as ever, 1 ERR_MEMORY, 2 anything else. In a process of
// its own, because allocations are counted from the first one that is watched.
static int outcome(int n, gbuffer_options options, const gbuffer *expected)
{
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        char text_n[16];
        gbuffer g;
        error e = {0};
        snprintf(text_n, sizeof text_n, "%d", n);
        setenv("SSDO_FAIL_ALLOC", text_n, 1);
        if (!try_build(NULL, options, &g, &e)) _exit(e.code == ERR_MEMORY ? 1 : 2);
        bool same = memcmp(g.depth, expected->depth, N * sizeof(float)) == 0 && g.extent == expected->extent &&
                    g.camera.residual == expected->camera.residual;
        gbuffer_free(&g);
        _exit(same ? 0 : 2);
    }
    int status = -1;
    assert_true(child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status));
    return WEXITSTATUS(status);
}

// Memory that runs out is an error, never another picture.
static void test_out_of_memory(void **state)
{
    (void)state;
    for (int way = 0; way < 3; way++) {
        scene s = base_scene(CAMERA_PERSPECTIVE);
        s.jitter = 1.0, s.only_plane = way == 1;
        render(&s);
        gbuffer_options options = {.need = NEED_COVERAGE | NEED_BEAUTY, .fov = way == 2 ? 47.925 : 0};
        gbuffer expected = built_with(NULL, options);
        // More than a build makes; some it survives (a thread that cannot be started), with the same result.
        int failures = 0;
        for (int n = 1; n <= 60; n++) {
            int code = outcome(n, options, &expected);
            assert_true(code < 2);
            failures += code;
        }
        assert_true(failures >= 10);
        gbuffer_free(&expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_camera_space_positions),
        cmocka_unit_test(test_odd_normals),
        cmocka_unit_test(test_damaged_normals),
        cmocka_unit_test(test_coverage),
        cmocka_unit_test(test_colours),
        cmocka_unit_test(test_nothing_there),
        cmocka_unit_test(test_radius_is_unit_free),
        cmocka_unit_test(test_data_window),
        cmocka_unit_test(test_same_bits_for_any_threads),
        cmocka_unit_test(test_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
