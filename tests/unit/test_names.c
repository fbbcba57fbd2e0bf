// Words of the command line: the layers of --layers, and names of files before anything is opened.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "cli/names.h"
#include "pipeline/layers.h"

static unsigned parsed(const char *list)
{
    error e = {0};
    unsigned set = 0;
    if (!layers_parse(list, &set, &e)) fail_msg("%s: %s", list, e.message);
    return set;
}

static void layers_are_named(void **state)
{
    (void)state;
    const unsigned four = 1u << LAYER_OCCLUSION | 1u << LAYER_RADIANCE | 1u << LAYER_INDIRECT | 1u << LAYER_COMPOSITE;
    assert_int_equal(parsed(NULL), four);
    assert_int_equal(parsed("composite,indirect,radiance,occlusion"), four);
    assert_int_equal(parsed("bent,bent,"), 1u << LAYER_BENT);
    for (int i = 0; i < LAYER_COUNT; i++) assert_int_equal(parsed(layer_table[i]->name), 1u << i);
}

// A part of a name, a longer one, another case and nothing at all are refused, and the sentence lists every layer.
static void unknown_layers_are_refused(void **state)
{
    (void)state;
    static const char *const lists[] = {"occ", "occlusions", "Occlusion", "", ",occlusion", "occlusion,,bent", "occlusion, bent"};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        error e = {0};
        unsigned set;
        if (layers_parse(lists[i], &set, &e)) fail_msg("'%s' was taken", lists[i]);
        assert_int_equal(e.code, ERR_USAGE);
        for (int k = 0; k < LAYER_COUNT; k++)
            if (!strstr(e.message, layer_table[k]->name)) fail_msg("no %s in: %s", layer_table[k]->name, e.message);
    }
}

static void frames_differ_in_one_number(void **state)
{
    (void)state;
    char pattern[32];
    assert_true(names_are_frames("a/v2.0001.exr", "a/v2.0017.exr", pattern, sizeof pattern));
    assert_string_equal(pattern, "a/v2.####.exr");
    assert_false(names_are_frames("a/P.0001.exr", "a/N.0001.exr", pattern, sizeof pattern));
    assert_false(names_are_frames("a/P.0001.exr", "a/P.0001.exr", pattern, sizeof pattern));
    assert_false(names_are_frames("a/v1.0001.exr", "a/v2.0002.exr", pattern, sizeof pattern));
}

static void other_formats_are_refused(void **state)
{
    (void)state;
    static const char *const taken[] = {"out.exr", "out.EXR", "png/out.tmp", "out.png.exr"};
    static const char *const refused[] = {"out.png", "a.exr/out.TIFF"};
    for (size_t i = 0; i < sizeof taken / sizeof *taken; i++) {
        error e = {0};
        if (!names_check_output(taken[i], &e)) fail_msg("%s: %s", taken[i], e.message);
    }
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        error e = {0};
        if (names_check_output(refused[i], &e)) fail_msg("%s was taken", refused[i]);
        assert_int_equal(e.code, ERR_USAGE);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_are_named),
        cmocka_unit_test(unknown_layers_are_refused),
        cmocka_unit_test(frames_differ_in_one_number),
        cmocka_unit_test(other_formats_are_refused),
    };
    return cmocka_run_group_tests_name("names", tests, NULL, NULL);
}
