// Which names the channels of several files get, and that each part keeps the attributes of its own file.
#include "exrio_support.h"

static const float pixels[4] = {1, 2, 3, 4};

static const char *write_file(const char *name, const char *channels)
{
    static char names[8][16];
    const char *path = in_scratch(name);
    exrio_out_channel list[8];
    exrio_out_attr who = {.name = "who", .kind = EXRIO_OUT_STRING, .string = name};
    exrio_out_part part = {.data_window = {0, 0, 1, 1}, .display_window = {0, 0, 1, 1}, .pixel_aspect = 1, .attributes = &who};
    part.attribute_count = 1, part.channels = list, part.compression = 3;
    error e = {0};
    for (const char *p = channels; *p;) {
        size_t n = strcspn(p, ",");
        snprintf(names[part.channel_count], sizeof names[0], "%.*s", (int)n, p);
        list[part.channel_count] = (exrio_out_channel){names[part.channel_count], SAMPLE_FLOAT, pixels};
        part.channel_count++;
        p += n + (p[n] == ',');
    }
    assert_ok(exrio_write(path, &part, 1, 1, &e), e);
    return path;
}

// The channels of all parts, one space between.
static void expect(const char *const *paths, int count, const char *wanted)
{
    exrio_file *f;
    error e = {0};
    char got[512] = "";
    assert_ok(exrio_file_open_all(paths, count, &f, &e), e);
    for (int p = 0; p < f->part_count; p++)
        for (int c = 0; c < f->parts[p].channel_count; c++) {
            f->parts[p].channels[c].wanted = true;
            snprintf(got + strlen(got), sizeof got - strlen(got), "%s ", f->parts[p].channels[c].name);
        }
    assert_string_equal(got, wanted);
    assert_ok(exrio_file_load(f, 2, &e), e);
    for (int p = 0; p < f->part_count; p++) {
        const char *who = NULL, *slash = strrchr(paths[p], '/');
        assert_true(exrio_attr_string(f, p, "who", &who));
        assert_string_equal(who, slash + 1);
        for (int c = 0; c < f->parts[p].channel_count; c++)
            assert_memory_equal(f->parts[p].channels[c].data, pixels, sizeof pixels);
    }
    exrio_file_close(f);
}

static void passes_are_named_after_their_files(void **state)
{
    (void)state;
    const char *shot[] = {write_file("shot_P.0001.exr", "B,G,R"), write_file("shot_N.0001.exr", "X,Y,Z"),
                          write_file("shot_Z.0001.exr", "Z"), write_file("shot.0001.exr", "A,B,G,R")};
    expect(shot, 4, "P.B P.G P.R N.X N.Y N.Z Z.Z A B G R ");
    const char *bare[] = {write_file("P.exr", "X,Y,Z"), write_file("Pz.exr", "Y"), write_file("beauty.exr", "R")};
    expect(bare, 3, "P.X P.Y P.Z Pz.Y R ");
    // Names that have a layer stay.
    const char *named[] = {write_file("a.P.12.exr", "P.X,P.Y,P.Z"), write_file("a.N.12.exr", "N.X,id")};
    expect(named, 2, "P.X P.Y P.Z N.X N.id ");
    const char *one[] = {write_file("only_P.exr", "R")};
    expect(one, 1, "R ");
}

static void duplicates_and_missing_files_are_errors(void **state)
{
    (void)state;
    exrio_file *f;
    error e = {0};
    const char *twice[] = {write_file("x_P.exr", "P.X"), write_file("x_Q.exr", "P.X")};
    assert_false(exrio_file_open_all(twice, 2, &f, &e));
    assert_null(f);
    assert_int_equal(e.code, ERR_INPUT);
    assert_string_equal(e.channel, "P.X");
    assert_non_null(strstr(e.file, "x_Q.exr"));
    assert_non_null(strstr(e.message, "x_P.exr"));
    const char *missing[] = {twice[0], "/nonexistent/y.exr"};
    e = (error){0};
    assert_false(exrio_file_open_all(missing, 2, &f, &e));
    assert_non_null(strstr(e.file, "y.exr"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(passes_are_named_after_their_files),
        cmocka_unit_test(duplicates_and_missing_files_are_errors),
    };
    return cmocka_run_group_tests(tests, make_scratch, remove_scratch);
}
