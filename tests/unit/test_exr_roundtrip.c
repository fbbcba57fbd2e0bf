// What is written comes back bit for bit, for every lossless compression, and is the same file for any number of threads.
#include <openexr.h>

#include "exr/codec.h"
#include "exrio_support.h"

static const int lossless[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE, EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                               EXR_COMPRESSION_PIZ};
enum { LOSSLESS = 5 };

static void test_every_bit_survives(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {37, 1}, {1, 50}, {61, 45}, {130, 33}};
    for (int c = 0; c < LOSSLESS; c++)
        for (int s = 0; s < 5; s++)
            for (int noise = 0; noise < 2; noise++) {
                image im;
                error e = {0};
                make_image(&im, sizes[s][0], sizes[s][1], lossless[c], noise);
                assert_ok(exrio_write(in_scratch("a.exr"), &im.part, 1, 2, &e), e);
                exrio_file *f = open_all(in_scratch("a.exr"), 2);
                assert_int_equal(f->part_count, 1);
                assert_int_equal(f->parts[0].compression, lossless[c]);
                assert_same_pixels(&im, &f->parts[0]);
                exrio_file_close(f);
                free_image(&im);
            }
}

static void test_threads_do_not_matter(void **state)
{
    (void)state;
    for (int c = 0; c < LOSSLESS; c++) {
        image im;
        error e = {0};
        uint8_t *first = NULL;
        size_t size = 0, other_size;
        make_image(&im, 90, 170, lossless[c], true);
        for (int threads = 1; threads <= 4; threads++) {
            assert_ok(exrio_write(in_scratch("t.exr"), &im.part, 1, threads, &e), e);
            exrio_file *f = open_all(in_scratch("t.exr"), threads);
            assert_same_pixels(&im, &f->parts[0]);
            exrio_file_close(f);
            uint8_t *bytes = slurp(in_scratch("t.exr"), &other_size);
            if (!first) {
                first = bytes;
                size = other_size;
                continue;
            }
            assert_int_equal(size, other_size);
            assert_memory_equal(first, bytes, size);
            test_free(bytes);
        }
        test_free(first);
        free_image(&im);
    }
}

static void test_level_changes_size_only(void **state)
{
    (void)state;
    static const int levels[] = {0, 9, 100}; // 100: the highest there is
    image im;
    error e = {0};
    size_t sizes[3];
    make_image(&im, 200, 100, EXR_COMPRESSION_ZIP, false);
    for (int i = 0; i < 3; i++) {
        im.part.level = levels[i];
        assert_ok(exrio_write(in_scratch("l.exr"), &im.part, 1, 2, &e), e);
        test_free(slurp(in_scratch("l.exr"), &sizes[i]));
        exrio_file *f = open_all(in_scratch("l.exr"), 1);
        assert_same_pixels(&im, &f->parts[0]);
        exrio_file_close(f);
    }
    assert_true(sizes[1] < sizes[0] && sizes[2] <= sizes[1]);
    free_image(&im);
}

// A reader takes a chunk for a raw one when its size is that of its pixels. Lines from noise to zeros, a few bytes a step, pass
// through every compressed size, that one included.
static void test_chunks_of_their_own_size(void **state)
{
    (void)state;
    enum { W = 101, H = 400 };
    for (int c = 1; c < LOSSLESS; c++) {
        error e = {0};
        uint16_t *data = make_samples(SAMPLE_HALF, W * H, 9, true);
        for (int y = 0; y < H; y++) memset(data + y * W, 0, (size_t)(y / 8 % 50) * 2);
        exrio_out_channel channel = {"Y", SAMPLE_HALF, data};
        exrio_out_part part = {.data_window = {0, 0, W - 1, H - 1},
                               .display_window = {0, 0, W - 1, H - 1},
                               .pixel_aspect = 1,
                               .compression = lossless[c],
                               .channels = &channel,
                               .channel_count = 1};
        assert_ok(exrio_write(in_scratch("own.exr"), &part, 1, 1, &e), e);
        exrio_file *f = open_all(in_scratch("own.exr"), 1);
        assert_memory_equal(f->parts[0].channels[0].data, data, W * H * 2);
        exrio_file_close(f);
        test_free(data);
    }
}

// The split of the ZIP codec against the format's definition, for lengths around the width of the fast loops.
static void test_split_and_merge(void **state)
{
    (void)state;
    for (size_t n = 1; n < 200; n++) {
        uint8_t *raw = make_samples(SAMPLE_UINT, n, (uint32_t)n, true);
        uint8_t *split = test_malloc(n), *back = test_malloc(n), *scratch = test_malloc(n), *expected = test_malloc(n);
        for (size_t i = 0; i < n; i++) scratch[i % 2 ? (n + 1) / 2 + i / 2 : i / 2] = raw[i];
        for (size_t i = 0; i < n; i++) expected[i] = (uint8_t)(i ? scratch[i] - scratch[i - 1] + 128 : scratch[0]);
        codec_split(raw, split, scratch, n);
        assert_memory_equal(split, expected, n);
        codec_merge(split, back, n);
        assert_memory_equal(back, raw, n);
        test_free(raw);
        test_free(split);
        test_free(back);
        test_free(scratch);
        test_free(expected);
    }
}

// Only what is wanted is loaded, and a second load adds to the first without touching it.
static void test_partial_load(void **state)
{
    (void)state;
    image im;
    error e = {0};
    exrio_file *f = NULL;
    make_image(&im, 61, 45, EXR_COMPRESSION_ZIP, true);
    assert_ok(exrio_write(in_scratch("p.exr"), &im.part, 1, 1, &e), e);
    assert_ok(exrio_file_open(in_scratch("p.exr"), &f, &e), e);
    exrio_channel *z = (exrio_channel *)(uintptr_t)find_channel(&f->parts[0], "Z");
    exrio_channel *g = (exrio_channel *)(uintptr_t)find_channel(&f->parts[0], "a.G");
    z->wanted = true;
    assert_ok(exrio_file_load(f, 2, &e), e);
    assert_non_null(z->data);
    assert_null(g->data);
    const void *before = z->data;
    memset(z->data, 7, 4);
    g->wanted = true;
    assert_ok(exrio_file_load(f, 2, &e), e);
    assert_ptr_equal(z->data, before);
    assert_int_equal(((uint8_t *)z->data)[0], 7);
    assert_memory_equal(g->data, im.channels[2].data, 61 * 45 * 2);
    exrio_file_close(f);
    free_image(&im);
}

static float from_bits(uint32_t b)
{
    float f;
    memcpy(&f, &b, sizeof f);
    return f;
}

static void test_to_half(void **state)
{
    (void)state;
    const float in[] = {0.0f,
                        -0.0f,
                        1.0f,
                        65504.0f,
                        65505.0f,
                        1e30f,
                        -1e30f,
                        from_bits(0x7f800000),
                        from_bits(0xff800000),
                        from_bits(0x7fc00001),
                        from_bits(0xff800001),
                        1e-8f,
                        6e-8f,
                        2049.0f,
                        2051.0f,
                        -65504.0f,
                        0.1f,
                        3.0f};
    const uint16_t expected[] = {0, 0x8000, 0x3c00, 0x7bff, 0x7bff, 0x7bff, 0xfbff, 0x7bff, 0xfbff,
                                 0, 0,      0,      1,      0x6800, 0x6802, 0xfbff, 0x2e66, 0x4200};
    enum { N = sizeof in / sizeof *in };
    uint16_t out[N];
    for (size_t stride = 1; stride <= 4; stride++) {
        float spread[N * 4];
        for (int i = 0; i < N * 4; i++) spread[i] = 1e38f; // must not be read
        for (size_t i = 0; i < N; i++) spread[i * stride] = in[i];
        assert_int_equal(exrio_to_half(spread, stride, N, out), 7);
        assert_memory_equal(out, expected, sizeof expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_bit_survives),
        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_level_changes_size_only),
        cmocka_unit_test(test_chunks_of_their_own_size),
        cmocka_unit_test(test_split_and_merge),
        cmocka_unit_test(test_partial_load),
        cmocka_unit_test(test_to_half),
    };
    return cmocka_run_group_tests(tests, make_scratch, remove_scratch);
}
