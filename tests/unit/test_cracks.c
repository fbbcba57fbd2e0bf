// Single pixels whose ray went through a crack of a mesh.
#include "gbuffer_scene.h"

static vec3 normal_of(int i) { return true_normal[i]; }

// On the ground, away from edges.
static bool flat(int x, int y)
{
    for (int v = y - 2; v <= y + 2; v++)
        for (int u = x - 2; u <= x + 2; u++) {
            if (u < 0 || v < 0 || u >= W || v >= H || !(true_depth[v * W + u] > 0)) return false;
            if (v3_dot(normal_of(v * W + u), normal_of(y * W + x)) < 0.9999) return false;
        }
    return true;
}

// Moves what the pixel shows away from the eye, with a normal of something else.
static void crack(const scene *s, int i)
{
    const vec3 along = m3_apply(s->camera.world_from_camera, v3(0, 0, 1)),
               p = v3((double)pixels[PX][i], (double)pixels[PY][i], (double)pixels[PZ][i]);
    const vec3 from = v3_sub(p, s->camera.origin);
    const vec3 far = s->camera.kind == CAMERA_ORTHOGRAPHIC ? v3_add(p, v3_scale(along, 0.8 * v3_dot(from, along)))
                                                           : v3_add(s->camera.origin, v3_scale(from, 1.8));
    pixels[PX][i] = (float)far.x, pixels[PY][i] = (float)far.y, pixels[PZ][i] = (float)far.z;
    pixels[Z][i] *= 1.8f;
    pixels[NX][i] = 1.0f, pixels[NY][i] = pixels[NZ][i] = 0.0f;
}

static int crack_every(const scene *s, int step)
{
    int count = 0;
    for (int y = step; y < H - 2; y += step)
        for (int x = step; x < W - 2; x += step)
            if (flat(x, y)) crack(s, y * W + x), count++;
    return count;
}

static bool says(const gbuffer *g, const char *what)
{
    for (int i = 0; i < g->evidence_count; i++)
        if (strstr(g->evidence[i], what)) return true;
    return false;
}

static void cracks_are_mended(void **state)
{
    (void)state;
    static const int kind[] = {CAMERA_PERSPECTIVE, CAMERA_ORTHOGRAPHIC};
    for (int k = 0; k < 2; k++) {
        const scene s = base_scene(kind[k]);
        render(&s);
        int at = -1;
        for (int i = N - 1; i >= 0 && at < 0; i -= 7) at = flat(i % W, i / W) ? i : -1;
        assert_true(at >= 0);
        crack(&s, at);
        gbuffer g = built_with(NULL, (gbuffer_options){.need = 0});
        const double step = (double)g.depth[at] - (double)g.depth[at - 1], true_step = true_depth[at] - true_depth[at - 1];
        assert_true(fabs(step - true_step) < 1e-3 * true_depth[at]);
        const vec3 n = v3((double)g.normal[4 * at], (double)g.normal[4 * at + 1], (double)g.normal[4 * at + 2]);
        assert_true(v3_dot(n, normal_of(at)) > 0.999);
        assert_true(says(&g, "put on it: 1"));
        gbuffer_free(&g);
    }
}

// What repeats is a thing with holes.
static void a_grille_is_kept(void **state)
{
    (void)state;
    const scene s = base_scene(CAMERA_PERSPECTIVE);
    render(&s);
    int count = crack_every(&s, 5);
    assert_true(count > N / 500);
    gbuffer g = built_with(NULL, (gbuffer_options){.need = 0});
    int far = 0;
    for (int i = 0; i < N; i++) far += true_depth[i] > 0 && (double)g.depth[i] > 1.5 * true_depth[i];
    assert_int_equal(far, count);
    gbuffer_free(&g);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cracks_are_mended),
        cmocka_unit_test(a_grille_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
