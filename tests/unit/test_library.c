// The library as its callers meet it: files and memory give the same layers, contexts in threads give those of one, and nothing
// of the process is changed.
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "exr/file.h"
#include "ssdo.h"

#define SAMPLE "samples/box.exr"
#define SKY "samples/sky_soft.exr"

extern char **environ;

static void set(ssdo_context *c, const char *name, const char *value)
{
    if (ssdo_set(c, name, value) != SSDO_OK) fail_msg("%s=%s: %s", name, value ? value : "default", ssdo_message(c));
}

static ssdo_context *open_context(void)
{
    ssdo_context *c = ssdo_create(NULL);
    assert_non_null(c);
    set(c, "env", SKY);
    set(c, "samples", "4");
    set(c, "resolution", "half");
    set(c, "layers", "occlusion,radiance");
    set(c, "threads", "2");
    return c;
}

static ssdo_frame *filter(ssdo_context *c, const ssdo_input *in)
{
    ssdo_frame *f = NULL;
    if (ssdo_filter(c, in, &f) != SSDO_OK) fail_msg("%s", ssdo_message(c));
    return f;
}

static ssdo_frame *filter_file(ssdo_context *c)
{
    return filter(c, &(ssdo_input){sizeof(ssdo_input), .files = (const char *const[]){SAMPLE}, .file_count = 1});
}

static void assert_same(const ssdo_frame *a, const ssdo_frame *b)
{
    assert_int_equal(ssdo_layer_count(a), 2);
    assert_int_equal(ssdo_layer_count(b), 2);
    for (int i = 0; i < 2; i++) {
        ssdo_layer p = {.size = sizeof p}, q = {.size = sizeof q};
        assert_int_equal(ssdo_get_layer(a, i, &p), SSDO_OK);
        assert_int_equal(ssdo_get_layer(b, i, &q), SSDO_OK);
        assert_string_equal(p.name, q.name);
        assert_true(p.width == 480 && q.width == 480 && p.height == 270 && q.height == 270);
        assert_memory_equal(p.pixels, q.pixels, (size_t)(p.width * p.height) * strlen(p.channels) * sizeof(float));
    }
}

// The sample's channels, every other one with gaps between its pixels.
static void memory_is_read_as_a_file_is(void **state)
{
    (void)state;
    enum { MOST = 64 };
    error e = {0};
    exrio_file *file = NULL;
    assert_true(exrio_file_open(SAMPLE, &file, &e));
    exrio_part *part = &file->parts[0];
    for (int i = 0; i < part->channel_count; i++) part->channels[i].wanted = true;
    assert_true(exrio_file_load(file, 2, &e));
    int w = box2_width(part->data_window), h = box2_height(part->data_window), n = part->channel_count;
    ssdo_channel channels[MOST] = {0};
    char *spread[MOST] = {0};
    assert_true(n < MOST);
    for (int i = 0; i < n; i++) {
        const exrio_channel *from = &part->channels[i];
        size_t size = sample_size(from->type), gap = 3 * size;
        channels[i] = (ssdo_channel){sizeof *channels, from->name, (ssdo_type)from->type, from->data, 0, 0};
        if (i % 2 == 0) continue;
        spread[i] = malloc((size_t)w * (size_t)h * gap);
        assert_non_null(spread[i]);
        for (int k = 0; k < w * h; k++) memcpy(spread[i] + (size_t)k * gap, (const char *)from->data + (size_t)k * size, size);
        channels[i].samples = spread[i];
        channels[i].pixel_stride = (ptrdiff_t)gap;
    }
    ssdo_context *c = open_context();
    ssdo_frame *of_file = filter_file(c);
    ssdo_frame *of_memory =
        filter(c, &(ssdo_input){sizeof(ssdo_input), .width = w, .height = h, .channels = channels, .channel_count = n});
    assert_same(of_file, of_memory);
    ssdo_destroy(c);
    assert_same(of_file, of_memory); // frames outlive their context
    ssdo_free_frame(of_file);
    ssdo_free_frame(of_memory);
    for (int i = 0; i < n; i++) free(spread[i]);
    exrio_file_close(file);
}

static void *filter_in_thread(void *to)
{
    ssdo_context *c = open_context();
    *(ssdo_frame **)to = filter_file(c);
    ssdo_destroy(c);
    return NULL;
}

static void eight_contexts_in_eight_threads(void **state)
{
    (void)state;
    enum { THREADS = 8 };
    pthread_t thread[THREADS];
    ssdo_frame *frame[THREADS] = {0}, *alone = NULL;
    filter_in_thread(&alone);
    for (int i = 0; i < THREADS; i++) assert_int_equal(pthread_create(&thread[i], NULL, filter_in_thread, &frame[i]), 0);
    for (int i = 0; i < THREADS; i++) pthread_join(thread[i], NULL);
    for (int i = 0; i < THREADS; i++) {
        assert_same(alone, frame[i]);
        ssdo_free_frame(frame[i]);
    }
    ssdo_free_frame(alone);
}

static void settings_are_the_programs_options(void **state)
{
    (void)state;
    ssdo_context *c = ssdo_create(NULL);
    assert_int_equal(ssdo_set(c, "radius", "0.5"), SSDO_OK);
    assert_string_equal(ssdo_message(c), "");
    assert_int_equal(ssdo_set(c, "radius", "wide"), SSDO_USAGE);
    assert_non_null(strstr(ssdo_message(c), "radius"));
    assert_int_equal(ssdo_set(c, "output", "out.exr"), SSDO_USAGE); // a call's own
    assert_int_equal(ssdo_set(c, "frames", "1-10"), SSDO_USAGE);
    assert_int_equal(ssdo_set(c, "no-such", "1"), SSDO_USAGE);
    assert_int_equal(ssdo_set(c, NULL, "1"), SSDO_USAGE);
    assert_int_equal(ssdo_set(c, "strict", "1"), SSDO_OK);
    assert_int_equal(ssdo_set(c, "strict", "perhaps"), SSDO_USAGE);
    assert_int_equal(ssdo_set(c, "strict", NULL), SSDO_OK);
    assert_int_equal(ssdo_set(c, "fov", "40"), SSDO_OK);
    assert_int_equal(ssdo_set(c, "ortho", "4"), SSDO_USAGE); // both exclude each other: the second is not made
    assert_int_equal(ssdo_set(c, "fov", NULL), SSDO_OK);
    assert_int_equal(ssdo_set(c, "ortho", "4"), SSDO_OK);
    ssdo_destroy(c);
}

// A setting that was made again and taken back leaves what was there in the beginning.
static void settings_take_effect_and_back(void **state)
{
    (void)state;
    ssdo_context *c = open_context();
    ssdo_frame *first = filter_file(c), *other, *back;
    set(c, "radius", "0.1");
    set(c, "radius", "0.2");
    other = filter_file(c);
    set(c, "radius", NULL);
    back = filter_file(c);
    assert_same(first, back);
    ssdo_layer p = {.size = sizeof p}, q = {.size = sizeof q};
    ssdo_get_layer(first, 0, &p);
    ssdo_get_layer(other, 0, &q);
    assert_memory_not_equal(p.pixels, q.pixels, 480 * 270 * sizeof(float));
    ssdo_free_frame(first);
    ssdo_free_frame(other);
    ssdo_free_frame(back);
    ssdo_destroy(c);
}

// Also after a frame: the device is opened anew when the settings ask for another.
static void settings_choose_the_device(void **state)
{
    (void)state;
    ssdo_context *c = open_context(), *other = open_context();
    ssdo_frame *f = filter_file(c), *none = NULL;
    const ssdo_input in = {sizeof in, .files = (const char *const[]){SAMPLE}, .file_count = 1};
    set(c, "device", "31");
    assert_int_equal(ssdo_filter(c, &in, &none), SSDO_NO_GL);
    assert_non_null(strstr(ssdo_message(c), "device 31"));
    set(c, "device", NULL);
    ssdo_frame *again = filter_file(c);
    assert_same(f, again);
    assert_int_equal(ssdo_write(other, f, "nobody.exr"), SSDO_USAGE); // whose settings may be gone
    ssdo_free_frame(f);
    ssdo_free_frame(again);
    ssdo_destroy(c);
    ssdo_destroy(other);
}

static void wrong_input_is_said(void **state)
{
    (void)state;
    ssdo_context *c = ssdo_create(NULL);
    ssdo_frame *f = NULL;
    const float depth[4] = {1, 1, 1, 1};
    ssdo_channel one = {sizeof one, "Z", SSDO_FLOAT, depth, 0, 0};
    ssdo_input none = {.size = sizeof none},
               missing = {sizeof missing, .files = (const char *const[]){"no/such.exr"}, .file_count = 1},
               bare = {sizeof bare, .width = 2, .height = 2, .channels = &one, .channel_count = 1}, sizeless = bare;
    sizeless.size = 0;
    assert_int_equal(ssdo_filter(c, &none, &f), SSDO_USAGE);
    assert_int_equal(ssdo_filter(c, &sizeless, &f), SSDO_USAGE);
    assert_int_equal(ssdo_filter(c, &missing, &f), SSDO_BAD_INPUT);
    assert_non_null(strstr(ssdo_message(c), "no/such.exr"));
    assert_int_equal(ssdo_filter(c, &bare, &f), SSDO_BAD_INPUT); // a depth without a camera
    assert_non_null(strstr(ssdo_message(c), "the G-buffer in memory"));
    one.samples = NULL;
    assert_int_equal(ssdo_filter(c, &bare, &f), SSDO_USAGE);
    assert_null(f);
    ssdo_destroy(c);
}

static void take_message(void *user, ssdo_level level, const char *text)
{
    (void)level;
    assert_null(strchr(text, '\n'));
    ++*(int *)user;
}

// Warnings go to the caller, standard error stays empty, and the environment variables are those of before.
static void nothing_of_the_process_changes(void **state)
{
    (void)state;
    int told = 0, before = 0, after = 0;
    for (char **v = environ; *v; v++) before++;
    ssdo_context *c = ssdo_create(&(ssdo_setup){sizeof(ssdo_setup), take_message, &told, SSDO_INFORMATION});
    set(c, "samples", "2");
    set(c, "layers", "occlusion");
    set(c, "resolution", "half");
    FILE *said = tmpfile();
    int own = dup(2);
    fflush(stderr);
    dup2(fileno(said), 2);
    ssdo_frame *f = NULL;
    ssdo_status status =
        ssdo_filter(c, &(ssdo_input){sizeof(ssdo_input), .files = (const char *const[]){SAMPLE}, .file_count = 1}, &f);
    fflush(stderr);
    dup2(own, 2);
    close(own);
    assert_int_equal(status, SSDO_OK);
    assert_int_equal(lseek(fileno(said), 0, SEEK_END), 0);
    fclose(said);
    assert_true(told > 3);
    for (char **v = environ; *v; v++) after++;
    assert_int_equal(before, after);
    ssdo_free_frame(f);
    ssdo_destroy(c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_of_the_process_changes), // first, for others may set what it looks for
        cmocka_unit_test(memory_is_read_as_a_file_is),       cmocka_unit_test(eight_contexts_in_eight_threads),
        cmocka_unit_test(settings_are_the_programs_options), cmocka_unit_test(settings_take_effect_and_back),
        cmocka_unit_test(settings_choose_the_device),        cmocka_unit_test(wrong_input_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
