// What comes out: every input channel as it was, our layers beside it, the beauty variants of the composite, replaced names.
//
// The input and the output are read here with OpenEXRCore's own decode pipeline, not with our reader.
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
#include <openexr.h>

#include "exr/write.h"
#include "must.h"
#include "pipeline/frame.h"
#include "scene_picture.h"

static char folder[] = "/tmp/ssdo-output-XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    char command[64];
    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

static const char *path_of(const char *name)
{
    static char paths[4][96];
    static int next;
    char *p = paths[next++ % 4];
    snprintf(p, sizeof paths[0], "%s/%s", folder, name);
    return p;
}

// One channel's samples, packed, in the file's own type. The caller frees.
typedef struct raw {
    char name[256];
    int type;
    size_t size;
    unsigned char *bytes;
} raw;

static void read_chunk(exr_context_t f, int part, int y, int y0, int width, raw *list, int count)
{
    exr_chunk_info_t info;
    exr_decode_pipeline_t p = EXR_DECODE_PIPELINE_INITIALIZER;
    assert_int_equal(exr_read_scanline_chunk_info(f, part, y, &info), EXR_ERR_SUCCESS);
    assert_int_equal(exr_decoding_initialize(f, part, &info, &p), EXR_ERR_SUCCESS);
    assert_int_equal(p.channel_count, count);
    for (int c = 0; c < count; c++) {
        size_t each = (size_t)p.channels[c].bytes_per_element;
        list[c].type = (int)p.channels[c].data_type;
        p.channels[c].decode_to_ptr = list[c].bytes + (size_t)(y - y0) * (size_t)width * each;
        p.channels[c].user_pixel_stride = (int32_t)each;
        p.channels[c].user_line_stride = (int32_t)each * width;
        p.channels[c].user_bytes_per_element = (int16_t)each;
        p.channels[c].user_data_type = p.channels[c].data_type;
    }
    assert_int_equal(exr_decoding_choose_default_routines(f, part, &p), EXR_ERR_SUCCESS);
    assert_int_equal(exr_decoding_run(f, part, &p), EXR_ERR_SUCCESS);
    exr_decoding_destroy(f, &p);
}

// All channels of part 0 of a scanline file.
static int read_raw(const char *path, raw *list, int max)
{
    exr_context_t f;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_attr_box2i_t window;
    const exr_attr_chlist_t *channels;
    int32_t lines;
    assert_int_equal(exr_start_read(&f, path, &init), EXR_ERR_SUCCESS);
    assert_int_equal(exr_get_data_window(f, 0, &window), EXR_ERR_SUCCESS);
    assert_int_equal(exr_get_channels(f, 0, &channels), EXR_ERR_SUCCESS);
    assert_int_equal(exr_get_scanlines_per_chunk(f, 0, &lines), EXR_ERR_SUCCESS);
    int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    assert_true(channels->num_channels <= max);
    for (int c = 0; c < channels->num_channels; c++) {
        snprintf(list[c].name, sizeof list[c].name, "%s", channels->entries[c].name.str);
        list[c].size = (size_t)width * (size_t)height * (channels->entries[c].pixel_type == EXR_PIXEL_HALF ? 2u : 4u);
        list[c].bytes = malloc(list[c].size);
    }
    int count = channels->num_channels;
    for (int y = window.min.y; y <= window.max.y; y += lines) read_chunk(f, 0, y, window.min.y, width, list, count);
    exr_finish(&f);
    return count;
}

static void free_raw(raw *list, int n)
{
    for (int i = 0; i < n; i++) free(list[i].bytes);
}

static const raw *find(const raw *list, int n, const char *name)
{
    for (int i = 0; i < n; i++)
        if (strcmp(list[i].name, name) == 0) return &list[i];
    fail_msg("there is no channel '%s'", name);
    return NULL;
}

static void filter_file(const char *in, const char *out, void (*change)(options *))
{
    error e = {0};
    options o;
    log_t log;
    job j;
    frame_result r;
    options_defaults(&o);
    if (change) change(&o);
    log_init(&log, LOG_QUIET);
    job_open(&j, &o, &log);
    must(frame_run(&j, in, out, &r, &e), &e);
    frame_free(&r);
    job_close(&j);
    log_free(&log);
}

// `composite` is the type the composite has beside a beauty: the beauty's own.
static void channels_pass_through(const char *in, const char *out, int composite)
{
    static raw a[128], b[128];
    static const char *ours[] = {"occlusion.R", "radiance.R", "radiance.G",  "radiance.B",  "indirect.R",
                                 "indirect.G",  "indirect.B", "composite.R", "composite.G", "composite.B"};
    int na = read_raw(in, a, 128), nb = read_raw(out, b, 128);
    for (int i = 0; i < na; i++) {
        const raw *same = find(b, nb, a[i].name);
        assert_int_equal(same->type, a[i].type);
        assert_int_equal(same->size, a[i].size);
        if (memcmp(same->bytes, a[i].bytes, a[i].size) != 0) fail_msg("channel '%s' changed", a[i].name);
    }
    for (size_t i = 0; i < sizeof ours / sizeof *ours; i++)
        assert_int_equal(find(b, nb, ours[i])->type, ours[i][0] == 'c' ? composite : EXR_PIXEL_HALF);
    free_raw(a, na);
    free_raw(b, nb);
}

static void sample_passes_through(void **state)
{
    (void)state;
    filter_file("samples/still.exr", path_of("still.exr"), NULL);
    channels_pass_through("samples/still.exr", path_of("still.exr"), EXR_PIXEL_HALF);
}

static void multipart(options *o) { o->multipart = true; }

// --layout multipart: part 0 holds the input's own chunks, whatever their compression.
static void multipart_copies_the_input(void **state)
{
    (void)state;
    static raw a[128], b[128];
    filter_file("samples/still.exr", path_of("multi.exr"), multipart);
    int na = read_raw("samples/still.exr", a, 128), nb = read_raw(path_of("multi.exr"), b, 128);
    assert_int_equal(na, nb);
    for (int i = 0; i < na; i++) assert_memory_equal(find(b, nb, a[i].name)->bytes, a[i].bytes, a[i].size);
    free_raw(a, na);
    free_raw(b, nb);
    exrio_file *f = NULL;
    error e = {0};
    must(exrio_file_open(path_of("multi.exr"), &f, &e), &e);
    assert_int_equal(f->part_count, 2);
    assert_string_equal(f->parts[1].name, "ssdo");
    assert_int_equal(f->parts[1].channel_count, 11);
    exrio_file_close(f);
}

static void make_file(const char *path, const char *convention)
{
    scene s = {0};
    error e = {0};
    scene_clutter(&s);
    view v = view_perspective(80, 60, 50.0, 1.0);
    view_scene(&v, &s);
    must(scene_write(&s, &v, &(scene_exr_options){.convention = convention, .compression = EXR_COMPRESSION_ZIPS}, path, &e), &e);
}

// NaN with its payload, infinities and denormals in the data channels come out as they went in, and our layers hold none of them.
static void odd_values_pass_through(void **state)
{
    (void)state;
    error e = {0};
    exrio_file *f = NULL;
    make_file(path_of("plain.exr"), "plain");
    must(exrio_file_open(path_of("plain.exr"), &f, &e), &e);
    exrio_part *p = &f->parts[0];
    exrio_out_channel out[64];
    for (int c = 0; c < p->channel_count; c++) p->channels[c].wanted = true;
    must(exrio_file_load(f, 1, &e), &e);
    static const uint32_t odd[] = {0x7fc12345u, 0xffa00001u, 0x7f800000u, 0xff800000u, 0x00000001u, 0x80000000u, 0x7149f2cau};
    for (int c = 0; c < p->channel_count; c++) {
        for (int i = 0; i < 7 && p->channels[c].type == SAMPLE_FLOAT; i++)
            memcpy((uint32_t *)p->channels[c].data + 2000 + 7 * c + i, &odd[i], 4);
        out[c] = (exrio_out_channel){p->channels[c].name, p->channels[c].type, p->channels[c].data};
    }
    exrio_out_part part = {.data_window = p->data_window,
                           .display_window = p->display_window,
                           .pixel_aspect = 1.0f,
                           .compression = EXR_COMPRESSION_ZIP,
                           .channels = out,
                           .channel_count = p->channel_count};
    must(exrio_write(path_of("odd.exr"), &part, 1, 1, &e), &e);
    exrio_file_close(f);
    filter_file(path_of("odd.exr"), path_of("odd_out.exr"), NULL);
    channels_pass_through(path_of("odd.exr"), path_of("odd_out.exr"), EXR_PIXEL_FLOAT);
    static raw b[128];
    int n = read_raw(path_of("odd_out.exr"), b, 128);
    for (int i = 0; i < n; i++)
        for (size_t k = 0; strncmp(b[i].name, "occl", 4) == 0 && k < b[i].size / 2; k++)
            assert_true((((uint16_t *)b[i].bytes)[k] & 0x7c00) != 0x7c00);
    free_raw(b, n);
}

static void no_amount(options *o) { o->amount = 0.0, o->bounce = "none", o->layers = "occlusion,composite"; }

static void amount_zero_is_the_beauty(void **state)
{
    (void)state;
    static raw b[128];
    filter_file("samples/still.exr", path_of("zero.exr"), no_amount);
    int n = read_raw(path_of("zero.exr"), b, 128);
    for (int k = 0; k < 4; k++) {
        char ours[32], theirs[48];
        snprintf(ours, sizeof ours, "composite.%c", "RGBA"[k]);
        snprintf(theirs, sizeof theirs, "ViewLayer.Combined.%c", "RGBA"[k]);
        assert_memory_equal(find(b, n, ours)->bytes, find(b, n, theirs)->bytes, find(b, n, ours)->size);
    }
    free_raw(b, n);
}

// A second run replaces the first run's layers and gives the same bytes.
static void own_layers_are_replaced(void **state)
{
    (void)state;
    static raw a[128], b[128];
    filter_file("samples/still.exr", path_of("one.exr"), NULL);
    filter_file(path_of("one.exr"), path_of("two.exr"), NULL);
    int na = read_raw(path_of("one.exr"), a, 128), nb = read_raw(path_of("two.exr"), b, 128);
    assert_int_equal(na, nb);
    for (int i = 0; i < na; i++) assert_memory_equal(find(b, nb, a[i].name)->bytes, a[i].bytes, a[i].size);
    free_raw(a, na);
    free_raw(b, nb);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sample_passes_through),      cmocka_unit_test(odd_values_pass_through),
        cmocka_unit_test(amount_zero_is_the_beauty),  cmocka_unit_test(own_layers_are_replaced),
        cmocka_unit_test(multipart_copies_the_input),
    };
    return cmocka_run_group_tests_name("output", tests, make_folder, remove_folder);
}
