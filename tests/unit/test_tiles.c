// The frame is worked on in tiles, dispatched or drawn: their size changes no bit of the output, and neither does drawing tiles
// that lie side by side at once.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "must.h"
#include "pipeline/frame.h"
#include "scene_picture.h"

enum { WIDTH = 150, HEIGHT = 70 };

static void path_of(const char *name, char path[96]) { snprintf(path, 96, "/tmp/ssdo_tiles_%d_%s", (int)getpid(), name); }

static void write_scene(const char *path)
{
    static scene s;
    error e = {0};
    scene_exr_options how = {.convention = "plain"};
    scene_clutter(&s);
    view v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&v, &s);
    must(scene_write(&s, &v, &how, path, &e), &e);
}

// The output file's bytes, for a tile size; *size of them.
static char *filtered(const char *name, const char *tile, long *size)
{
    error e = {0};
    options o;
    log_t log;
    job j;
    frame_result r;
    char input[96], output[96];
    path_of("in.exr", input);
    path_of("out.exr", output);
    write_scene(input);
    setenv("SSDO_TILE", tile, 1);
    options_defaults(&o);
    o.method = name;
    o.samples = 8;
    o.env = "samples/sky_soft.exr";
    log_init(&log, LOG_QUIET);
    job_open(&j, &o, &log);
    must(frame_read(&j, input, &r, &e), &e);
    must(frame_filter(&j, &r, &e), &e);
    unsetenv("SSDO_TILE"); // the record would name it
    must(frame_write(&j, &r, output, &e), &e);
    frame_free(&r);
    job_close(&j);
    log_free(&log);
    FILE *f = fopen(output, "rb");
    assert_non_null(f);
    fseek(f, 0, SEEK_END);
    *size = ftell(f);
    rewind(f);
    char *bytes = malloc((size_t)*size);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, (size_t)*size, f), *size);
    fclose(f);
    remove(input);
    remove(output);
    return bytes;
}

static void size_changes_nothing(void **state)
{
    static const char *const names[] = {"ssdo", "hbao"}, *const tiles[] = {"8", "17", "4096"};
    (void)state;
    for (size_t m = 0; m < 2; m++) {
        long size, other;
        char *usual = filtered(names[m], "64", &size);
        for (size_t i = 0; i < 3; i++) {
            char *bytes = filtered(names[m], tiles[i], &other);
            assert_int_equal(size, other);
            assert_memory_equal(usual, bytes, (size_t)size);
            free(bytes);
        }
        free(usual);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(size_changes_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
