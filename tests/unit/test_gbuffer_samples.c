// The camera of every rendered sample against the one Blender rendered it with (samples/scenes.json), and what else is known of
// the frames. Run from the top of the tree.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <json-c/json.h>

#include "gbuffer/gbuffer.h"

static double number(struct json_object *o, const char *key, int index)
{
    struct json_object *v;
    assert_true(json_object_object_get_ex(o, key, &v));
    if (index >= 0) v = json_object_array_get_idx(v, (size_t)index);
    return json_object_get_double(v);
}

static const char *string(struct json_object *o, const char *key)
{
    struct json_object *v;
    assert_true(json_object_object_get_ex(o, key, &v));
    return json_object_get_string(v);
}

static void check_camera(const gbuffer *g, struct json_object *truth, double scene_size)
{
    const camera *c = &g->camera;
    bool perspective = strcmp(string(truth, "type"), "perspective") == 0;
    assert_int_equal(c->kind, perspective ? CAMERA_PERSPECTIVE : CAMERA_ORTHOGRAPHIC);
    assert_int_equal(c->source, CAMERA_FROM_FIT);
    double fx = perspective ? number(truth, "focal_px", 0) : number(truth, "pixels_per_unit", -1);
    vec3 location = v3(number(truth, "location", 0), number(truth, "location", 1), number(truth, "location", 2));
    vec3 eye = camera_from_world(c, location);
    print_message("focal %.3g %%, %.3g %%; centre %.3g, %.3g px; eye %.3g of the scene's size\n", 100 * (c->fx / fx - 1),
                  100 * (c->fy / fx - 1), c->cx - number(truth, "principal_px", 0), c->cy - number(truth, "principal_px", 1),
                  v3_length(eye) / scene_size);
    assert_true(fabs(c->fx / fx - 1) < 1e-4 && fabs(c->fy / fx - 1) < 1e-4);
    if (perspective) {
        assert_true(v3_length(eye) < 1e-4 * scene_size);
        assert_true(fabs(c->cx - number(truth, "principal_px", 0)) < 0.1);
        assert_true(fabs(c->cy - number(truth, "principal_px", 1)) < 0.1);
    }
    // An orthographic eye may lie anywhere along and across the rays, but where it was must project to the centre.
    double x, y;
    if (!perspective) {
        assert_true(camera_project(c, eye, &x, &y));
        assert_true(fabs(x - number(truth, "principal_px", 0)) < 0.01 && fabs(y - number(truth, "principal_px", 1)) < 0.01);
    }
    // Camera axes: Blender's are x right, y up, z backwards.
    struct json_object *rows;
    assert_true(json_object_object_get_ex(truth, "matrix_world", &rows));
    for (size_t r = 0; r < 3; r++)
        for (size_t k = 0; k < 3; k++) {
            struct json_object *row = json_object_array_get_idx(rows, r);
            double v = json_object_get_double(json_object_array_get_idx(row, k)) * (k == 0 ? 1 : -1);
            assert_true(fabs(c->world_from_camera.m[r][k] - v) < 2e-4);
        }
}

static void check_sample(struct json_object *entry)
{
    char path[256];
    snprintf(path, sizeof path, "samples/%s", string(entry, "file"));
    exrio_file *file;
    error e = {0};
    resolution r;
    gbuffer g;
    if (!exrio_file_open(path, &file, &e)) fail_msg("%s: %s", path, e.message);
    if (!resolve_channels(file, &(resolve_options){0}, &r, NULL, &e)) fail_msg("%s: %s", path, e.message);
    for (int i = 0; i < ROLE_COUNT; i++)
        for (int c = 0; c < r.components[i]; c++)
            file->parts[r.channels[i][c].part].channels[r.channels[i][c].channel].wanted = true;
    if (!exrio_file_load(file, 2, &e)) fail_msg("%s: %s", path, e.message);
    gbuffer_options options = {.need = NEED_ALBEDO | NEED_BEAUTY | NEED_COVERAGE | NEED_DIFFUSE_LIGHT, .threads = 2};
    if (!gbuffer_build(file, &r, &options, &g, NULL, &e)) fail_msg("%s: %s", path, e.message);
    print_message("%s: residual %.3g px, %zu valid, %zu moved, radius %.3g (truth's distance %.3g)\n", path, g.camera.residual,
                  g.valid, g.off_ray, gbuffer_auto_radius(&g), number(entry, "ao_distance", -1));
    struct json_object *truth;
    assert_true(json_object_object_get_ex(entry, "camera", &truth));
    check_camera(&g, truth, number(entry, "scene_size", -1));
    assert_string_equal(r.convention, "blender");
    assert_int_equal(g.depth_kind, DEPTH_PLANAR);
    assert_false(g.normals_from_depth || g.position_is_camera_space);
    if (gbuffer_doubt(&g)) fail_msg("%s: its %s is doubted", path, gbuffer_doubt(&g));
    assert_true(g.camera.has_world && g.camera.inliers > 0.99);
    assert_non_null(g.albedo);
    assert_non_null(g.coverage);
    gbuffer_free(&g);
    exrio_file_close(file);
}

static void test_samples(void **state)
{
    (void)state;
    struct json_object *scenes = json_object_from_file("samples/scenes.json");
    assert_non_null(scenes);
    size_t count = json_object_array_length(scenes);
    assert_true(count > 0);
    for (size_t i = 0; i < count; i++) check_sample(json_object_array_get_idx(scenes, i));
    json_object_put(scenes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_samples)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
