// Random damage to whole files: 10,000 bit flips over every kind of file, in bounded memory. Each gives an error with a sentence
// or a result whose samples are finite and in bounds; nothing crashes or prints.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

#include <openexr.h>

#include "exr/file.h"
#include "gbuffer/gbuffer.h"
#include "hard.h"

static const int kinds[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,   EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                            EXR_COMPRESSION_PIZ,  EXR_COMPRESSION_PXR24, EXR_COMPRESSION_B44,  EXR_COMPRESSION_B44A};
enum { KINDS = sizeof kinds / sizeof *kinds, WIDTH = 24, HEIGHT = 18, MEGABYTES = 512 };
#ifdef __SANITIZE_ADDRESS__ // which reserves terabytes of addresses
static const char bound[] = "";
#else
static const char bound[] = ", in 512 MB";
#endif

static bool sound(const gbuffer *g)
{
    size_t n = (size_t)g->width * (size_t)g->height;
    for (size_t i = 0; i < n; i++)
        if (!(g->depth[i] >= 0.0f && isfinite(g->depth[i]) &&
              isfinite(g->normal[4 * i] + g->normal[4 * i + 1] + g->normal[4 * i + 2])))
            return false;
    for (size_t i = 0; g->albedo && i < 4 * n; i++)
        if (!isfinite(g->albedo[i])) return false;
    return true;
}

// 0 an error with a sentence, 1 a sound result, 2 neither.
static int read_frame(const char *path)
{
    exrio_file *f = NULL;
    resolution r;
    gbuffer g;
    error e = {0};
    int result = 0;
    if (exrio_file_open(path, &f, &e) && resolve_channels(f, &(resolve_options){0}, &r, NULL, &e)) {
        for (int p = 0; p < f->part_count; p++)
            for (int c = 0; c < f->parts[p].channel_count; c++) f->parts[p].channels[c].wanted = true;
        gbuffer_options o = {.need = NEED_ALBEDO | NEED_COVERAGE, .threads = 1};
        if (exrio_file_load(f, 1, &e) && gbuffer_build(f, &r, &o, &g, NULL, &e)) {
            result = sound(&g) ? 1 : 2;
            gbuffer_free(&g);
        }
    }
    exrio_file_close(f);
    return result == 0 && (e.code == ERR_NONE || !e.message[0]) ? 2 : result;
}

// In a child with bounded memory and time: counts of the three outcomes to `to`.
static void flip_all(const char *path, const char *bytes, size_t size, int flips, uint32_t seed, int to)
{
    int counts[3] = {0};
    char *copy = malloc(size);
#ifndef __SANITIZE_ADDRESS__
    setrlimit(RLIMIT_AS, &(struct rlimit){(rlim_t)MEGABYTES << 20, (rlim_t)MEGABYTES << 20});
#endif
    setrlimit(RLIMIT_CPU, &(struct rlimit){120, 120});
    for (int i = 0; copy && i < flips; i++) {
        memcpy(copy, bytes, size);
        for (int k = 0; k < 1 + i % 3; k++) {
            seed = seed * 1664525u + 1013904223u;
            // Half of the flips in the header, where the structure is.
            size_t at = (seed >> 8) % (i % 2 && size > 900 ? 900 : size);
            copy[at] = (char)(copy[at] ^ 1 << (seed & 7));
        }
        FILE *f = fopen(path, "wb");
        if (!f || fwrite(copy, 1, size, f) != size || fclose(f) != 0) break;
        counts[read_frame(path)]++;
    }
    (void)!write(to, counts, sizeof counts);
    free(copy);
#ifdef __SANITIZE_ADDRESS__
    __lsan_do_leak_check();
#endif
    _exit(0);
}

static size_t file_of(const hard *h, int kind, char **bytes)
{
    scene s;
    scene_clutter(&s);
    view v = view_perspective(WIDTH, HEIGHT, 50.0, 1.0);
    view_scene(&v, &s);
    exrio_file *file =
        hard_file(&s, &v, &(scene_exr_options){.convention = kind % 2 ? "blender" : "plain", .compression = kinds[kind]});
    FILE *f = fopen(hard_write(h, file, "whole"), "rb");
    assert_non_null(f);
    *bytes = malloc(1 << 20);
    size_t size = fread(*bytes, 1, 1 << 20, f);
    fclose(f);
    scene_file_free(file);
    return size;
}

static void bit_flips(void **state)
{
    const hard *h = *state;
    int total[3] = {0}, flips = hard_whole() ? 10000 / KINDS : 160;
    char path[128];
    snprintf(path, sizeof path, "%s/flipped.exr", h->folder);
    for (int k = 0; k < KINDS; k++) {
        char *bytes;
        int ends[2], status, counts[3] = {0};
        size_t size = file_of(h, k, &bytes);
        assert_int_equal(pipe(ends), 0);
        fflush(stdout);
        pid_t child = fork();
        if (child == 0) flip_all(path, bytes, size, flips, (uint32_t)k + 1, ends[1]);
        close(ends[1]);
        assert_int_equal(read(ends[0], counts, sizeof counts), sizeof counts);
        close(ends[0]);
        assert_int_equal(waitpid(child, &status, 0), child);
        if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
            fail_msg("compression %d: the reader died (status %d)", kinds[k], status);
        assert_int_equal(counts[0] + counts[1] + counts[2], flips);
        for (int i = 0; i < 3; i++) total[i] += counts[i];
        free(bytes);
    }
    printf("figure: %d damaged files: %d refused with a sentence, %d read and sound, %d neither%s\n",
           total[0] + total[1] + total[2], total[0], total[1], total[2], bound);
    assert_int_equal(total[2], 0);
    assert_true(total[0] > 0 && total[1] > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(bit_flips)};
    return cmocka_run_group_tests_name("hard files", tests, hard_open, hard_close);
}
