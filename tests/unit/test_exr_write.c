// Attributes pass through, ours replace; a file appears whole or not at all; other programs read it.
#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <openexr.h>

#include "exrio_raw.h"

static const exr_attribute_t *attribute(const exrio_file *f, int part, const char *name)
{
    const exr_attribute_t *a = NULL;
    return exr_get_attribute_by_name(f->core, part, name, &a) == EXR_ERR_SUCCESS ? a : NULL;
}

static void write_copy(const exrio_file *in, const exrio_out_attr *ours, int count, const char *to)
{
    error e = {0};
    image im;
    make_image(&im, 8, 8, EXR_COMPRESSION_ZIP, false);
    im.part.attributes_from = in;
    im.part.attributes = ours;
    im.part.attribute_count = count;
    assert_ok(exrio_write(to, &im.part, 1, 2, &e), e);
    free_image(&im);
}

// An input with a tiled file's leftovers, types the library does not know, strings with zero bytes, vectors, a preview.
static void put_odd_attributes(raw_file *r)
{
    const float chroma[8] = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
    float matrix[16];
    for (int i = 0; i < 16; i++) matrix[i] = (float)i + 0.5f;
    raw_attribute(r, "BlenderMultiChannel", "string", "Blender V2.55.1 and newer", 25);
    raw_attribute(r, "cryptomatte/abc1234/name", "string", "ViewLayer.CryptoObject", 22);
    raw_attribute(r, "cryptomatte/abc1234/manifest", "string", "{\"a\":\"00\"}", 10);
    raw_attribute(r, "an attribute whose name is longer than 31 bytes", "string", "long", 4);
    raw_attribute(r, "chromaticities", "chromaticities", chroma, sizeof chroma);
    raw_attribute(r, "worldToCamera", "m44f", matrix, sizeof matrix);
    raw_attribute(r, "vendor", "vendorType", "\1\2\3\0\4", 5);
    raw_attribute(r, "vendorEmpty", "vendorType", "", 0);
    raw_attribute(r, "zeros", "string", "a\0b", 3);
    raw_attribute(r, "empty", "string", "", 0);
    raw_attribute(r, "floats", "floatvector", chroma, 12);
    raw_attribute(r, "strings", "stringvector", "\2\0\0\0hi\0\0\0\0\1\0\0\0!", 15);
    raw_attribute(r, "preview", "preview", "\1\0\0\0\1\0\0\0\x10\x20\x30\x40", 12);
    raw_attribute(r, "view", "string", "left", 4);
    raw_attribute(r, "name", "string", "old name", 8);
    raw_attribute(r, "tiles", "tiledesc", "\x40\0\0\0\x40\0\0\0\0", 9);
    raw_attribute(r, "count", "int", "\7\0\0\0", 4);
}

static exrio_file *open_odd(const char *path)
{
    static raw_file r;
    raw_start(&r, 0x400);
    raw_channels(&r, "Y", 1, 1);
    raw_required(&r, 0, 0, 0);
    put_odd_attributes(&r);
    raw_finish(&r);
    raw_save(&r, path);
    exrio_file *f = NULL;
    error e = {0};
    assert_ok(exrio_file_open(path, &f, &e), e);
    return f;
}

static void test_attributes_pass_through(void **state)
{
    (void)state;
    exrio_file *in = open_odd(in_scratch("odd.exr"));
    write_copy(in, NULL, 0, in_scratch("copy.exr"));
    exrio_file *out = open_all(in_scratch("copy.exr"), 1);
    const char *s = NULL;
    double m[4][4], xy[8], v;
    assert_true(exrio_attr_string(out, 0, "BlenderMultiChannel", &s) && strcmp(s, "Blender V2.55.1 and newer") == 0);
    assert_true(exrio_attr_string(out, 0, "cryptomatte/abc1234/manifest", &s) && strcmp(s, "{\"a\":\"00\"}") == 0);
    assert_true(exrio_attr_string(out, 0, "an attribute whose name is longer than 31 bytes", &s) && strcmp(s, "long") == 0);
    assert_true(exrio_attr_string(out, 0, "empty", &s) && !s[0]);
    assert_true(exrio_attr_m44(out, 0, "worldToCamera", m) && m[0][1] == 1.5 && m[3][0] == 12.5);
    assert_true(exrio_attr_chromaticities(out, 0, xy) && xy[0] == (double)0.64f && xy[7] == (double)0.329f);
    assert_true(exrio_attr_float(out, 0, "count", &v) && v == 7);
    assert_int_equal(attribute(out, 0, "zeros")->string->length, 3);
    assert_memory_equal(attribute(out, 0, "zeros")->string->str, "a\0b", 3);
    assert_string_equal(attribute(out, 0, "vendor")->type_name, "vendorType");
    assert_int_equal(attribute(out, 0, "vendor")->opaque->size, 5);
    assert_memory_equal(attribute(out, 0, "vendor")->opaque->packed_data, "\1\2\3\0\4", 5);
    assert_int_equal(attribute(out, 0, "vendorEmpty")->opaque->size, 0);
    assert_int_equal(attribute(out, 0, "floats")->floatvector->length, 3);
    assert_int_equal(attribute(out, 0, "strings")->stringvector->n_strings, 3);
    assert_string_equal(attribute(out, 0, "strings")->stringvector->strings[2].str, "!");
    assert_int_equal(attribute(out, 0, "preview")->preview->rgba[3], 0x40);
    // Structural ones are the writer's.
    assert_false(exrio_attr_exists(out, 0, "tiles"));
    assert_false(exrio_attr_exists(out, 0, "name"));
    assert_false(exrio_attr_exists(out, 0, "view"));
    assert_false(out->parts[0].tiled);
    // And asking for what is not there, or of another type, is no error.
    assert_false(exrio_attr_string(out, 0, "count", &s) || exrio_attr_string(out, 0, "none", &s));
    assert_false(exrio_attr_m44(out, 0, "count", m) || exrio_attr_v2(out, 0, "count", &m[0][0]) ||
                 exrio_attr_float(out, 0, "empty", &v));
    exrio_file_close(out);
    exrio_file_close(in);
}

static void test_ours_replace(void **state)
{
    (void)state;
    exrio_file *in = open_odd(in_scratch("odd.exr"));
    exrio_out_attr ours[] = {{.name = "count", .kind = EXRIO_OUT_STRING, .string = "seven"},
                             {.name = "ssdo/version", .kind = EXRIO_OUT_STRING, .string = "1.0"},
                             {.name = "ssdo/radius", .kind = EXRIO_OUT_FLOAT, .number = 0.25},
                             {.name = "worldToCamera", .kind = EXRIO_OUT_M44, .m44 = {{1}, {0, 2}, {0, 0, 3}, {4, 5, 6, 1}}}};
    write_copy(in, ours, 4, in_scratch("ours.exr"));
    exrio_file_close(in);
    exrio_file *out = open_all(in_scratch("ours.exr"), 1);
    const char *s = NULL;
    double m[4][4], v;
    assert_true(exrio_attr_string(out, 0, "count", &s) && strcmp(s, "seven") == 0);
    assert_true(exrio_attr_float(out, 0, "ssdo/radius", &v) && v == 0.25);
    assert_true(exrio_attr_m44(out, 0, "worldToCamera", m) && m[1][1] == 2 && m[3][2] == 6);
    exrio_file_close(out);
}

static uint32_t version_field(const char *path)
{
    size_t size;
    uint8_t *bytes = slurp(path, &size);
    uint32_t v;
    memcpy(&v, bytes + 4, sizeof v);
    test_free(bytes);
    return v;
}

static void test_long_names_are_flagged_only_when_there(void **state)
{
    (void)state;
    error e = {0};
    image im;
    make_image(&im, 4, 4, EXR_COMPRESSION_ZIP, false);
    assert_ok(exrio_write(in_scratch("s.exr"), &im.part, 1, 1, &e), e);
    assert_int_equal(version_field(in_scratch("s.exr")), 2);
    im.channels[0].name = "a layer with a very long name.Combined.R";
    assert_ok(exrio_write(in_scratch("s.exr"), &im.part, 1, 1, &e), e);
    assert_int_equal(version_field(in_scratch("s.exr")), 0x402);
    exrio_file *f = open_all(in_scratch("s.exr"), 1);
    assert_same_pixels(&im, &f->parts[0]);
    exrio_file_close(f);
    free_image(&im);
}

static void test_parts(void **state)
{
    (void)state;
    error e = {0};
    image a, b;
    make_image(&a, 40, 50, EXR_COMPRESSION_ZIP, true);
    make_image(&b, 40, 50, EXR_COMPRESSION_PIZ, false);
    exrio_out_part parts[2] = {a.part, b.part};
    parts[0].name = "one";
    parts[1].name = "two";
    parts[1].view = "right";
    assert_ok(exrio_write(in_scratch("m.exr"), parts, 2, 3, &e), e);
    exrio_file *f = open_all(in_scratch("m.exr"), 2);
    assert_int_equal(f->part_count, 2);
    assert_string_equal(f->parts[0].name, "one");
    assert_string_equal(f->parts[0].view, "");
    assert_string_equal(f->parts[1].view, "right");
    assert_same_pixels(&a, &f->parts[0]);
    assert_same_pixels(&b, &f->parts[1]);
    exrio_file_close(f);
    parts[1].name = "one";
    assert_false(exrio_write(in_scratch("m.exr"), parts, 2, 1, &e));
    assert_int_equal(e.code, ERR_OUTPUT);
    e = (error){0};
    parts[1].name = NULL;
    assert_false(exrio_write(in_scratch("m.exr"), parts, 2, 1, &e));
    assert_int_equal(e.code, ERR_OUTPUT);
    free_image(&a);
    free_image(&b);
}

// --- whole or not at all ---

static int files_in_scratch(void)
{
    int n = 0;
    DIR *d = opendir(scratch_folder);
    for (struct dirent *entry; (entry = readdir(d));) n += strcmp(entry->d_name, ".") && strcmp(entry->d_name, "..");
    closedir(d);
    return n;
}

static void test_refusals_leave_the_target(void **state)
{
    (void)state;
    image im;
    make_image(&im, 20, 20, EXR_COMPRESSION_ZIP, false);
    spill(in_scratch("target.exr"), "precious", 8);
    int before = files_in_scratch();
    for (int i = 0; i < 4; i++) {
        error e = {0};
        exrio_out_part p = im.part;
        exrio_out_channel channels[7];
        memcpy(channels, im.channels, sizeof channels);
        p.channels = channels;
        if (i == 0) channels[3].name = "R";
        if (i == 1) p.compression = EXR_COMPRESSION_DWAA;
        if (i == 2) p.channel_count = 0;
        if (i == 3) p.data_window.x1 = p.data_window.x0 - 1;
        assert_false(exrio_write(in_scratch("target.exr"), &p, 1, 2, &e));
        assert_int_equal(e.code, ERR_OUTPUT);
        if (i == 0) assert_string_equal(e.channel, "R");
    }
    assert_int_equal(files_in_scratch(), before);
    size_t size;
    uint8_t *bytes = slurp(in_scratch("target.exr"), &size);
    assert_string_equal((char *)bytes, "precious");
    test_free(bytes);
    free_image(&im);
}

// A disk that fills up in the middle, played by a limit on the size of files.
static void test_full_disk(void **state)
{
    (void)state;
    error e = {0};
    image im;
    make_image(&im, 200, 200, EXR_COMPRESSION_NONE, true);
    spill(in_scratch("full.exr"), "precious", 8);
    int before = files_in_scratch();
    struct rlimit old, small;
    getrlimit(RLIMIT_FSIZE, &old);
    small = (struct rlimit){100000, old.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    bool ok = exrio_write(in_scratch("full.exr"), &im.part, 1, 4, &e);
    setrlimit(RLIMIT_FSIZE, &old);
    assert_false(ok);
    assert_int_equal(e.code, ERR_OUTPUT);
    assert_non_null(strstr(e.message, strerror(EFBIG)));
    assert_int_equal(files_in_scratch(), before);
    size_t size;
    uint8_t *bytes = slurp(in_scratch("full.exr"), &size);
    assert_string_equal((char *)bytes, "precious");
    test_free(bytes);
    free_image(&im);
}

static void test_folders(void **state)
{
    (void)state;
    image im;
    make_image(&im, 2, 2, EXR_COMPRESSION_ZIP, false);
    char missing[256];
    snprintf(missing, sizeof missing, "%s/none", scratch_folder);
    for (int i = 0; i < 3; i++) {
        error e = {0};
        const char *path = i == 0 ? in_scratch("none/a.exr") : i == 1 ? "/proc/a.exr" : scratch_folder;
        assert_false(exrio_write(path, &im.part, 1, 1, &e));
        assert_int_equal(e.code, ERR_OUTPUT);
        if (i == 0) assert_non_null(strstr(e.message, missing));
        if (i == 1) assert_non_null(strstr(e.message, "/proc"));
    }
    free_image(&im);
}

// A pipe of our own, never a real device: code that fails this test, run as root, would replace what it was pointed at.
static void test_only_regular_files_are_replaced(void **state)
{
    (void)state;
    error e = {0};
    image im;
    struct stat st;
    make_image(&im, 2, 2, EXR_COMPRESSION_ZIP, false);
    assert_int_equal(mkfifo(in_scratch("pipe"), 0600), 0);
    assert_false(exrio_write(in_scratch("pipe"), &im.part, 1, 1, &e));
    assert_int_equal(e.code, ERR_OUTPUT);
    assert_true(lstat(in_scratch("pipe"), &st) == 0 && S_ISFIFO(st.st_mode));
    free_image(&im);
}

static void test_replacing_keeps_link_and_rights(void **state)
{
    (void)state;
    error e = {0};
    image im;
    struct stat st;
    make_image(&im, 2, 2, EXR_COMPRESSION_ZIP, false);
    spill(in_scratch("real.exr"), "old", 3);
    chmod(in_scratch("real.exr"), 0640);
    assert_int_equal(symlink("real.exr", in_scratch("link.exr")), 0);
    assert_ok(exrio_write(in_scratch("link.exr"), &im.part, 1, 1, &e), e);
    assert_true(lstat(in_scratch("link.exr"), &st) == 0 && S_ISLNK(st.st_mode));
    assert_true(stat(in_scratch("real.exr"), &st) == 0 && (st.st_mode & 0777) == 0640);
    exrio_file *f = open_all(in_scratch("real.exr"), 1);
    assert_same_pixels(&im, &f->parts[0]);
    exrio_file_close(f);
    free_image(&im);
}

// --- other programs ---

// The C++ library decodes our file and stores it without compression, which leaves our reader little to do.
static void test_other_programs_read_it(void **state)
{
    (void)state;
    static const int kinds[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE, EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                                EXR_COMPRESSION_PIZ};
    bool maketiled = have_tool("exrmaketiled"), oiiotool = have_tool("oiiotool"), info = have_tool("exrinfo");
    for (int i = 0; i < 10; i++) {
        error e = {0};
        image im;
        const char *path = in_scratch("o.exr"), *back = in_scratch("b.exr");
        make_image(&im, 77, 65, kinds[i % 5], i < 5);
        assert_ok(exrio_write(path, &im.part, 1, 2, &e), e);
        // By what it prints: that of Ubuntu 24.04 ends with 25 whatever it has read.
        if (info) assert_int_equal(run_command("exrinfo -s '%s' 2>&1 | grep -q \"'normal.X': float\"", path), 0);
        if (oiiotool) assert_int_equal(run_command("oiiotool --hash '%s' >/dev/null 2>&1", path), 0);
        if (maketiled) {
            assert_int_equal(run_command("exrmaketiled -z none '%s' '%s'", path, back), 0);
            exrio_file *f = open_all(back, 1);
            assert_true(f->parts[0].tiled);
            assert_same_pixels(&im, &f->parts[0]);
            exrio_file_close(f);
        }
        free_image(&im);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_attributes_pass_through),
        cmocka_unit_test(test_ours_replace),
        cmocka_unit_test(test_long_names_are_flagged_only_when_there),
        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_refusals_leave_the_target),
        cmocka_unit_test(test_full_disk),
        cmocka_unit_test(test_folders),
        cmocka_unit_test(test_only_regular_files_are_replaced),
        cmocka_unit_test(test_replacing_keeps_link_and_rights),
        cmocka_unit_test(test_other_programs_read_it),
    };
    return cmocka_run_group_tests(tests, make_scratch, remove_scratch);
}
