// --method raytrace: closed forms, the mesh's axes, both back ends, and Blender's truth.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "light/alias_table.h"
#include "modules.h"
#include "must.h"
#include "near.h"
#include "pipeline/frame.h"
#include "rig.h"
#include "sample.h"
#include "scene_picture.h"
#include "truth.h"

enum { WIDTH = 96, HEIGHT = 64, ALL = 1 << LAYER_OCCLUSION | 1 << LAYER_RADIANCE | 1 << LAYER_INDIRECT };
static const int backends[] = {TRACE_EMBREE, TRACE_GPU};

static const char *mesh_path(void)
{
    static char path[64];
    snprintf(path, sizeof path, "/tmp/ssdo_raytrace_%d.obj", (int)getpid());
    return path;
}

// scene_corner as a mesh of two quads, a huge one each, with albedo 0.5. `turned`: written with y up.
static void write_corner(bool turned)
{
    static const double corner[6][3] = {{-1e3, -1e3, 0}, {1e3, -1e3, 0}, {1e3, 0, 0},
                                        {-1e3, 0, 0},    {1e3, 0, 1e3},  {-1e3, 0, 1e3}};
    FILE *f = fopen(mesh_path(), "w");
    assert_non_null(f);
    for (int i = 0; i < 6; i++) {
        const double *p = corner[i];
        fprintf(f, "v %g %g %g .5 .5 .5\n", p[0], turned ? p[2] : p[1], turned ? -p[1] : p[2]);
    }
    fputs("f 1 2 3 4\nf 4 3 5 6\n", f);
    fclose(f);
}

typedef struct corner {
    scene s;
    view v;
    rig r;
    gbuffer gb;
} corner;

// Light is a white sky, if any.
static void corner_open(corner *c, bool light, bool turned, bool orthographic)
{
    error e = {0};
    *c = (corner){0};
    must(rig_open(&c->r, light ? &(env_options){.up_z = true, .scale = 1.0} : NULL, &e), &e);
    write_corner(turned);
    scene_corner(&c->s, 0.4);
    c->v = orthographic ? view_orthographic(WIDTH, HEIGHT, 2.0, 1.0) : view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&c->v, &c->s);
    must(scene_gbuffer(&c->s, &c->v, &c->gb, &e), &e);
}

static void corner_close(corner *c)
{
    gbuffer_free(&c->gb);
    rig_close(&c->r);
    remove(mesh_path());
}

static pass_settings settings(double radius, int samples, int backend)
{
    pass_settings set = rig_settings(method_find("raytrace"), radius);
    set.mesh = mesh_path();
    set.mesh_axes = -1;
    set.trace = backend;
    set.samples = samples;
    return set;
}

// A wall without end fills half of the hemisphere of every point of the floor, and the other way round; both reflect half of half
// the white sky, of which half the hemisphere sees that: radiance 1/2, indirect 1/8. Within the radius: truth_corner.
static void corner_is_the_closed_form(void **state)
{
    (void)state;
    for (int run = 0; run < 8; run++) {
        static corner c;
        frame_result out;
        error e = {0};
        corner_open(&c, true, run & 1, run & 2);
        pass_settings set = settings(c.s.radius, 256, backends[run / 4]);
        must(rig_run(&c.r, &c.gb, method_find("raytrace"), &set, ALL, &out, &e), &e);
        double worst = 0.0, distance = 0.0, off = 0.0, light = 0.0, bounce = 0.0, n = 0.0;
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            hit h;
            if (!scene_at_pixel(&c.s, &c.v, i % WIDTH, i / WIDTH, &h)) continue;
            double x = h.position.z > 1e-6 ? h.position.z : -h.position.y,
                   wanted = x < c.s.radius ? truth_corner(x, c.s.radius) : 1.0;
            double difference = (double)out.layers[LAYER_OCCLUSION][i] - wanted;
            off += difference, n += 1.0;
            distance += x;
            worst = fmax(worst, fabs(difference));
            light += (double)out.layers[LAYER_RADIANCE][3 * i + 1];
            bounce += (double)out.layers[LAYER_INDIRECT][3 * i + 2];
            if (x > 1.01 * c.s.radius && out.layers[LAYER_OCCLUSION][i] != 1.0f) fail_msg("pixel %d is not open", i);
        }
        print_message("back end %d: occlusion off by %+.5f (worst %.3f), radiance %.5f, indirect %.5f\n", backends[run / 4],
                      off / n, worst, light / n, bounce / n);
        assert_near(off / n, 0.0, 2e-4);
        assert_true(worst < 0.06); // 256 samples
        // The wall ends 1000 units to either side, so a share of x / (1000 pi) passes it; of the light it sends, more.
        assert_near(light / n, 0.5 + distance / n / (1000.0 * M_PI), 5e-4);
        assert_near(bounce / n, 0.125, 2e-3);
        rig_free_result(&out);
        corner_close(&c);
    }
}

// Told that the axes are the picture's, a mesh with other axes is refused, and so is a mesh of something else.
static void foreign_mesh_is_refused(void **state)
{
    (void)state;
    static corner c;
    error e = {0};
    frame_result out;
    corner_open(&c, false, true, false);
    c.gb.camera.origin = v3_add(c.gb.camera.origin, v3(0, 0.3, 0.3)); // neither of its surfaces fits now
    pass_settings set = settings(c.s.radius, 1, TRACE_EMBREE);
    set.mesh_axes = 0;
    assert_false(rig_run(&c.r, &c.gb, method_find("raytrace"), &set, 1 << LAYER_OCCLUSION, &out, &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_string_equal(e.file, mesh_path());
    assert_non_null(strstr(e.message, "--mesh-axes"));
    rig_free_result(&out);
    c.gb.camera.has_world = false;
    e = (error){0};
    assert_false(rig_run(&c.r, &c.gb, method_find("raytrace"), &set, 1 << LAYER_OCCLUSION, &out, &e));
    assert_non_null(strstr(e.message, "--camera"));
    rig_free_result(&out);
    corner_close(&c);
}

// Without the module, auto takes the grid, and embree is an error that names it.
static void missing_module_is_named(void **state)
{
    (void)state;
    static corner c;
    error e = {0};
    frame_result out;
    if (access(SSDO_LIBDIR "/ssdo-trace.so", R_OK) == 0) return; // an installed one would be found
    char *folder = strdup(getenv("SSDO_PLUGIN_DIR"));
    setenv("SSDO_PLUGIN_DIR", "/nowhere", 1);
    corner_open(&c, false, false, false);
    pass_settings set = settings(c.s.radius, 1, TRACE_EMBREE);
    assert_false(rig_run(&c.r, &c.gb, method_find("raytrace"), &set, 1 << LAYER_OCCLUSION, &out, &e));
    assert_int_equal(e.code, ERR_USAGE);
    assert_non_null(strstr(e.message, "ssdo-trace.so"));
    rig_free_result(&out);
    e = (error){0};
    set.trace = TRACE_AUTO;
    must(rig_run(&c.r, &c.gb, method_find("raytrace"), &set, 1 << LAYER_OCCLUSION, &out, &e), &e);
    assert_null(c.r.job.trace.cpu);
    rig_free_result(&out);
    corner_close(&c);
    setenv("SSDO_PLUGIN_DIR", folder, 1);
    free(folder);
}

// What a mesh contradicts is no reason for NaN: a picture of something else entirely, huge and with normals of all kinds.
static void nothing_becomes_nan(void **state)
{
    (void)state;
    for (int b = 0; b < 2; b++) {
        static corner c;
        frame_result out;
        error e = {0};
        corner_open(&c, true, false, false);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            if (i % 7 == 0) c.gb.depth[i] = 1e10f;
            if (i % 5 == 0) memset(c.gb.normal + 4 * i, 0, 3 * sizeof *c.gb.normal);
        }
        pass_settings set = settings(c.s.radius, 4, backends[b]);
        must(rig_run(&c.r, &c.gb, method_find("raytrace"), &set, ALL, &out, &e), &e);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            float o = out.layers[LAYER_OCCLUSION][i];
            assert_true(o >= 0.0f && o <= 1.0f);
            for (int k = 0; k < 3; k++)
                assert_true(isfinite(out.layers[LAYER_RADIANCE][3 * i + k]) && isfinite(out.layers[LAYER_INDIRECT][3 * i + k]) &&
                            out.layers[LAYER_RADIANCE][3 * i + k] <= 1.00001f);
        }
        rig_free_result(&out);
        corner_close(&c);
    }
}

// The chances of the table's entries, summed over what they give to each texel, are density times solid angle; and the sun gets
// what it sends.
static void alias_table_follows_the_light(void **state)
{
    (void)state;
    enum { W = 64, H = 32 };
    static float rgb[3 * W * H];
    environment env;
    env_alias_table c;
    log_t log;
    error e = {0};
    log_init(&log, LOG_QUIET);
    for (int i = 0; i < 3 * W * H; i++) rgb[i] = (float)(i % 11) * 0.1f;
    for (int k = 0; k < 3; k++) rgb[3 * (9 * W + 20) + k] = 5000.0f;
    for (int black = 0; black < 2; black++) {
        if (black) memset(rgb, 0, sizeof rgb);
        must(environment_prepare(rgb, W, H, &(env_options){.path = "test", .up_z = true, .scale = 1.0, .threads = 1}, &env, &log,
                                 &e),
             &e);
        must(env_alias_table_make(&env, &c, &e), &e);
        static double chance[W * H];
        memset(chance, 0, sizeof chance);
        for (int i = 0; i < W * H; i++) {
            assert_true(c.table[i].keep >= 0.0f && c.table[i].keep <= 1.0f && c.table[i].other < W * H);
            chance[i] += (double)c.table[i].keep / (W * H);
            chance[c.table[i].other] += (1.0 - (double)c.table[i].keep) / (W * H);
        }
        double sum = 0.0;
        for (int i = 0; i < W * H; i++) {
            double wanted = (double)c.table[i].density * env_texel_solid_angle(W, H, i / W);
            assert_near(chance[i], wanted, 1e-6);
            sum += wanted;
        }
        assert_near(sum, 1.0, 1e-5);
        if (!black) assert_true(chance[9 * W + 20] > 0.45); // 9/16 of its light, the rest is found beside it
        env_alias_table_free(&c);
        environment_free(&env);
    }
    log_free(&log);
}

// ---- Blender's truth

typedef struct traced {
    sample s;
    options o;
    log_t log;
    job j;
    frame_result r;
} traced;

static void open_box(traced *t)
{
    sample list[SAMPLE_MAX];
    error e = {0};
    *t = (traced){0};
    int n = samples_list("samples", list, SAMPLE_MAX, &e);
    for (int i = 0; i < n; i++)
        if (strcmp(list[i].name, "box") == 0) t->s = list[i];
    must(sample_load(&t->s, &e), &e);
    options_defaults(&t->o);
    t->o.method = "raytrace";
    t->o.mesh = "samples/box.obj";
    t->o.env = t->s.env;
    t->o.env_rotate = t->s.env_rotate;
    t->o.radius_unit = RADIUS_WORLD;
    t->o.radius = t->s.ao_distance;
    t->o.layers = "occlusion,radiance,indirect,visibility";
    t->o.samples = 1; // replaced below
    log_init(&t->log, LOG_QUIET);
    job_open(&t->j, &t->o, &t->log);
    must(frame_read(&t->j, t->s.file, &t->r, &e), &e);
    must(frame_filter(&t->j, &t->r, &e), &e); // loads the environment and resolves the settings
}

static void trace_again(traced *t, int backend, int samples, int seed, float *out[LAYER_COUNT])
{
    error e = {0};
    for (int l = 0; l < LAYER_COUNT; l++) free(t->r.layers[l]), t->r.layers[l] = NULL;
    if (t->r.set.trace != backend) trace_scene_close(&t->j.trace);
    t->r.set.trace = backend;
    t->r.set.samples = samples;
    t->r.set.seed = seed;
    must(filter_frame(&t->j, &t->r, &e), &e);
    for (int l = 0; l < LAYER_COUNT; l++) out[l] = t->r.layers[l], t->r.layers[l] = NULL;
}

static void free_layers(float *layers[LAYER_COUNT])
{
    for (int l = 0; l < LAYER_COUNT; l++) free(layers[l]);
}

static void close_box(traced *t)
{
    frame_free(&t->r);
    job_close(&t->j);
    log_free(&t->log);
    sample_free(&t->s);
}

// Blender's pixels are means over a filter 1.5 pixels wide, ours the value at the centre: the same where light does not bend
// within the filter, that is where all pixels around lie on one plane, and no edge of another surface is close by.
static bool is_flat(const traced *t, int x, int y)
{
    enum { REACH = 3 };
    const gbuffer *gb = &t->r.gb;
    if (x < REACH || y < REACH || x >= gb->width - REACH || y >= gb->height - REACH) return false;
    const float *n = gb->normal + 4 * ((size_t)y * (size_t)gb->width + (size_t)x);
    vec3 p = gbuffer_position(gb, x, y), normal = v3((double)n[0], (double)n[1], (double)n[2]);
    for (int dy = -REACH; dy <= REACH; dy++)
        for (int dx = -REACH; dx <= REACH; dx++) {
            if (!sample_is_surface(&t->s, (y + dy) * gb->width + x + dx)) return false;
            vec3 d = v3_sub(gbuffer_position(gb, x + dx, y + dy), p);
            if (fabs(v3_dot(d, normal)) > 1e-4 * p.z) return false;
        }
    return true;
}

typedef struct agreement {
    double rms, noise, mean, bias; // error without anyone's noise; noise of one trace; mean of the truth; mean error
} agreement;

// With two independent traces x, y and two independent renders a, b, mean((x - a)(y - b)) is the mean square of what is
// systematically different, whatever the noise of the four.
static agreement compare(const traced *t, const float *x, const float *y, const float *a, const float *b, int channels)
{
    double square = 0, noise = 0, mean = 0, bias = 0, n = 0;
    for (int i = 0; i < t->r.gb.width * t->r.gb.height; i++) {
        if (!is_flat(t, i % t->r.gb.width, i / t->r.gb.width)) continue;
        for (int k = 0; k < channels; k++) {
            int j = i * channels + k;
            double p = (double)x[j], q = (double)y[j], u = (double)a[j], w = (double)b[j];
            square += (p - u) * (q - w), noise += 0.5 * (p - q) * (p - q), mean += 0.5 * (u + w), n += 1;
            bias += 0.5 * (p + q - u - w);
        }
    }
    assert_true(n > 20000);
    return (agreement){sqrt(fmax(0.0, square / n)), sqrt(noise / n), mean / n, bias / n};
}

// 64 samples twice: a systematic error of 1 % of the mean would be seen, five times less than the noise of one trace.
static void box_is_blenders(void **state)
{
    (void)state;
    static traced t;
    float *one[LAYER_COUNT], *two[LAYER_COUNT];
    open_box(&t);
    trace_again(&t, TRACE_EMBREE, 64, 0, one);
    trace_again(&t, TRACE_EMBREE, 64, 1, two);
    const struct {
        const char *name;
        layer_id layer;
        float **truth;
        int channels;
    } list[] = {{"occlusion", LAYER_OCCLUSION, t.s.ao, 1},
                {"radiance", LAYER_RADIANCE, t.s.direct, 3},
                {"indirect", LAYER_INDIRECT, t.s.indirect, 3}};
    for (int i = 0; i < 3; i++) {
        agreement a = compare(&t, one[list[i].layer], two[list[i].layer], list[i].truth[0], list[i].truth[1], list[i].channels);
        printf("figure: box raytrace %s: off by %.5f rms, %+.5f in the mean, of %.4f; noise of 64 samples %.4f\n", list[i].name,
               a.rms, a.bias, a.mean, a.noise);
        fflush(stdout);
        assert_true(a.rms < 0.01 * a.mean);
        assert_true(fabs(a.bias) < 0.002 * a.mean);
    }
    free_layers(one);
    free_layers(two);
    close_box(&t);
}

// Both back ends get the same rays, so they differ where a ray grazes an edge, by that ray.
static void back_ends_agree(void **state)
{
    (void)state;
    static traced t;
    float *embree[LAYER_COUNT], *cells[LAYER_COUNT];
    open_box(&t);
    trace_again(&t, TRACE_EMBREE, 2, 0, embree);
    trace_again(&t, TRACE_GPU, 2, 0, cells);
    int pixels = t.r.gb.width * t.r.gb.height;
    for (int l = 0; l < LAYER_COUNT; l++) {
        int differ = 0;
        for (int i = 0; embree[l] && i < pixels; i++) {
            int channels = (int)strlen(layer_table[l]->channels);
            bool same = true;
            for (int k = 0; k < channels; k++)
                same &= fabsf(embree[l][i * channels + k] - cells[l][i * channels + k]) <=
                        1e-5f * fmaxf(1.0f, embree[l][i * channels + k]);
            differ += !same;
        }
        if (embree[l]) print_message("%s: %d of %d pixels differ\n", layer_table[l]->name, differ, pixels);
        assert_true(differ <= pixels / 10000);
        assert_int_equal(embree[l] != NULL, cells[l] != NULL);
    }
    assert_non_null(embree[LAYER_INDIRECT]);
    free_layers(embree);
    free_layers(cells);
    close_box(&t);
}

int main(void)
{
    use_built_modules();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corner_is_the_closed_form),
        cmocka_unit_test(foreign_mesh_is_refused),
        cmocka_unit_test(missing_module_is_named),
        cmocka_unit_test(nothing_becomes_nan),
        cmocka_unit_test(alias_table_follows_the_light),
        cmocka_unit_test(back_ends_agree),
        cmocka_unit_test(box_is_blenders),
    };
    return cmocka_run_group_tests_name("raytrace", tests, NULL, NULL);
}
