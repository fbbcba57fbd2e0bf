// A depth without normals: balls before a curved wall that fills the picture. Which way its values run, and whether it is one.
#include "gbuffer/depth_direction.h"
#include "gbuffer_scene.h"

static const double near = 0.05, far = 3.0;

// Planar depth of the balls or, if flat, of boards in their places before a tilted wall. Below 1, so that 1 / z lies beyond 1.
static double depth_at(bool flat, int x, int y)
{
    static const double balls[4][4] = {
        {0, 0, 2, 1.4}, {-0.12, 0.01, 0.4, 0.08}, {0.09, -0.06, 0.5, 0.09}, {0.1, 0.08, 0.35, 0.04}};
    vec3 d = v3_normalize(v3((x + 0.5 - W / 2.0) / 180, (y + 0.5 - H / 2.0) / 180, 1.0));
    double z = 0.8 / (1.0 - 0.3 * d.x / d.z);
    for (int i = 0; i < 4; i++) {
        vec3 c = v3(balls[i][0], balls[i][1], balls[i][2]);
        double b = v3_dot(c, d), inside = b * b - v3_dot(c, c) + balls[i][3] * balls[i][3];
        if (inside > 0.0 && !(flat && i == 0)) z = fmin(z, flat ? c.z + 0.2 * i * d.x * c.z : (b - sqrt(inside)) * d.z);
    }
    return z;
}

static double stored(depth_kind k, double z)
{
    double hyperbolic = far * (z - near) / (z * (far - near));
    if (k == DEPTH_INVERSE) return 1.0 / z;
    if (k == DEPTH_ZBUFFER) return hyperbolic;
    return k == DEPTH_REVERSED ? 1.0 - hyperbolic : k == DEPTH_NDC ? 2.0 * hyperbolic - 1.0 : z;
}

static void fill(depth_kind k, bool flat)
{
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) pixels[Z][y * W + x] = (float)stored(k, depth_at(flat, x, y));
}

static depth_direction ask(depth_kind k, bool flat, bool linear_inverse)
{
    gbuffer g = {.width = W, .height = H};
    resolution r = {.background_depth = 1e9};
    build b = {.g = &g, .r = &r};
    fill(k, flat);
    b.position.z = (plane){.data = pixels[Z], .type = SAMPLE_FLOAT, .width = W, .height = H};
    b.position.code.sign = 1.0;
    return depth_find_direction(&b, linear_inverse);
}

static void outlines_tell(void **state)
{
    (void)state;
    assert_int_equal(ask(DEPTH_PLANAR, false, false), LARGER_IS_FARTHER);
    assert_int_equal(ask(DEPTH_INVERSE, false, false), LARGER_IS_NEARER);
    assert_int_equal(ask(DEPTH_INVERSE, false, true), LARGER_UNKNOWN); // 1 and more are no values of a z-buffer
    assert_int_equal(ask(DEPTH_REVERSED, false, true), LARGER_IS_NEARER);
    assert_int_equal(ask(DEPTH_ZBUFFER, false, true), LARGER_IS_FARTHER);
    assert_int_equal(ask(DEPTH_NDC, false, true), LARGER_IS_FARTHER);
}

static void boards_do_not(void **state)
{
    (void)state;
    assert_int_equal(ask(DEPTH_REVERSED, true, true), LARGER_UNKNOWN);
    assert_int_equal(ask(DEPTH_ZBUFFER, true, true), LARGER_UNKNOWN);
}

static bool doubted(void)
{
    gbuffer g = built_with(NULL, (gbuffer_options){.fov = 2 * atan(W / 360.0) * 180 / 3.14159265358979323846});
    bool doubtful = g.depth_verdict.doubtful;
    assert_true(g.valid > N / 3);
    gbuffer_free(&g);
    return doubtful;
}

// Nothing of 1 / z is flat, is 0 or has a normal.
static void no_inverse_in_silence(void **state)
{
    (void)state;
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    drop(PX, NZ);
    fill(DEPTH_INVERSE, false);
    assert_true(doubted());
}

// A depth in R, G and B is grey.
static void false_colours(void **state)
{
    (void)state;
    static char colours[3][8] = {"depth.R", "depth.G", "depth.B"};
    static const int at[3] = {Z, G, B};
    scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    drop(PX, CHANNELS - 1);
    for (int k = 0; k < 3; k++) channels[at[k]].name = colours[k];
    memcpy(pixels[G], pixels[Z], sizeof pixels[G]);
    memcpy(pixels[B], pixels[Z], sizeof pixels[B]);
    assert_false(doubted());
    for (int i = 0; i < N; i++) pixels[B][i] = 10.0f - pixels[B][i];
    assert_true(doubted());
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(outlines_tell), cmocka_unit_test(boards_do_not),
                                       cmocka_unit_test(no_inverse_in_silence), cmocka_unit_test(false_colours)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
