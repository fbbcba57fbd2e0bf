// A batch takes no more memory the longer it gets: what a long one leaves behind, all its frames freed, is what a short one left.
//
// A batch before both warms the process: a driver that compiles shaders keeps memory of its own (LLVM, with nothing in its cache:
// some 10 MiB), and one that finds them compiled does not. The margin is MARGIN of a frame, 8 MiB: a leak of one byte a pixel and
// frame is 10 MiB here. The peak itself says less: how far the frames in flight overlap is chance. `make bench-frame` shows it at
// full size.
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

#include "base/mem.h"
#include "must.h"
#include "pipeline/batch.h"
#include "scene_picture.h"

enum { SHORT = 5, LONG = 16, WIDTH = 1280, HEIGHT = 720 };
#define MARGIN 0.03

static char folder[] = "/tmp/ssdo-batch-XXXXXX";

static int remove_folder(void **state)
{
    char command[64];
    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

// Resident memory that is no file's, in MiB.
static double resident(void)
{
    char line[160];
    long kib = -1;
    FILE *f = fopen("/proc/self/status", "r");
    while (f && fgets(line, sizeof line, f))
        if (sscanf(line, "RssAnon: %ld kB", &kib) == 1) break;
    if (f) fclose(f);
    assert_true(kib > 0);
    return (double)kib / 1024.0;
}

// Filters the first `frames` frames and returns what is resident afterwards.
static double after(int frames)
{
    char in[96], out[96], range[16];
    // Little work for each pixel: what counts is the pictures.
    char *argv[] = {"ssdo-filter", "-q",   in,          "-o", out,      "--frames", range,
                    "--method",    "ssdo", "--samples", "2",  "--blur", "none"};
    options o;
    error e = {0};
    log_t log;
    job j;
    snprintf(in, sizeof in, "%s/in.####.exr", folder);
    snprintf(out, sizeof out, "%s/out.####.exr", folder);
    snprintf(range, sizeof range, "1-%d", frames);
    options_defaults(&o);
    must(options_parse(sizeof argv / sizeof *argv, argv, &o, &e), &e);
    log_init(&log, LOG_QUIET);
    job_open(&j, &o, &log);
    must(batch_run(&j, &e), &e);
    double left = resident();
    job_close(&j);
    log_free(&log);
    return left;
}

static void test_flat(void **state)
{
    (void)state;
    after(SHORT);
    double few = after(SHORT), many = after(LONG), frame = WIDTH * HEIGHT * 300.0 / 1048576.0;
    printf("figure: resident after %d frames %.1f MiB, after %d frames %.1f MiB; one frame takes about %.0f MiB\n", SHORT, few,
           LONG, many, frame);
    assert_true(many < 0.5 * frame && many <= few + MARGIN * frame);
}

// One picture under many names.
static int set_up(void **state)
{
    (void)state;
    scene s = {0};
    error e = {0};
    char path[96], link[96];
    mem_set_up();
    if (!mkdtemp(folder)) return -1;
    scene_clutter(&s);
    view v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&v, &s);
    scene_exr_options o = {.convention = "plain", .compression = EXR_COMPRESSION_ZIP};
    snprintf(path, sizeof path, "%s/picture.exr", folder);
    must(scene_write(&s, &v, &o, path, &e), &e);
    for (int i = 1; i <= LONG; i++) {
        snprintf(link, sizeof link, "%s/in.%04d.exr", folder, i);
        if (symlink(path, link) != 0) return -1;
    }
    return 0;
}

int main(void)
{
#ifdef __SANITIZE_ADDRESS__
    puts("the address sanitizer keeps what is freed");
    return 77;
#endif
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_flat)};
    return cmocka_run_group_tests(tests, set_up, remove_folder);
}
