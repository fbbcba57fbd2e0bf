// Files other programs made: tiled, mip-mapped, any line order, several parts, lossy compressions.
// The C++ library is the reference: exrmaketiled -z none stores what it decodes, which leaves our reader little to do.
#include <openexr.h>

#include "exr/library.h"
#include "exrio_support.h"
#include "modules.h"

static int set_up(void **state)
{
    use_built_modules();
    return make_scratch(state);
}

static bool have_module(void)
{
    char path[4300];
    snprintf(path, sizeof path, "%s/ssdo-dwa.so", getenv("SSDO_PLUGIN_DIR"));
    if (access(path, R_OK) == 0) return true;
    print_message("note: %s is not built, so this is not checked\n", path);
    return false;
}

static void write_image(const image *im, const char *path)
{
    error e = {0};
    assert_ok(exrio_write(path, &im->part, 1, 2, &e), e);
}

// Finite values in smooth runs: lossy codecs differ in how they treat NaN, and must have something to lose.
static void make_finite(image *im)
{
    size_t n = (size_t)box2_width(im->part.data_window) * (size_t)box2_height(im->part.data_window);
    for (int c = 0; c < im->part.channel_count; c++) {
        uint8_t *data = (uint8_t *)(uintptr_t)im->channels[c].data;
        for (size_t i = 0; i < n; i++) {
            float f = (float)(i % 97) * 0.013f + (float)c;
            uint16_t h;
            exrio_to_half(&f, 1, 1, &h);
            uint32_t u = (uint32_t)(i * 7);
            const void *from = im->channels[c].type == SAMPLE_HALF    ? (void *)&h
                               : im->channels[c].type == SAMPLE_FLOAT ? (void *)&f
                                                                      : (void *)&u;
            memcpy(data + i * sample_size(im->channels[c].type), from, sample_size(im->channels[c].type));
        }
    }
}

static void test_tiled(void **state)
{
    (void)state;
    if (!have_tool("exrmaketiled")) return;
    static const char *const options[] = {"-z none -t 16 16",   "-z zip -t 64 64",   "-z zip -t 33 7",
                                          "-z rle -t 20 90",    "-z piz -t 32 32",   "-z rle -t 1 1",
                                          "-m -z zip -t 16 16", "-r -z piz -t 16 8", "-m -u -z zip -t 300 300"};
    image im;
    make_image(&im, 131, 77, EXR_COMPRESSION_ZIP, true);
    make_finite(&im); // mip levels are filtered
    write_image(&im, in_scratch("t.exr"));
    for (size_t i = 0; i < sizeof options / sizeof *options; i++)
        for (int threads = 1; threads <= 3; threads += 2) {
            const char *tiled = in_scratch("tiled.exr");
            assert_int_equal(run_command("exrmaketiled %s '%s' '%s'", options[i], in_scratch("t.exr"), tiled), 0);
            exrio_file *f = open_all(tiled, threads);
            assert_true(f->parts[0].tiled);
            assert_same_pixels(&im, &f->parts[0]);
            exrio_file_close(f);
        }
    free_image(&im);
}

static void assert_same_parts(const exrio_part *a, const exrio_part *b)
{
    size_t n = (size_t)box2_width(a->data_window) * (size_t)box2_height(a->data_window);
    assert_true(box2_equal(a->data_window, b->data_window));
    assert_int_equal(a->channel_count, b->channel_count);
    for (int c = 0; c < a->channel_count; c++) {
        assert_string_equal(a->channels[c].name, b->channels[c].name);
        assert_int_equal(a->channels[c].type, b->channels[c].type);
        assert_memory_equal(a->channels[c].data, b->channels[c].data, n * sample_size(a->channels[c].type));
    }
}

// A file by `codec` against the same one that OpenEXR's tool unpacked. changed: a channel whose lossy samples are not the
// original's, or the comparison would say little; NULL: the codec loses nothing.
static void check_against_plain(const char *codec, int number, bool tiled, const char *changed)
{
    image im;
    make_image(&im, 131, 77, EXR_COMPRESSION_ZIP, true);
    make_finite(&im);
    write_image(&im, in_scratch("l.exr"));
    const char *plainly = in_scratch("l.exr"), *to = in_scratch("packed.exr");
    assert_int_equal(tiled ? run_command("exrmaketiled -z %s -t 64 64 '%s' '%s'", codec, plainly, to)
                           : run_command("oiiotool '%s' --compression %s -o '%s'", plainly, codec, to),
                     0);
    assert_int_equal(run_command("exrmaketiled -z none '%s' '%s'", in_scratch("packed.exr"), in_scratch("plain.exr")), 0);
    exrio_file *packed = open_all(in_scratch("packed.exr"), 2), *plain = open_all(in_scratch("plain.exr"), 2);
    assert_int_equal(packed->parts[0].compression, number);
    assert_same_parts(&packed->parts[0], &plain->parts[0]);
    for (int i = 0; i < 7; i++) {
        const exrio_channel *c = find_channel(&packed->parts[0], im.channels[i].name);
        size_t size = 131 * 77 * sample_size(c->type);
        if (!changed) assert_memory_equal(c->data, im.channels[i].data, size);
        if (changed && strcmp(c->name, changed) == 0) assert_memory_not_equal(c->data, im.channels[i].data, size);
    }
    exrio_file_close(packed);
    exrio_file_close(plain);
    free_image(&im);
}

static void test_pxr24_and_b44(void **state)
{
    (void)state;
    if (!have_tool("exrmaketiled")) return;
    check_against_plain("pxr24", EXR_COMPRESSION_PXR24, true, "Z");
    check_against_plain("b44", EXR_COMPRESSION_B44, true, "a.R");
    check_against_plain("b44a", EXR_COMPRESSION_B44A, true, "a.R");
}

static void test_dwa(void **state)
{
    (void)state;
    if ((!exrio_library_decodes(EXR_COMPRESSION_DWAA) && !have_module()) || !have_tool("exrmaketiled")) return;
    for (int tiled = have_tool("oiiotool") ? 0 : 1; tiled < 2; tiled++) {
        check_against_plain("dwaa", EXR_COMPRESSION_DWAA, tiled, "R");
        check_against_plain("dwab", EXR_COMPRESSION_DWAB, tiled, "R");
    }
}

// The library of 3.4 and its tools have it; with older ones there is nothing to make such a file by.
static void test_htj2k(void **state)
{
    const int first = 10, by_32_lines = 11;
    (void)state;
    if (EXR_COMPRESSION_LAST_TYPE <= by_32_lines || !have_tool("exrmaketiled")) return;
    check_against_plain("htj2k256", first, true, NULL);
    check_against_plain("htj2k32", by_32_lines, true, NULL);
}

static void test_dwa_without_the_module(void **state)
{
    (void)state;
    if (!have_tool("exrmaketiled") || exrio_library_decodes(EXR_COMPRESSION_DWAA)) return;
#ifdef SSDO_LIBDIR
    if (access(SSDO_LIBDIR "/ssdo-dwa.so", R_OK) == 0) return; // an installed one would be found
#endif
    image im;
    error e = {0};
    exrio_file *f = NULL;
    make_image(&im, 8, 8, EXR_COMPRESSION_ZIP, false);
    write_image(&im, in_scratch("w.exr"));
    assert_int_equal(run_command("exrmaketiled -z dwaa '%s' '%s'", in_scratch("w.exr"), in_scratch("dwaa.exr")), 0);
    assert_ok(exrio_file_open(in_scratch("dwaa.exr"), &f, &e), e);
    f->parts[0].channels[0].wanted = true;
    char *folder = strdup(getenv("SSDO_PLUGIN_DIR"));
    setenv("SSDO_PLUGIN_DIR", "/nowhere", 1);
    assert_false(exrio_file_load(f, 1, &e));
    setenv("SSDO_PLUGIN_DIR", folder, 1);
    free(folder);
    assert_int_equal(e.code, ERR_INPUT);
    assert_non_null(strstr(e.message, "SSDO_PLUGIN_DIR"));
    assert_non_null(strstr(e.message, "/nowhere"));
    assert_null(f->parts[0].channels[0].data);
    exrio_file_close(f);
    free_image(&im);
}

static void test_line_orders(void **state)
{
    (void)state;
    if (!have_tool("oiiotool")) return;
    static const struct {
        const char *name, *tiles;
        int order;
    } orders[] = {
        {"increasingY", "", 0}, {"decreasingY", "", 1}, {"randomY", "--tile 16 16", 2}, {"decreasingY", "--tile 16 16", 1}};
    assert_int_equal(
        run_command("oiiotool --pattern noise:seed=1 70x90 3 -d half --compression none -o '%s'", in_scratch("n.exr")), 0);
    exrio_file *plain = open_all(in_scratch("n.exr"), 1);
    for (size_t i = 0; i < sizeof orders / sizeof *orders; i++)
        for (int zip = 0; zip < 2; zip++) {
            const char *path = in_scratch("ordered.exr");
            assert_int_equal(run_command("oiiotool '%s' %s --attrib openexr:lineOrder %s -d half --compression %s -o '%s'",
                                         in_scratch("n.exr"), orders[i].tiles, orders[i].name, zip ? "zip" : "none", path),
                             0);
            exrio_file *f = open_all(path, 2);
            exr_lineorder_t order;
            exr_get_lineorder(f->core, 0, &order);
            assert_int_equal(order, orders[i].order);
            assert_same_parts(&plain->parts[0], &f->parts[0]);
            exrio_file_close(f);
        }
    exrio_file_close(plain);
}

static void test_multipart(void **state)
{
    (void)state;
    if (!have_tool("exrmultipart") || !have_tool("exrmaketiled")) return;
    image a, b;
    make_image(&a, 40, 50, EXR_COMPRESSION_ZIP, true);
    make_image(&b, 40, 50, EXR_COMPRESSION_PIZ, true);
    write_image(&a, in_scratch("pa.exr"));
    write_image(&b, in_scratch("pb.exr"));
    assert_int_equal(run_command("exrmaketiled -z rle '%s' '%s'", in_scratch("pb.exr"), in_scratch("pt.exr")), 0);
    assert_int_equal(run_command("exrmultipart -combine -i '%s::flat' '%s::tiled' -o '%s' >/dev/null", in_scratch("pa.exr"),
                                 in_scratch("pt.exr"), in_scratch("parts.exr")),
                     0);
    exrio_file *f = open_all(in_scratch("parts.exr"), 3);
    assert_int_equal(f->part_count, 2);
    for (int i = 0; i < 2; i++) {
        bool tiled = f->parts[i].tiled;
        assert_string_equal(f->parts[i].name, tiled ? "tiled" : "flat");
        assert_same_pixels(tiled ? &b : &a, &f->parts[i]);
    }
    assert_true(f->parts[0].tiled != f->parts[1].tiled);
    exrio_file_close(f);
    free_image(&a);
    free_image(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tiled),     cmocka_unit_test(test_pxr24_and_b44),          cmocka_unit_test(test_dwa),
        cmocka_unit_test(test_htj2k),     cmocka_unit_test(test_dwa_without_the_module), cmocka_unit_test(test_line_orders),
        cmocka_unit_test(test_multipart),
    };
    return cmocka_run_group_tests(tests, set_up, remove_scratch);
}
