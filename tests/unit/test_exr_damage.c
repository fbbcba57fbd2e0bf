// Damaged, truncated and hostile files: an error with a sentence, no crash, nothing printed, no half-read pixels.
#include <fcntl.h>

#include <openexr.h>

#include "exrio_raw.h"

static const int kinds[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,   EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                            EXR_COMPRESSION_PIZ,  EXR_COMPRESSION_PXR24, EXR_COMPRESSION_B44,  EXR_COMPRESSION_B44A};
enum { KINDS = sizeof kinds / sizeof *kinds };

// Opens and loads everything. True if both succeed; otherwise *e says why.
static bool read_all(const char *path, error *e)
{
    exrio_file *f = NULL;
    *e = (error){0};
    if (!exrio_file_open(path, &f, e)) {
        assert_null(f);
        return false;
    }
    for (int p = 0; p < f->part_count; p++)
        for (int c = 0; c < f->parts[p].channel_count; c++) f->parts[p].channels[c].wanted = true;
    bool ok = exrio_file_load(f, 2, e);
    for (int p = 0; p < f->part_count; p++)
        for (int c = 0; c < f->parts[p].channel_count; c++) assert_true(ok == (f->parts[p].channels[c].data != NULL));
    exrio_file_close(f);
    return ok;
}

static uint8_t *small_file(int kind, size_t *size)
{
    image im;
    error e = {0};
    make_image(&im, 7, 5, kind, kind == EXR_COMPRESSION_NONE);
    assert_ok(exrio_write(in_scratch("small.exr"), &im.part, 1, 1, &e), e);
    free_image(&im);
    return slurp(in_scratch("small.exr"), size);
}

// stdout and stderr go to a file meanwhile; the library prints by default.
static int saved[2];

static void mute(void)
{
    int to = open(in_scratch("printed"), O_RDWR | O_CREAT | O_TRUNC, 0600);
    fflush(stdout);
    for (int i = 0; i < 2; i++) {
        saved[i] = dup(i + 1);
        dup2(to, i + 1);
    }
    close(to);
}

static void unmute_and_check(void)
{
    size_t size;
    fflush(stdout);
    for (int i = 0; i < 2; i++) {
        dup2(saved[i], i + 1);
        close(saved[i]);
    }
    test_free(slurp(in_scratch("printed"), &size));
    assert_int_equal(size, 0);
}

static void test_every_truncation(void **state)
{
    (void)state;
    for (int k = 0; k < KINDS; k++) {
        size_t size, survived = 0, unclear = 0;
        error e;
        uint8_t *bytes = small_file(kinds[k], &size);
        assert_true(read_all(in_scratch("small.exr"), &e));
        mute();
        for (size_t n = 0; n < size; n++) {
            spill(in_scratch("cut.exr"), bytes, n);
            survived += read_all(in_scratch("cut.exr"), &e);
            unclear += e.code != ERR_INPUT || !e.message[0] || strcmp(e.file, in_scratch("cut.exr")) != 0;
            if (n >= 8) unclear += !strstr(e.message, "truncated");
        }
        unmute_and_check();
        assert_int_equal(survived, 0);
        assert_int_equal(unclear, 0);
        test_free(bytes);
    }
}

static void test_every_damaged_byte(void **state)
{
    (void)state;
    static const uint8_t flips[] = {0x01, 0x80, 0xff, 0x40, 0x10};
    for (int k = 0; k < KINDS; k++) {
        size_t size, untold = 0;
        uint8_t *bytes = small_file(kinds[k], &size);
        mute();
        for (size_t n = 0; n < size; n++)
            for (size_t i = 0; i < sizeof flips; i++) {
                error e;
                bytes[n] ^= flips[i];
                spill(in_scratch("bad.exr"), bytes, size);
                if (!read_all(in_scratch("bad.exr"), &e)) untold += !e.message[0];
                bytes[n] ^= flips[i];
            }
        unmute_and_check();
        assert_int_equal(untold, 0);
        test_free(bytes);
    }
}

// Many bytes at once, in the pixels: what a decoder meets.
static void test_damaged_chunks(void **state)
{
    (void)state;
    uint32_t r = 1;
    for (int k = 0; k < KINDS; k++) {
        image im;
        error e = {0};
        size_t size;
        make_image(&im, 60, 64, kinds[k], false);
        assert_ok(exrio_write(in_scratch("c.exr"), &im.part, 1, 1, &e), e);
        uint8_t *good = slurp(in_scratch("c.exr"), &size), *bad = test_malloc(size);
        mute();
        for (int round = 0; round < 60; round++) {
            memcpy(bad, good, size);
            for (int i = 0; i < 1 + round / 4; i++) {
                r = r * 1664525u + 1013904223u;
                bad[size / 2 + (r >> 8) % (size - size / 2)] = (uint8_t)(r >> 4);
            }
            spill(in_scratch("c.exr"), bad, size);
            read_all(in_scratch("c.exr"), &e);
        }
        unmute_and_check();
        test_free(good);
        test_free(bad);
        free_image(&im);
    }
}

// --- headers put together by hand ---

static raw_file raw;

static void expect_refusal(const char *words)
{
    error e;
    raw_save(&raw, in_scratch("raw.exr"));
    mute();
    bool ok = read_all(in_scratch("raw.exr"), &e);
    unmute_and_check();
    assert_false(ok);
    assert_int_equal(e.code, ERR_INPUT);
    if (!strstr(e.message, words)) print_error("'%s' does not say '%s'\n", e.message, words);
    assert_non_null(strstr(e.message, words));
}

static void test_a_plain_header_is_read(void **state)
{
    (void)state;
    error e;
    raw_start(&raw, 0);
    raw_channels(&raw, "Y", 1, 1);
    raw_required(&raw, 0, 0, 0);
    raw_finish(&raw);
    raw_save(&raw, in_scratch("raw.exr"));
    assert_true(read_all(in_scratch("raw.exr"), &e));
    exrio_file *f = open_all(in_scratch("raw.exr"), 1);
    assert_int_equal(*(uint16_t *)f->parts[0].channels[0].data, 0x3c00);
    exrio_file_close(f);
}

static void test_not_an_exr(void **state)
{
    (void)state;
    error e;
    spill(in_scratch("text.exr"), "This is not a picture at all.", 29);
    assert_false(read_all(in_scratch("text.exr"), &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_string_equal(e.message, "is not an OpenEXR file");
    spill(in_scratch("text.exr"), "", 0);
    assert_false(read_all(in_scratch("text.exr"), &e));
    assert_string_equal(e.message, "is not an OpenEXR file");
    assert_false(read_all(in_scratch("missing.exr"), &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_non_null(strstr(e.message, "does not exist"));
    assert_string_equal(e.file, in_scratch("missing.exr"));
    assert_false(read_all(scratch_folder, &e));
    assert_non_null(strstr(e.message, "not a regular file"));
}

static void put_header(uint32_t flags, int32_t x1, int32_t y1)
{
    raw_start(&raw, flags);
    raw_channels(&raw, "Y", 1, 1);
    raw_required(&raw, 3, x1, y1);
    raw_finish(&raw);
}

static void test_hostile_sizes(void **state)
{
    (void)state;
    put_header(0, 99999999, 0);
    expect_refusal("too large");
    put_header(0, 0, 99999999);
    expect_refusal("too large");
    put_header(0, 65535, 65535); // each side allowed, not the product
    expect_refusal("65536 x 65536");
    put_header(0, -2, 0);
    expect_refusal("window");
    put_header(0, 16383, 16383); // allowed, but the file is a few hundred bytes: refused before pixels are allocated
    expect_refusal("truncated");
    raw_start(&raw, 0);
    raw_channels(&raw, "Y", 1, 1);
    raw_required(&raw, 9, 65535, 4095);
    raw_attribute(&raw, "tiles", "tiledesc", "\377\377\377\177\377\377\377\177\0", 9);
    raw_put(&raw, "", 1);
    raw.bytes[5] |= 2; // tiled
    expect_refusal("tile");
    put_header(0, 7, 0);
    memcpy((char *)memmem(raw.bytes, raw.size, "dataWindow", 10) + 11, "box2j", 5); // now of an unknown type
    expect_refusal("required");
}

static void test_hostile_names(void **state)
{
    (void)state;
    char name[400];
    memset(name, 'n', sizeof name);
    name[300] = '\0';
    raw_start(&raw, 0x400);
    raw_attribute(&raw, name, "string", "x", 1);
    expect_refusal("255");
    raw_start(&raw, 0x400);
    raw_attribute(&raw, "a", name, "x", 1);
    expect_refusal("255");
    raw_start(&raw, 0x400);
    raw_channels(&raw, name, 1, 1);
    expect_refusal("255");
}

static void test_hostile_attributes(void **state)
{
    (void)state;
    raw_start(&raw, 0);
    raw_put(&raw, "x\0string\0\xff\xff\xff\xff", 13); // -1 bytes
    expect_refusal("truncated");
    raw_start(&raw, 0);
    raw_attribute(&raw, "x", "m44f", "1234", 4);
    expect_refusal("'x'");
    raw_start(&raw, 0);
    raw_attribute(&raw, "channels", "chlist", "Y\0\1\0\0\0", 6); // ends within a channel
    raw_required(&raw, 0, 0, 0);
    raw_finish(&raw);
    expect_refusal("channel list");
    raw_start(&raw, 0);
    raw_required(&raw, 0, 0, 0);
    raw_finish(&raw);
    expect_refusal("'channels' is missing");
    raw_start(&raw, 0);
    raw_attribute(&raw, "channels", "chlist", "", 1);
    raw_required(&raw, 0, 0, 0);
    raw_finish(&raw);
    expect_refusal("");
    raw_start(&raw, 0);
    raw_channels(&raw, "Y", 3, 1); // no such pixel type
    raw_required(&raw, 0, 0, 0);
    raw_finish(&raw);
    expect_refusal("");
    raw_start(&raw, 0);
    raw_put(&raw, "", 1);
    expect_refusal("empty");
    raw_start(&raw, 0x1000); // several parts, but none
    raw_put(&raw, "", 1);
    expect_refusal("no parts");
}

static void test_too_many(void **state)
{
    (void)state;
    static raw_file list;
    list.size = 0;
    for (int i = 0; i < 700; i++) { // 700 of them fit the buffer; two lists make a file that claims 1400
        char channel[16];
        raw_put(&list, channel, (size_t)snprintf(channel, sizeof channel, "%04d", i) + 1);
        raw_int(&list, 1);
        raw_int(&list, 0);
        raw_int(&list, 1);
        raw_int(&list, 1);
    }
    size_t half = list.size;
    uint8_t *twice = test_malloc(2 * half);
    memcpy(twice, list.bytes, half);
    memcpy(twice + half, list.bytes, half);
    FILE *f = fopen(in_scratch("many.exr"), "wb");
    raw_start(&raw, 0);
    raw_put(&raw, "channels\0chlist", 16);
    raw_int(&raw, (uint32_t)(2 * half));
    fwrite(raw.bytes, 1, raw.size, f);
    fwrite(twice, 1, 2 * half, f);
    fclose(f);
    test_free(twice);
    error e;
    assert_false(read_all(in_scratch("many.exr"), &e));
    assert_non_null(strstr(e.message, "more than 1024 channels"));
}

static void test_deep_and_subsampled(void **state)
{
    (void)state;
    put_header(0x800, 0, 0);
    expect_refusal("deep");
    raw_start(&raw, 0);
    raw_attribute(&raw, "type", "string", "deepscanline", 12);
    expect_refusal("deep");
    raw_start(&raw, 0);
    raw_channels(&raw, "Y", 1, 2);
    raw_required(&raw, 0, 1, 1);
    raw_finish(&raw);
    expect_refusal("subsampled");
    put_header(0x10000, 0, 0);
    expect_refusal("unknown version");
}

// A chunk shorter than its pixels must not leave memory as it was found.
static void test_short_uncompressed_chunk(void **state)
{
    (void)state;
    raw_start(&raw, 0);
    raw_channels(&raw, "Y", 1, 1);
    raw_required(&raw, 0, 0, 0);
    raw_finish(&raw);
    raw.bytes[raw.size - 6] = 1; // one byte instead of two
    expect_refusal("damaged");
}

// A writer that died leaves an empty chunk table; guessing where the chunks are would pass half a picture off as a whole one.
static void test_empty_chunk_table(void **state)
{
    (void)state;
    raw_start(&raw, 0);
    raw_channels(&raw, "Y", 1, 1);
    raw_required(&raw, 0, 0, 0);
    raw_finish(&raw);
    memset(raw.bytes + raw.size - 18, 0, 8);
    raw.size--; // a whole chunk would be found without the table: test_exr_tables.c
    expect_refusal("truncated");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_truncation),
        cmocka_unit_test(test_every_damaged_byte),
        cmocka_unit_test(test_damaged_chunks),
        cmocka_unit_test(test_a_plain_header_is_read),
        cmocka_unit_test(test_not_an_exr),
        cmocka_unit_test(test_hostile_sizes),
        cmocka_unit_test(test_hostile_names),
        cmocka_unit_test(test_hostile_attributes),
        cmocka_unit_test(test_too_many),
        cmocka_unit_test(test_deep_and_subsampled),
        cmocka_unit_test(test_short_uncompressed_chunk),
        cmocka_unit_test(test_empty_chunk_table),
    };
    return cmocka_run_group_tests(tests, make_scratch, remove_scratch);
}
