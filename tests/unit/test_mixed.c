// Pixels whose normal is a mean over two surfaces (gbuffer.mixed): a sphere before the ground, with the mean of 64 normals a
// pixel beside the depth of one sample.
#include "gbuffer_scene.h"

static gbuffer build(bool averaged)
{
    scene s = base_scene(CAMERA_PERSPECTIVE);
    s.averaged_edges = averaged;
    render(&s);
    return built_with(NULL, (gbuffer_options){.need = NEED_COVERAGE});
}

static vec3 made(const gbuffer *g, size_t i)
{
    return v3((double)g->normal[4 * i], (double)g->normal[4 * i + 1], (double)g->normal[4 * i + 2]);
}

static vec3 stored(const scene *s, size_t i)
{
    vec3 n = v3((double)pixels[NX][i], (double)pixels[NY][i], (double)pixels[NZ][i]);
    return m3_apply(m3_transpose(s->camera.world_from_camera), n);
}

// The share of a pixel's 64 samples whose surface turns away from the normal by more than the other normal does.
static double share_beside(const scene *s, int x, int y, vec3 own, vec3 beside)
{
    int count = 0;
    for (int j = 0; j < 64; j++) {
        vec3 p, n;
        if (cast(s, x + (j % 8 + 0.5) / 8, y + (j / 8 + 0.5) / 8, &p, &n)) count += v3_dot(n, beside) > v3_dot(n, own);
    }
    return count / 64.0;
}

static size_t neighbour_of(const mixed_pixel *m)
{
    int x = (int)(m->pixel & 0xffff) + m->x, y = (int)(m->pixel >> 16) + m->y;
    return (size_t)y * W + (size_t)x;
}

static bool inside_frame(int x, int y)
{
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            if (!(true_depth[(y + j) * W + x + i] > 0)) return false;
    return true;
}

// Where the sphere's outline crosses the ground, each pixel has the normal of its own surface, and its neighbour's share is the
// one that was sampled.
static void test_shares(void **state)
{
    (void)state;
    const scene s = base_scene(CAMERA_PERSPECTIVE);
    gbuffer g = build(true);
    double of_stored = 0, of_made = 0, of_share = 0, unmixed = 0;
    size_t count = 0;
    for (size_t k = 0; k < g.mixed_count; k++) {
        const mixed_pixel *m = &g.mixed[k];
        const int x = (int)(m->pixel & 0xffff), y = (int)(m->pixel >> 16);
        const size_t i = (size_t)y * W + (size_t)x, beside = neighbour_of(m);
        assert_true((m->x || m->y) && abs(m->x) <= 1 && abs(m->y) <= 1 && m->share > 0 && m->share <= 1);
        assert_true(k == 0 || g.mixed[k - 1].pixel >> 16 < m->pixel >> 16 || g.mixed[k - 1].pixel < m->pixel);
        assert_true(g.depth[i] > 0 && g.depth[beside] > 0);
        if (x == 0 || y == 0 || x == W - 1 || y == H - 1 || !inside_frame(x, y)) continue;
        const double share = share_beside(&s, x, y, made(&g, i), made(&g, beside));
        of_stored += v3_length(v3_sub(v3_normalize(stored(&s, i)), true_normal[i]));
        of_made += v3_length(v3_sub(made(&g, i), true_normal[i]));
        of_share += fabs((double)m->share - share), unmixed += share;
        count++;
    }
    print_message("%zu mixed pixels: normals off by %.3f instead of %.3f, shares by %.3f of %.3f\n", count,
                  of_made / (double)count, of_stored / (double)count, of_share / (double)count, unmixed / (double)count);
    assert_true(count > 50);
    assert_true(of_made < 0.5 * of_stored);
    assert_true(of_share < 0.25 * unmixed);
    gbuffer_free(&g);
}

// Normals of one sample are left alone, and so are means that no alpha tells the background's share of.
static void test_one_sample(void **state)
{
    (void)state;
    gbuffer g = build(false);
    assert_true(g.mixed_count == 0);
    assert_exact(&g, 1e-5);
    gbuffer_free(&g);
    g = build(true);
    for (size_t k = 0; k < g.mixed_count; k++) {
        const int x = (int)(g.mixed[k].pixel & 0xffff), y = (int)(g.mixed[k].pixel >> 16);
        if (x > 0 && y > 0 && x < W - 1 && y < H - 1) assert_true(inside_frame(x, y));
    }
    gbuffer_free(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_shares), cmocka_unit_test(test_one_sample)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
