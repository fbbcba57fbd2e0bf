// Files that change while they are read, and pictures that no compression can make shorter. `make check SANITIZE=address` sees
// what is read or written beyond a buffer's end.
#include <openexr.h>
#include <sys/stat.h>

#include "exr/codec.h"
#include "exr/library.h"
#include "exrio_support.h"
#include "modules.h"

static int set_up(void **state)
{
    use_built_modules();
    return make_scratch(state);
}

static void write_picture(const char *path, int width, int height)
{
    image im;
    error e = {0};
    make_image(&im, width, height, EXR_COMPRESSION_ZIP, false);
    assert_ok(exrio_write(path, &im.part, 1, 1, &e), e);
    free_image(&im);
}

// What was looked at is what is read, whatever the name stands for meanwhile. `compress`: makes NAME.exr of the plain
// NAME_zip.exr.
static void check_replaced(const char *compress)
{
    write_picture(in_scratch("a_zip.exr"), 64, 48);
    write_picture(in_scratch("b_zip.exr"), 16, 8);
    for (const char *name = "ab"; *name; name++)
        assert_int_equal(run_command("cd '%s' && %s %c_zip.exr %c.exr", scratch_folder, compress, *name, *name), 0);
    error e = {0};
    exrio_file *f = NULL, *kept = open_all(in_scratch("a.exr"), 1);
    assert_ok(exrio_file_open(in_scratch("a.exr"), &f, &e), e);
    assert_int_equal(rename(in_scratch("b.exr"), in_scratch("a.exr")), 0);
    for (int c = 0; c < f->parts[0].channel_count; c++) f->parts[0].channels[c].wanted = true;
    assert_ok(exrio_file_load(f, 2, &e), e);
    assert_int_equal(box2_width(f->parts[0].data_window), 64);
    for (int c = 0; c < f->parts[0].channel_count; c++)
        assert_memory_equal(f->parts[0].channels[c].data, kept->parts[0].channels[c].data,
                            (size_t)64 * 48 * sample_size(f->parts[0].channels[c].type));
    exrio_file_close(f);
    exrio_file_close(kept);
}

static void test_zip_that_is_replaced(void **state)
{
    (void)state;
    check_replaced("cp");
}

// By the module, where the library does not decode it.
static void test_dwa_that_is_replaced(void **state)
{
    (void)state;
    if (have_tool("exrmaketiled")) check_replaced("exrmaketiled -z dwaa");
}

static void test_no_regular_file(void **state)
{
    (void)state;
    error e = {0};
    exrio_file *f = NULL;
    assert_int_equal(mkfifo(in_scratch("pipe.exr"), 0600), 0);
    assert_false(exrio_file_open(in_scratch("pipe.exr"), &f, &e)); // and does not wait for a writer
    assert_int_equal(e.code, ERR_INPUT);
    assert_non_null(strstr(e.message, "a pipe"));
    e = (error){0};
    assert_false(exrio_file_open("/dev/zero", &f, &e));
    assert_non_null(strstr(e.message, "a device"));
}

// PIZ puts a bitmap of the values and a table in front: where every value is another, a short chunk grows by up to 8 KiB.
static void test_piz_of_noise(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {5, 1}, {64, 33}, {100, 34}, {257, 65}, {700, 3}, {1024, 2}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        image im;
        error e = {0};
        make_image(&im, sizes[i][0], sizes[i][1], EXR_COMPRESSION_PIZ, true);
        for (int threads = 1; threads < 4; threads += 2) {
            assert_ok(exrio_write(in_scratch("piz.exr"), &im.part, 1, threads, &e), e);
            exrio_file *f = open_all(in_scratch("piz.exr"), 1);
            assert_same_pixels(&im, &f->parts[0]);
            exrio_file_close(f);
        }
        free_image(&im);
    }
}

// Stands for a library that takes the room it needs for granted (3.2) or asks whether it is there (3.3).
static exr_result_t take_all_room(exr_encode_pipeline_t *p)
{
    size_t needed = p->packed_bytes + p->packed_bytes / 8 + 65536;
    if (!p->compressed_buffer || p->compressed_alloc_size < needed) return EXR_ERR_OUT_OF_MEMORY;
    memset(p->compressed_buffer, 1, needed);
    p->compressed_bytes = needed;
    return EXR_ERR_SUCCESS;
}

// Whatever the library allocates by itself, PIZ finds room for what it may write.
static void test_room_for_piz(void **state)
{
    (void)state;
    static const uint16_t line[3] = {1, 2, 3};
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t core = NULL;
    exr_chunk_info_t info;
    exr_encode_pipeline_t p;
    codec c = {.level = 1};
    int part;
    assert_int_equal(exr_start_write(&core, in_scratch("room.exr"), EXR_WRITE_FILE_DIRECTLY, &init), EXR_ERR_SUCCESS);
    assert_int_equal(exr_add_part(core, "a", EXR_STORAGE_SCANLINE, &part), EXR_ERR_SUCCESS);
    assert_int_equal(exr_initialize_required_attr_simple(core, part, 3, 1, EXR_COMPRESSION_PIZ), EXR_ERR_SUCCESS);
    assert_int_equal(exr_add_channel(core, part, "Y", EXR_PIXEL_HALF, EXR_PERCEPTUALLY_LINEAR, 1, 1), EXR_ERR_SUCCESS);
    assert_int_equal(exr_write_header(core), EXR_ERR_SUCCESS);
    assert_int_equal(exr_write_scanline_chunk_info(core, part, 0, &info), EXR_ERR_SUCCESS);
    assert_int_equal(exr_encoding_initialize(core, part, &info, &p), EXR_ERR_SUCCESS);
    assert_int_equal(codec_attach_encoder(&c, core, part, &p), EXR_ERR_SUCCESS);
    c.compress_fn = take_all_room;
    p.channels[0].encode_from_ptr = (const uint8_t *)line;
    p.channels[0].user_pixel_stride = 2;
    p.channels[0].user_line_stride = 6;
    assert_int_equal(exr_encoding_run(core, part, &p), EXR_ERR_SUCCESS);
    assert_int_equal(p.compressed_bytes, sizeof line); // what became longer is stored as it is
    exr_encoding_destroy(core, &p);
    codec_free(&c);
    exr_finish(&core);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dwa_that_is_replaced), cmocka_unit_test(test_zip_that_is_replaced),
        cmocka_unit_test(test_piz_of_noise),         cmocka_unit_test(test_room_for_piz),
        cmocka_unit_test(test_no_regular_file),
    };
    return cmocka_run_group_tests(tests, set_up, remove_scratch);
}
