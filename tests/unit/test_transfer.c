// Pictures travel to the device and back through mapped buffers on hardware, and are copied at once elsewhere: no sample differs,
// whatever the size of the bands, the number of threads and the frames that are under way.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>
#include <json-c/json.h>
#include <math.h>

#include "gpu/transfer.h"
#include "must.h"
#include "pipeline/batch.h"
#include "pipeline/read_back.h"
#include "scene_picture.h"

enum { WIDTH = 150, HEIGHT = 70, FRAMES = 7, MISSING = 4 };

static char folder[] = "/tmp/ssdo-transfer-XXXXXX";

// How pictures travel. band: bytes at a time, 0 the usual.
typedef struct way {
    bool mapped;
    size_t band;
    int threads;
} way;

static const way plain = {false, 0, 1};

static void open_job(job *j, options *o, log_t *log, const way *w)
{
    error e = {0};
    o->threads = w->threads;
    log_init(log, LOG_QUIET);
    job_open(j, o, log);
    must(job_open_device(j, &e), &e);
    j->g.mapped = w->mapped;
    if (w->band) j->g.band_bytes = w->band;
}

// ---- one frame

typedef struct made {
    job j;
    log_t log;
    frame_result r;
} made;

static void make(made *m, options *o, const way *w)
{
    error e = {0};
    char in[96];
    snprintf(in, sizeof in, "%s/in.0001.exr", folder);
    open_job(&m->j, o, &m->log, w);
    must(frame_read(&m->j, in, &m->r, &e) && frame_filter(&m->j, &m->r, &e), &e);
    assert_false(frame_is_under_way(&m->r));
}

static void unmake(made *m)
{
    frame_free(&m->r);
    job_close(&m->j);
    log_free(&m->log);
}

static void assert_same(const frame_result *a, const frame_result *b)
{
    size_t pixels = (size_t)WIDTH * HEIGHT;
    assert_int_equal(a->clamped, b->clamped);
    for (int l = 0; l < LAYER_COUNT; l++) {
        size_t channels = strlen(layer_table[l]->channels);
        assert_int_equal(a->layers[l] != NULL, b->layers[l] != NULL);
        assert_int_equal(a->layers[l] != NULL, (a->plan.layers >> l) & 1u);
        if (!a->layers[l]) continue;
        assert_int_equal(a->types[l], b->types[l]);
        assert_memory_equal(a->layers[l], b->layers[l], channels * pixels * sizeof(float));
        for (size_t k = 0; k < channels; k++)
            assert_memory_equal(a->samples[l][k], b->samples[l][k], pixels * sample_size(a->types[l]));
    }
}

static void layers_are_the_same(void **state)
{
    static const struct {
        const char *method, *layers, *env;
        double env_scale; // large: halves overflow
        bool floats;
        estimate_resolution resolution;
    } cases[] = {
        {"arc", "occlusion,radiance,indirect,composite,visibility,bent,depthmask,diffuse", "samples/sky_soft.exr", 1e6, false,
         RESOLUTION_FULL},
        {"s3ho", "sh_0,sh_1,sh_2,sh_3,radiance", "samples/sky_soft.exr", 1.0, true, RESOLUTION_FULL},
        {"ssdo", NULL, NULL, 1.0, false, RESOLUTION_HALF},
        {"arc", "occlusion,radiance,indirect,visibility", "samples/sky_soft.exr", 1.0, false, RESOLUTION_LIGHT},
    };
    // A row of one float a pixel is 600 bytes: bands of one row, and of some that do not divide the height.
    static const way ways[] = {{true, 0, 2}, {true, 1, 3}, {true, 20000, 1}, {false, 0, 3}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static made usual, other;
        options o;
        options_defaults(&o);
        o.method = cases[i].method;
        o.layers = cases[i].layers;
        o.env = cases[i].env;
        o.env_scale = cases[i].env_scale;
        o.outside = 1.0;
        o.output_float = cases[i].floats;
        o.resolution = cases[i].resolution;
        o.sh_bands = 3;
        o.samples = 8;
        make(&usual, &o, &plain);
        assert_true((usual.r.clamped > 0) == (cases[i].env_scale > 1.0));
        for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
            make(&other, &o, &ways[k]);
            assert_same(&usual.r, &other.r);
            // As many bytes, in larger bands than those that pass through the cache.
            assert_int_equal(usual.r.gl.bytes_down, other.r.gl.bytes_down);
            assert_int_equal(usual.r.gl.bytes_up, other.r.gl.bytes_up);
            unmake(&other);
        }
        unmake(&usual);
    }
}

// ---- what no pass should make

// Values of a picture, and what is written of them in the layers of each range: bits of a half, and whether it counts as clamped.
static const struct {
    float v;
    uint16_t any, light, share;
    bool any_clamped, light_clamped;
} odd[] = {
    {0.5f, 0x3800, 0x3800, 0x3800, false, false},
    {NAN, 0, 0, 0x3c00, false, false},
    {INFINITY, 0x7bff, 0x7bff, 0x3c00, true, true},
    {-INFINITY, 0xfbff, 0, 0x3c00, true, false},
    {1e10f, 0x7bff, 0x7bff, 0x3c00, true, true},
    {-1e10f, 0xfbff, 0, 0, true, false},
    {65504.0f, 0x7bff, 0x7bff, 0x3c00, false, false},
    {65505.0f, 0x7bff, 0x7bff, 0x3c00, true, true},
    {-2.0f, 0xc000, 0, 0, false, false},
    {0x1.002p+0f, 0x3c00, 0x3c00, 0x3c00, false, false}, // half way: to the even one below
    {0x1.006p+0f, 0x3c02, 0x3c02, 0x3c00, false, false}, // and above
    {0x1p-25f, 0, 0, 0, false, false},
    {0x1.8p-25f, 1, 1, 1, false, false},
};

static void check_odd(const frame_result *r)
{
    size_t count = sizeof odd / sizeof *odd, clamped = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        const uint16_t expected[] = {odd[i % count].share, odd[i % count].light, odd[i % count].any};
        const layer_id layers[] = {LAYER_OCCLUSION, LAYER_RADIANCE, LAYER_COMPOSITE};
        for (int l = 0; l < 3; l++)
            for (int k = 0; k < (l ? 3 : 1); k++) assert_int_equal(((const uint16_t *)r->samples[layers[l]][k])[i], expected[l]);
        clamped += 3u * (odd[i % count].any_clamped + odd[i % count].light_clamped);
    }
    assert_int_equal(r->clamped, clamped);
}

static void odd_values_keep_their_range(void **state)
{
    static const way ways[] = {{true, 0, 2}, {true, 20000, 3}, {false, 0, 1}, {false, 0, 3}};
    static float v[WIDTH * HEIGHT * 4], one[WIDTH * HEIGHT];
    (void)state;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        one[i] = odd[i % (sizeof odd / sizeof *odd)].v;
        for (size_t k = 0; k < 4; k++) v[4 * i + k] = one[i];
    }
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        error e = {0};
        options o;
        log_t log;
        job j;
        frame_result r = {.gb = {.width = WIDTH, .height = HEIGHT}};
        options_defaults(&o);
        open_job(&j, &o, &log, &ways[i]);
        pass_context c = {.g = &j.g};
        gpu_image *const images[] = {&c.image[IMAGE_OCCLUSION], &c.image[IMAGE_RADIANCE], &c.image[IMAGE_COMPOSITE]};
        for (int k = 0; k < 3; k++) {
            must(gpu_image_make(&j.g, images[k], k ? GL_RGBA32F : GL_R32F, WIDTH, HEIGHT, 1, &e), &e);
            must(gpu_image_send(&j.g, images[k], k ? v : one, &e), &e);
        }
        r.plan.layers = 1u << LAYER_OCCLUSION | 1u << LAYER_RADIANCE | 1u << LAYER_COMPOSITE;
        must(read_back_begin(&j, &c, &r, &e) && read_back_finish(&j, &r, &e), &e);
        check_odd(&r);
        for (int k = 0; k < 3; k++) gpu_image_free(images[k]);
        frame_free(&r);
        job_close(&j);
        log_free(&log);
    }
}

// ---- pictures up and down

static void fill(float *v, size_t n)
{
    for (size_t i = 0; i < n; i++) v[i] = (float)(i * 2654435761u % 1000003u);
}

static void pictures_arrive_whole(void **state)
{
    enum { W = 61, H = 47, N = W * H * 4 };
    static const size_t bands[] = {1, W * 16 * 5, 1 << 20};
    static float up[N], down[N];
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        error e = {0};
        options o;
        log_t log;
        job j;
        gpu_image image;
        options_defaults(&o);
        open_job(&j, &o, &log, &(way){true, bands[i], 2});
        must(gpu_image_make(&j.g, &image, GL_RGBA32F, W, H, 1, &e), &e);
        for (int turn = 0; turn < 2; turn++) { // the second through the buffers of the first
            fill(up, N);
            up[turn] = -1.0f;
            must(gpu_image_send(&j.g, &image, up, &e), &e);
            int most = gpu_transfer_rows(&j.g, &image);
            for (int y = 0, rows; y < H; y += rows) {
                gpu_transfer t;
                rows = H - y < most ? H - y : most;
                must(gpu_transfer_start(&j.g, &image, y, rows, &t, &e) && gpu_transfer_wait(&j.g, &t, &e), &e);
                memcpy(down + (size_t)y * W * 4, t.pixels, (size_t)rows * W * 4 * sizeof *down);
                gpu_transfer_end(&t);
            }
            assert_memory_equal(up, down, sizeof up);
        }
        must(gpu_finish(&j.g, "the test", &e), &e);
        gpu_image_free(&image);
        job_close(&j);
        log_free(&log);
    }
}

// A buffer whose rows nobody has read yet is not given to others; one that was given back is.
static void buffers_are_kept_apart(void **state)
{
    error e = {0};
    options o;
    log_t log;
    job j;
    gpu_image image;
    gpu_transfer a, b, c;
    const float one[4] = {1, 1, 1, 1}, two[4] = {2, 2, 2, 2};
    (void)state;
    options_defaults(&o);
    open_job(&j, &o, &log, &(way){true, 0, 1});
    must(gpu_image_make(&j.g, &image, GL_R32F, 8, 8, 1, &e), &e);
    gpu_image_clear(&image, one);
    must(gpu_transfer_start(&j.g, &image, 0, 8, &a, &e), &e);
    gpu_image_clear(&image, two);
    must(gpu_transfer_start(&j.g, &image, 0, 8, &b, &e), &e);
    must(gpu_transfer_wait(&j.g, &a, &e) && gpu_transfer_wait(&j.g, &b, &e), &e);
    assert_true(a.buffer != b.buffer && a.pixels[63] == 1.0f && b.pixels[63] == 2.0f);
    const gpu_pixel_buffer *first = a.buffer;
    gpu_transfer_end(&a);
    must(gpu_transfer_start(&j.g, &image, 0, 4, &c, &e) && gpu_transfer_wait(&j.g, &c, &e), &e);
    assert_true(c.buffer == first && c.pixels[31] == 2.0f);
    gpu_transfer_end(&b);
    gpu_transfer_end(&c);
    gpu_image_free(&image);
    job_close(&j);
    log_free(&log);
}

// ---- a sequence

// Bytes of an output, NULL if there is none.
static char *bytes_of(const char *name, int frame, size_t *size)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s.%04d.exr", folder, name, frame);
    FILE *f = fopen(path, "rb");
    if (!f) return NULL;
    fseek(f, 0, SEEK_END);
    *size = (size_t)ftell(f);
    rewind(f);
    char *bytes = malloc(*size);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, f), *size);
    fclose(f);
    return bytes;
}

// The sequence, of which a frame is missing. Returns what batch_run returned.
static bool run_sequence(const char *name, const way *w, bool keep_going, error *e)
{
    char in[96], out[96], report[96], frames[16];
    snprintf(in, sizeof in, "%s/in.####.exr", folder);
    snprintf(out, sizeof out, "%s/%s.####.exr", folder, name);
    snprintf(report, sizeof report, "%s/%s.json", folder, name);
    snprintf(frames, sizeof frames, "1-%d", FRAMES);
    char *argv[] = {"ssdo-filter", "-q",   in,          "-o", out,        "--frames", frames,
                    "--method",    "ssdo", "--samples", "4",  "--report", report,     "--keep-going"};
    error bad = {0};
    options o;
    log_t log;
    job j;
    options_defaults(&o);
    must(options_parse((int)(sizeof argv / sizeof *argv) - !keep_going, argv, &o, &bad), &bad);
    open_job(&j, &o, &log, w);
    bool ok = batch_run(&j, e);
    job_close(&j);
    log_free(&log);
    return ok;
}

static double share(const json_object *busy, const char *name)
{
    json_object *v = NULL;
    if (!json_object_object_get_ex(busy, name, &v)) fail_msg("the report does not say how busy '%s' was", name);
    return json_object_get_double(v);
}

// Every thread did something, and none more than there was time for.
static void check_busy(const char *name)
{
    static const char *const threads[] = {"read", "gpu", "write"};
    char path[96];
    json_object *busy = NULL;
    snprintf(path, sizeof path, "%s/%s.json", folder, name);
    json_object *report = json_object_from_file(path);
    assert_non_null(report);
    assert_true(json_object_object_get_ex(report, "busy", &busy));
    for (int i = 0; i < 3; i++) assert_true(share(busy, threads[i]) > 0.0 && share(busy, threads[i]) <= 1.0);
    assert_true(share(busy, "cores") > 0.0 && share(busy, "wall_ms") > 0.0);
    json_object_put(report);
}

// Frames overlap, one fails between them, and the others are what they are one by one.
static void sequences_are_the_same(void **state)
{
    (void)state;
    for (int keep_going = 0; keep_going < 2; keep_going++) {
        error a = {0}, b = {0};
        assert_false(run_sequence("direct", &(way){false, 0, 2}, keep_going, &a));
        assert_false(run_sequence("mapped", &(way){true, 0, 2}, keep_going, &b));
        assert_true(a.code == ERR_FRAMES && b.code == ERR_FRAMES);
        assert_string_equal(a.message, b.message);
        check_busy("direct");
        check_busy("mapped");
    }
    for (int frame = 1; frame <= FRAMES; frame++) {
        size_t size = 0, other = 0;
        char *direct = bytes_of("direct", frame, &size), *mapped = bytes_of("mapped", frame, &other);
        assert_int_equal(direct != NULL, frame != MISSING);
        assert_int_equal(mapped != NULL, frame != MISSING);
        assert_int_equal(size, other);
        if (direct) assert_memory_equal(direct, mapped, size);
        free(direct);
        free(mapped);
    }
}

static int set_up(void **state)
{
    static scene s;
    error e = {0};
    (void)state;
    if (!mkdtemp(folder)) return -1;
    scene_clutter(&s);
    for (int i = 1; i <= FRAMES; i++) {
        char path[96];
        view v = view_perspective(WIDTH, HEIGHT, 50.0 - i, 1.0);
        view_scene(&v, &s);
        snprintf(path, sizeof path, "%s/in.%04d.exr", folder, i);
        if (i != MISSING) must(scene_write(&s, &v, &(scene_exr_options){.convention = "plain"}, path, &e), &e);
    }
    return 0;
}

static int tear_down(void **state)
{
    char command[64];
    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_are_the_same),    cmocka_unit_test(odd_values_keep_their_range),
        cmocka_unit_test(pictures_arrive_whole),  cmocka_unit_test(buffers_are_kept_apart),
        cmocka_unit_test(sequences_are_the_same),
    };
    return cmocka_run_group_tests_name("transfer", tests, set_up, tear_down);
}
