// Files whose chunk tables are all zero, as exrmultipart of OpenEXR 3.2 and later leaves them: read as if the tables were there,
// and refused where a chunk is missing, cut or twice there.
#include "exrio_raw.h"

#include <openexr.h>

enum { WIDTH = 9, HEIGHT = 40, LINES = 16 };

// The first entry points behind all the tables, where the first chunk begins.
static size_t find_tables(const uint8_t *bytes, size_t size, size_t entries)
{
    for (size_t at = 8; at + 8 * entries < size; at++) {
        uint64_t first;
        memcpy(&first, bytes + at, sizeof first);
        if (first == at + 8 * entries) return at;
    }
    fail_msg("no chunk table found");
    return 0;
}

static bool reads(const char *path, error *e)
{
    exrio_file *f = NULL;
    *e = (error){0};
    if (!exrio_file_open(path, &f, e)) return false;
    for (int p = 0; p < f->part_count; p++)
        for (int c = 0; c < f->parts[p].channel_count; c++) f->parts[p].channels[c].wanted = true;
    bool ok = exrio_file_load(f, 2, e);
    exrio_file_close(f);
    return ok;
}

static void expect_refused(const uint8_t *bytes, size_t size)
{
    error e;
    spill(in_scratch("refused.exr"), bytes, size);
    assert_false(reads(in_scratch("refused.exr"), &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_non_null(strstr(e.message, "truncated or damaged"));
}

static void expect_same(const char *path, const char *wanted)
{
    exrio_file *a = open_all(path, 2), *b = open_all(wanted, 2);
    assert_int_equal(a->part_count, b->part_count);
    for (int p = 0; p < a->part_count; p++)
        for (int c = 0; c < a->parts[p].channel_count; c++)
            assert_memory_equal(a->parts[p].channels[c].data, b->parts[p].channels[c].data,
                                WIDTH * HEIGHT * sample_size(a->parts[p].channels[c].type));
    exrio_file_close(a);
    exrio_file_close(b);
}

// The file of `entries` chunks, each with a place of `place` bytes, reads the same without its tables, and no damage is
// overlooked.
static void check_without_tables(const char *path, size_t entries, size_t place)
{
    size_t size;
    uint64_t second;
    uint8_t *bytes = slurp(path, &size), *table = bytes + find_tables(bytes, size, entries);
    const uint8_t first_entry = table[0];
    memcpy(&second, table + 8, sizeof second);
    memset(table, 0, 8 * entries);
    spill(in_scratch("zero.exr"), bytes, size);
    expect_same(in_scratch("zero.exr"), path);

    expect_refused(bytes, size - 1);
    // The first chunk says that it is one which does not exist.
    uint8_t *chunk = table + 8 * entries;
    chunk[0] ^= 0x40;
    expect_refused(bytes, size);
    chunk[0] ^= 0x40;
    // A table that only begins with zeros was written to and lost something.
    table[8] = first_entry | 1;
    expect_refused(bytes, size);
    table[8] = 0;
    memcpy(bytes + second, chunk, place); // the first chunk's place is taken twice
    expect_refused(bytes, size);
    test_free(bytes);
}

static void test_scanlines(void **state)
{
    (void)state;
    static const int kinds[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int parts = 1; parts <= 2; parts++) {
            image im;
            error e = {0};
            make_image(&im, WIDTH, HEIGHT, kinds[k], false);
            exrio_out_part both[] = {im.part, im.part};
            both[0].name = "one", both[1].name = "two";
            assert_ok(exrio_write(in_scratch("plain.exr"), both, parts, 1, &e), e);
            int lines = kinds[k] == EXR_COMPRESSION_ZIP ? LINES : 1;
            check_without_tables(in_scratch("plain.exr"), (size_t)(parts * ((HEIGHT + lines - 1) / lines)), parts == 1 ? 4 : 8);
            free_image(&im);
        }
}

static void test_tiles(void **state)
{
    (void)state;
    image im;
    error e = {0};
    if (!have_tool("oiiotool")) skip();
    make_image(&im, WIDTH, HEIGHT, EXR_COMPRESSION_ZIP, false);
    assert_ok(exrio_write(in_scratch("plain.exr"), &im.part, 1, 1, &e), e);
    assert_int_equal(run_command("oiiotool '%s' --tile 16 16 -o '%s'", in_scratch("plain.exr"), in_scratch("tiled.exr")), 0);
    check_without_tables(in_scratch("tiled.exr"), (HEIGHT + LINES - 1) / LINES, 16);
    free_image(&im);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_scanlines, make_scratch, remove_scratch),
        cmocka_unit_test_setup_teardown(test_tiles, make_scratch, remove_scratch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
