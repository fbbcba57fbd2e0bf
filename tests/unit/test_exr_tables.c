// Files whose chunk tables are all zero, as exrmultipart of OpenEXR 3.2 and later leaves them: read as if the tables were there,
// whatever lies in them, and refused where a chunk is missing, cut or twice there.
#include "exrio_raw.h"

#include <openexr.h>

#include "exr/compare.h"
#include "modules.h"

enum { WIDTH = 9, HEIGHT = 40, LINES = 16, TILE = 4 };

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
    for (int p = 0; p < a->part_count; p++) {
        if (a->parts[p].deep) assert_true(exrio_deep_same(a, p, b, p));
        for (int c = 0; !a->parts[p].deep && c < a->parts[p].channel_count; c++)
            assert_memory_equal(a->parts[p].channels[c].data, b->parts[p].channels[c].data,
                                WIDTH * HEIGHT * sample_size(a->parts[p].channels[c].type));
    }
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

// What oiiotool makes of a plain file by these arguments: its number of chunks, and where a chunk says its place.
static void check_converted(const char *arguments, size_t entries, size_t place)
{
    image im;
    error e = {0};
    if (!have_tool("oiiotool")) skip();
    make_image(&im, WIDTH, HEIGHT, EXR_COMPRESSION_ZIP, false);
    assert_ok(exrio_write(in_scratch("plain.exr"), &im.part, 1, 1, &e), e);
    assert_int_equal(run_command("oiiotool '%s' %s -o '%s'", in_scratch("plain.exr"), arguments, in_scratch("converted.exr")), 0);
    check_without_tables(in_scratch("converted.exr"), entries, place);
    free_image(&im);
}

static void test_tiles(void **state)
{
    (void)state;
    check_converted("--tile 16 16", (HEIGHT + LINES - 1) / LINES, 16);
}

// Where a module decodes, it is given the tables too.
static void test_dwa(void **state)
{
    (void)state;
    check_converted("--compression dwaa", (HEIGHT + 31) / 32, 4);
}

// --- parts that exrmultipart joins as they are: deep ones, and tiles of several levels ---

// Byte by byte: the library (3.1.5) numbers the tiles of a ripmap wrongly.
typedef struct joined {
    raw_file head, chunks;
    uint64_t at[256]; // of each chunk in `chunks`
    size_t count;
} joined;

enum { SINGLE, MIPMAP, RIPMAP }; // as the file's tile descriptions say it

// The header of a part of one half channel, WIDTH x HEIGHT, uncompressed; `levels` of tiles alone.
static void put_header(joined *j, const char *name, const char *type, size_t chunks, int levels)
{
    const uint32_t count = (uint32_t)chunks, version = 1;
    raw_channels(&j->head, "Z", 1, 1);
    raw_required(&j->head, EXR_COMPRESSION_NONE, WIDTH - 1, HEIGHT - 1);
    raw_attribute(&j->head, "name", "string", name, strlen(name));
    raw_attribute(&j->head, "type", "string", type, strlen(type));
    raw_attribute(&j->head, "version", "int", &version, sizeof version);
    raw_attribute(&j->head, "chunkCount", "int", &count, sizeof count);
    if (strcmp(type, "tiledimage") == 0) {
        const uint8_t tiles[9] = {TILE, 0, 0, 0, TILE, 0, 0, 0, (uint8_t)levels};
        raw_attribute(&j->head, "tiles", "tiledesc", tiles, sizeof tiles);
    }
    raw_put(&j->head, "", 1);
}

static void begin_chunk(joined *j, uint32_t part)
{
    assert_true(j->count < sizeof j->at / sizeof *j->at);
    j->at[j->count++] = j->chunks.size;
    raw_int(&j->chunks, part);
}

static void put_samples(joined *j, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint16_t v = (uint16_t)(0x3c00 + j->count + i);
        raw_put(&j->chunks, &v, sizeof v);
    }
}

static void put_lines(joined *j, uint32_t part)
{
    for (uint32_t y = 0; y < HEIGHT; y++) {
        begin_chunk(j, part);
        raw_int(&j->chunks, y);
        raw_int(&j->chunks, 2 * WIDTH);
        put_samples(j, WIDTH);
    }
}

// Every pixel of line y has y % 3 samples; the counts are a running sum.
static void put_deep_lines(joined *j, uint32_t part)
{
    for (uint32_t y = 0; y < HEIGHT; y++) {
        const uint64_t sizes[] = {4 * WIDTH, 2 * WIDTH * (y % 3), 2 * WIDTH * (y % 3)};
        begin_chunk(j, part);
        raw_int(&j->chunks, y);
        raw_put(&j->chunks, sizes, sizeof sizes);
        for (uint32_t x = 0; x < WIDTH; x++) raw_int(&j->chunks, y % 3 * (x + 1));
        put_samples(j, WIDTH * (y % 3));
    }
}

static void put_level(joined *j, uint32_t part, uint32_t level_x, uint32_t level_y)
{
    const uint32_t w = WIDTH >> level_x, h = HEIGHT >> level_y; // down to 1 each
    const uint32_t width = w ? w : 1, height = h ? h : 1;
    for (uint32_t y = 0; y < height; y += TILE)
        for (uint32_t x = 0; x < width; x += TILE) {
            const uint32_t columns = width - x < TILE ? width - x : TILE, rows = height - y < TILE ? height - y : TILE;
            const uint32_t leader[] = {x / TILE, y / TILE, level_x, level_y, 2 * columns * rows};
            begin_chunk(j, part);
            raw_put(&j->chunks, leader, sizeof leader);
            put_samples(j, columns * rows);
        }
}

static void put_tiles(joined *j, uint32_t part, int levels)
{
    enum { ACROSS = 4, DOWN = 6 }; // levels of 9 and of 40 pixels, rounded down
    for (uint32_t ly = 0; ly < (levels == SINGLE ? 1 : DOWN); ly++)
        for (uint32_t lx = 0; lx < (levels == SINGLE ? 1 : levels == MIPMAP ? DOWN : ACROSS); lx++)
            if (levels == RIPMAP || lx == ly) put_level(j, part, lx, ly);
}

// A flat part and one of `type`. Returns the number of chunks in all.
static size_t write_beside(const char *path, const char *type, int levels)
{
    joined j = {0};
    const bool deep = strcmp(type, "deepscanline") == 0;
    put_lines(&j, 0);
    if (deep)
        put_deep_lines(&j, 1);
    else
        put_tiles(&j, 1, levels);
    raw_start(&j.head, deep ? 0x1800 : 0x1000);
    put_header(&j, "flat", "scanlineimage", HEIGHT, SINGLE);
    put_header(&j, "other", type, j.count - HEIGHT, levels);
    raw_put(&j.head, "", 1);
    const uint64_t first = j.head.size + 8 * j.count;
    for (size_t i = 0; i < j.count; i++) {
        const uint64_t at = first + j.at[i];
        raw_put(&j.head, &at, sizeof at);
    }
    raw_put(&j.head, j.chunks.bytes, j.chunks.size);
    raw_save(&j.head, path);
    return j.count;
}

static void test_deep(void **state)
{
    (void)state;
    const char *path = in_scratch("deep.exr");
    check_without_tables(path, write_beside(path, "deepscanline", SINGLE), 8);
}

static void test_levels(void **state)
{
    (void)state;
    const char *path = in_scratch("levels.exr");
    for (int levels = SINGLE; levels <= RIPMAP; levels++) check_without_tables(path, write_beside(path, "tiledimage", levels), 8);
}

int main(void)
{
    use_built_modules();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_scanlines, make_scratch, remove_scratch),
        cmocka_unit_test_setup_teardown(test_tiles, make_scratch, remove_scratch),
        cmocka_unit_test_setup_teardown(test_dwa, make_scratch, remove_scratch),
        cmocka_unit_test_setup_teardown(test_deep, make_scratch, remove_scratch),
        cmocka_unit_test_setup_teardown(test_levels, make_scratch, remove_scratch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
