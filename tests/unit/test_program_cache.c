// The cache of linked programs: a second run compiles nothing, and whatever lies in the folder, the program comes out right.
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "gpu/gpu.h"
#include "must.h"

static char folder[64];

typedef struct counts {
    int compiled, cached;
} counts;

// Opens a context, asks for two programs, closes it: a run of the tool.
static counts run(const char *defines)
{
    error e = {0};
    log_t log;
    gpu g;
    log_init(&log, LOG_QUIET);
    must(gpu_open(&g, -1, &log, &e), &e);
    must(gpu_program_get(&g, "tone.comp", NULL, false, &e) != NULL, &e);
    must(gpu_program_get(&g, "blur.comp", defines, true, &e) != NULL, &e);
    assert_int_equal(glGetError(), GL_NO_ERROR);
    counts c = {g.programs_compiled, g.programs_cached};
    gpu_close(&g);
    log_free(&log);
    return c;
}

static const char *SCALAR = "SCALARS 1\nCOLOURS 0\n", *COLOUR = "SCALARS 0\nCOLOURS 1\n";

static int for_entries(void (*fn)(const char *path))
{
    char path[400], dir[96];
    int n = 0;
    snprintf(dir, sizeof dir, "%s/ssdo-filter", folder);
    DIR *d = opendir(dir);
    for (struct dirent *f; d && (f = readdir(d));) {
        if (!strstr(f->d_name, ".program")) continue;
        snprintf(path, sizeof path, "%s/%s", dir, f->d_name);
        if (fn) fn(path);
        n++;
    }
    if (d) closedir(d);
    return n;
}

static void remove_entry(const char *path) { unlink(path); }

static void flip_last_byte(const char *path)
{
    FILE *f = fopen(path, "r+b");
    fseek(f, -1, SEEK_END);
    int c = fgetc(f);
    fseek(f, -1, SEEK_END);
    fputc(c ^ 1, f);
    fclose(f);
}

static void cut(const char *path) { assert_int_equal(truncate(path, 60), 0); }
static void overwrite(const char *path)
{
    FILE *f = fopen(path, "wb");
    fputs("something else altogether", f);
    fclose(f);
}

static int begin(void **state)
{
    (void)state;
    for_entries(remove_entry);
    return 0;
}

static bool cacheable(counts first)
{
    if (for_entries(NULL) == first.compiled) return true;
    print_message("this driver keeps no program binaries\n");
    return false;
}

static void second_run_compiles_nothing(void **state)
{
    (void)state;
    counts first = run(SCALAR);
    assert_int_equal(first.compiled, 2);
    if (!cacheable(first)) skip();
    counts second = run(SCALAR);
    assert_int_equal(second.compiled, 0);
    assert_int_equal(second.cached, 2);
}

static void other_defines_are_another_program(void **state)
{
    (void)state;
    if (!cacheable(run(SCALAR))) skip();
    counts c = run(COLOUR);
    assert_int_equal(c.compiled, 1);
    assert_int_equal(c.cached, 1);
}

static void damaged_entries_are_compiled_again(void **state)
{
    (void)state;
    static void (*const ways[])(const char *) = {flip_last_byte, cut, overwrite};
    if (!cacheable(run(SCALAR))) skip();
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        for_entries(ways[i]);
        assert_int_equal(run(SCALAR).compiled, 2);
        assert_int_equal(run(SCALAR).compiled, 0);
    }
}

static void without_a_folder_all_works(void **state)
{
    (void)state;
    setenv("XDG_CACHE_HOME", "/proc/nowhere", 1);
    counts c = run(SCALAR);
    setenv("XDG_CACHE_HOME", folder, 1);
    assert_int_equal(c.compiled, 2);
}

int main(void)
{
    snprintf(folder, sizeof folder, "/tmp/ssdo_cache_%d", (int)getpid());
    setenv("XDG_CACHE_HOME", folder, 1);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(second_run_compiles_nothing, begin),
        cmocka_unit_test_setup(other_defines_are_another_program, begin),
        cmocka_unit_test_setup(damaged_entries_are_compiled_again, begin),
        cmocka_unit_test_setup(without_a_folder_all_works, begin),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    char command[128];
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    return system(command) == 0 ? failed : 1;
}
