// Every program that a pass can ask for, linked as a device with GL's minimum limits gets it: it links, the driver counts no more
// in it than OpenGL 4.5 core promises everywhere, and no two of its pictures share a unit. tests/golden/limits.sh counts what is
// declared and not used, which no driver tells.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/threads.h"
#include "gpu/internal.h"
#include "must.h"
#include "passes/variants.h"

typedef struct linker {
    gpu g;
    log_t log;
    const variant_row *row;
    bool drawn;
    int linked;
} linker;

static int count_kind(const gpu_program *p, gpu_slot_kind kind)
{
    int n = 0;
    for (int i = 0; i < p->slot_count; i++) n += p->slots[i].kind == kind;
    return n;
}

// Units of one kind are 0, 1, 2 ... in any order.
static void units_are_apart(const gpu_program *p, gpu_slot_kind kind)
{
    unsigned used = 0;
    for (int i = 0; i < p->slot_count; i++) {
        if (p->slots[i].kind != kind) continue;
        assert_in_range(p->slots[i].unit, 0, 31);
        assert_int_equal(used >> p->slots[i].unit & 1u, 0);
        used |= 1u << p->slots[i].unit;
    }
}

static void blocks_are_small(const gpu_program *p)
{
    GLint blocks = 0, bytes = 0;
    glGetProgramiv(p->id, GL_ACTIVE_UNIFORM_BLOCKS, &blocks);
    assert_in_range(blocks, 0, 14);
    for (GLint i = 0; i < blocks; i++) {
        glGetActiveUniformBlockiv(p->id, (GLuint)i, GL_UNIFORM_BLOCK_DATA_SIZE, &bytes);
        assert_in_range(bytes, 1, 16384);
    }
}

static bool link_variant(void *context, const char *words)
{
    linker *l = context;
    char file[64], defines[2 * VARIANT_TEXT];
    error e = {0};
    snprintf(file, sizeof file, "%s.comp", l->row->program);
    assert_true(variant_defines(words, defines, sizeof defines));
    const gpu_program *p = gpu_program_get(&l->g, file, defines, l->drawn, &e);
    if (!p) print_error("%s %s\n", file, words);
    must(p != NULL, &e);
    int images = count_kind(p, SLOT_IMAGE), buffers = count_kind(p, SLOT_BUFFER), outputs = count_kind(p, SLOT_OUTPUT);
    assert_in_range(images, 0, 8);
    assert_in_range(count_kind(p, SLOT_TEXTURE), 0, 16);
    assert_in_range(buffers, 0, 8);
    assert_in_range(images + buffers + outputs, 0, 8);
    for (gpu_slot_kind k = SLOT_TEXTURE; k <= SLOT_BUFFER; k++) units_are_apart(p, k);
    blocks_are_small(p);
    gpu_programs_free(&l->g); // thousands of them
    l->linked++;
    return true;
}

static void every_program_keeps_to_the_minima(void **state)
{
    (void)state;
    linker l = {.linked = 0};
    error e = {0};
    log_init(&l.log, LOG_QUIET);
    must(gpu_open(&l.g, -1, &l.log, &e), &e);
    l.g.habits.read_images = false;
    for (int i = 0; (l.row = variant_row_at(i)); i++)
        for (int drawn = 0; drawn <= l.row->drawable; drawn++) {
            l.drawn = drawn;
            assert_true(variant_each(l.row, link_variant, &l));
        }
    printf("figure: %d programs linked\n", l.linked);
    assert_true(l.linked > 2000);
    gpu_close(&l.g);
    log_free(&l.log);
}

static void habits_follow_the_device(void **state)
{
    (void)state;
    const gpu_limits minima = {8, 8, 8, 8, 1 << 27}, many = {192, 32, 16, 72, 1 << 27};
    const char *const mesa = "4.5 (Core Profile) Mesa 22.3.6";
    gpu_habits h = gpu_choose_habits(true, mesa, &many, NULL, NULL);
    assert_true(h.read_images && h.draw);
    h = gpu_choose_habits(true, mesa, &minima, NULL, NULL); // a software device that offers no more
    assert_true(!h.read_images && h.draw);
    h = gpu_choose_habits(false, mesa, &many, NULL, NULL);
    assert_true(!h.read_images && !h.draw);
    h = gpu_choose_habits(false, mesa, &minima, "image", "1"); // no word makes a device do what it cannot
    assert_true(!h.read_images && h.draw);
    h = gpu_choose_habits(true, mesa, &many, "texture", "0");
    assert_true(!h.read_images && !h.draw);

    const char *const good[] = {"4.5 (Core Profile) Mesa 21.3.0", "4.6 (Core Profile) Mesa 25.0.7-2", "4.5 somebody's"};
    for (int i = 0; i < 3; i++) assert_true(gpu_choose_habits(true, good[i], &many, NULL, NULL).read_images);
    const char *const bad[] = {"4.5 (Core Profile) Mesa 20.3.5", "4.5 (Core Profile) Mesa 21.2.6"};
    for (int i = 0; i < 2; i++) {
        h = gpu_choose_habits(true, bad[i], &many, NULL, NULL);
        assert_true(!h.read_images && h.draw);
        assert_true(gpu_choose_habits(true, bad[i], &many, "image", NULL).read_images);
    }
}

static void threads_wait_on_an_old_libc(void **state)
{
    (void)state;
    assert_false(threads_start_beside_loading("2.31"));
    assert_false(threads_start_beside_loading("2.28"));
    assert_true(threads_start_beside_loading("2.34"));
    assert_true(threads_start_beside_loading("2.41"));
    assert_true(threads_start_beside_loading("3.0"));
    assert_true(threads_start_beside_loading("somebody's"));
}

static bool count_set(void *context, const char *words)
{
    (void)words;
    ++*(int *)context;
    return true;
}

static void patterns_allow_what_they_list(void **state)
{
    (void)state;
    const variant_row row = {"trial", "A [B] | C=2 [B] [D]", false, false};
    int n = 0;
    assert_true(variant_each(&row, count_set, &n));
    assert_int_equal(n, 2 * (2 + 4)); // both cameras
    assert_true(variant_allowed(&row, "A") && variant_allowed(&row, "B A") && variant_allowed(&row, "C=2 D"));
    assert_false(variant_allowed(&row, "") || variant_allowed(&row, "B") || variant_allowed(&row, "A D") ||
                 variant_allowed(&row, "C=1") || variant_allowed(&row, "A C=2"));
    char out[64];
    assert_true(variant_defines("A C=2", out, sizeof out));
    assert_string_equal(out, "A 1\nC 2\n");
    assert_false(variant_defines("A C=2", out, 6));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_program_keeps_to_the_minima),
        cmocka_unit_test(habits_follow_the_device),
        cmocka_unit_test(threads_wait_on_an_old_libc),
        cmocka_unit_test(patterns_allow_what_they_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
