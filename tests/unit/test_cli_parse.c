// The command line: what is accepted, what it means, and what is said about the rest.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/options.h"
#include "cli/options_table.h"
#include "gbuffer/resolve.h"

// Words separated by single spaces, after "ssdo-filter".
static bool parse(const char *line, options *o, error *e)
{
    static char copy[4096]; // options point into it
    char *argv[128] = {"ssdo-filter"};
    int argc = 1;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *p = strtok(copy, " "); p; p = strtok(NULL, " ")) argv[argc++] = p;
    *e = (error){0};
    return options_parse(argc, argv, o, e);
}

static options good(const char *more)
{
    char line[4096];
    options o;
    error e;
    snprintf(line, sizeof line, "in.exr -o out.exr %s", more);
    if (!parse(line, &o, &e)) fail_msg("'%s': %s", line, e.message);
    return o;
}

// The line must be refused as a usage error whose message has both texts.
static void bad(const char *more, const char *says, const char *also)
{
    char line[4096];
    options o;
    error e;
    snprintf(line, sizeof line, "in.exr -o out.exr %s", more);
    if (parse(line, &o, &e)) fail_msg("'%s' was accepted", line);
    assert_int_equal(e.code, ERR_USAGE);
    if (!strstr(e.message, says)) fail_msg("'%s': no '%s' in: %s", line, says, e.message);
    if (!strstr(e.message, also)) fail_msg("'%s': no '%s' in: %s", line, also, e.message);
}

static void defaults_are_the_documented_ones(void **state)
{
    (void)state;
    options o = good("");
    assert_int_equal(o.input_count, 1);
    assert_string_equal(o.inputs[0], "in.exr");
    assert_string_equal(o.output, "out.exr");
    assert_null(o.layers);
    assert_string_equal(o.method, "arc");
    assert_int_equal(o.radius_unit, RADIUS_AUTO);
    assert_true(o.thickness < 0 && o.env_lod < 0);
    assert_int_equal(o.blur, -1);
    assert_int_equal(o.device, -1);
    assert_true(o.scale == 1 && o.contrast == 1 && o.bounce_strength == 1 && o.env_scale == 1 && o.amount == 1);
    assert_int_equal(o.env_up, 0);
    assert_int_equal(o.env_frame, FRAME_WORLD);
    assert_string_equal(o.prefix, "");
    assert_false(o.keep_none || o.output_float || o.verbose || o.quiet || o.help || o.version || o.list_devices);
}

static void both_forms_of_a_value(void **state)
{
    (void)state;
    assert_int_equal(good("--samples 64").samples, 64);
    assert_int_equal(good("--samples=64").samples, 64);
    assert_int_equal(good("--samples 64 --samples=8").samples, 8); // the last one counts
    assert_string_equal(good("--prefix=").prefix, "");
    assert_string_equal(good("--layers=a=b").layers, "a=b");
    assert_true(good("--env-rotate -30").env_rotate == -30);
}

static void short_options(void **state)
{
    (void)state;
    options o;
    error e;
    assert_true(parse("-v -oout.exr in.exr", &o, &e));
    assert_true(o.verbose);
    assert_string_equal(o.output, "out.exr");
    assert_true(parse("-vo out.exr in.exr", &o, &e));
    assert_string_equal(o.output, "out.exr");
    assert_true(parse("-q in.exr --output=x.exr", &o, &e));
    assert_true(o.quiet);
    assert_true(parse("-h", &o, &e));
    assert_true(o.help);
    assert_true(parse("--version", &o, &e));
    assert_true(o.version);
    assert_true(parse("--list-devices", &o, &e));
    assert_true(o.list_devices);
    assert_true(parse("-o out.exr -- -v --in.exr", &o, &e));
    assert_false(o.verbose);
    assert_int_equal(o.input_count, 2);
    assert_string_equal(o.inputs[1], "--in.exr");
}

// A preset fills in what is not given, wherever the rest stands on the line.
static void presets_are_defaults(void **state)
{
    (void)state;
    options o = good("--preset scene");
    assert_string_equal(o.method, "alchemy");
    assert_true(o.radius_unit == RADIUS_WORLD && o.radius == 0.05 && o.scale == 2.0 && o.contrast == 3.0);
    o = good("--preset=closeup");
    assert_true(o.radius_unit == RADIUS_WORLD && o.radius == 0.08 && o.scale == 1.7 && o.contrast == 2.2);
    o = good("--scale 1 --method ssdo --preset scene --radius auto");
    assert_string_equal(o.method, "ssdo");
    assert_true(o.radius_unit == RADIUS_AUTO && o.scale == 1.0 && o.contrast == 3.0);
    assert_int_equal(o.input_count, good("").input_count);
    error e = {0};
    char *record = options_record(&o, &e);
    assert_non_null(record); // what counts is recorded, not the preset
    assert_null(strstr(record, "preset"));
    assert_non_null(strstr(record, "--contrast 3"));
    free(record);
}

static void radius_in_three_forms(void **state)
{
    (void)state;
    options o = good("--radius 0.25");
    assert_true(o.radius_unit == RADIUS_WORLD && o.radius == 0.25);
    o = good("--radius=40px");
    assert_true(o.radius_unit == RADIUS_PIXELS && o.radius == 40);
    o = good("--radius 1e-3px");
    assert_true(o.radius_unit == RADIUS_PIXELS && o.radius == 1e-3);
    o = good("--radius 3 --radius auto");
    assert_true(o.radius_unit == RADIUS_AUTO);
    const char *const wrong[] = {"0", "-1", "px", "40p", "40pxx", "nan", "inf", "0,25", "1e999", "automatic"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char line[64];
        snprintf(line, sizeof line, "--radius=%s", wrong[i]);
        bad(line, "--radius must be auto", wrong[i]);
    }
}

static void words_for_values(void **state)
{
    (void)state;
    assert_true(good("--thickness auto").thickness < 0);
    assert_true(isinf(good("--thickness inf").thickness));
    assert_true(good("--thickness 0.5").thickness == 0.5);
    assert_true(good("").outside < 0 && good("--outside auto").outside < 0);
    assert_true(good("--outside open").outside == 1 && good("--outside closed").outside == OUTSIDE_COVERED);
    assert_int_equal(good("--blur none").blur, 0);
    assert_int_equal(good("--blur 3").blur, 3);
    assert_int_equal(good("--env-up y").env_up, 'y');
    assert_int_equal(good("--env-up z").env_up, 'z');
    assert_int_equal(good("--mode visibility").mode, MODE_VISIBILITY);
    assert_true(good("--keep none").keep_none);
    assert_false(good("--keep none --keep all").keep_none);
    assert_string_equal(good("--bounce none").bounce, "none");
    assert_true(good("--env-lod auto").env_lod < 0);
    assert_true(good("--float").output_float);
}

static double field_of(const option_row *row, const options *o)
{
    const void *field = (const char *)o + row->offset;
    return row->kind == OPT_SWITCH ? *(const bool *)field : *(const int *)field;
}

// Each word of each option is read as its value, and that value is recorded as this word; another word is refused by naming all.
static void words_come_from_one_table(void **state)
{
    (void)state;
    int words = 0;
    for (int i = 0; i < option_row_count; i++) {
        const option_row *row = &option_rows[i];
        if (row->kind != OPT_SWITCH && row->kind != OPT_ENUM) continue;
        char wrong[64], typed[96];
        snprintf(wrong, sizeof wrong, "--%s nonsense", row->name);
        for (const option_word *w = row->words; w->text; w++, words++) {
            snprintf(typed, sizeof typed, "--%s %s", row->name, w->text);
            options plain = good(""), o = good(typed);
            assert_true(field_of(row, &o) == w->value);
            assert_string_equal(word_of(row->words, w->value), w->text); // no two words of one value
            bad(wrong, w->text, "'nonsense'");
            if (!row->pixels || w->value == field_of(row, &plain)) continue;
            error e = {0};
            char *record = options_record(&o, &e);
            assert_non_null(record);
            assert_string_equal(record, typed);
            free(record);
        }
    }
    assert_true(words > 40);
}

// This room may not include resolve.h, so its table counts the roles itself.
static void channel_options_hit_their_role(void **state)
{
    (void)state;
    const role roles[] = {ROLE_POSITION, ROLE_NORMAL,    ROLE_DEPTH,    ROLE_ALBEDO,
                          ROLE_BEAUTY,   ROLE_ROUGHNESS, ROLE_METALLIC, ROLE_EMISSION};
    const char *const names[] = {"position", "normal", "depth", "albedo", "beauty", "roughness", "metallic", "emission"};
    assert_true(ROLE_COUNT <= 16);
    for (size_t i = 0; i < 8; i++) {
        char line[64];
        snprintf(line, sizeof line, "--%s Some.Layer", names[i]);
        options o = good(line);
        for (int r = 0; r < 16; r++) {
            if (r == (int)roles[i])
                assert_string_equal(o.role_names[r], "Some.Layer");
            else
                assert_null(o.role_names[r]);
        }
    }
}

static void unknown_options_name_the_nearest(void **state)
{
    (void)state;
    bad("--radus 3", "unknown option --radus;", "--radius,");
    bad("--smaples=3", "unknown option --smaples;", "--samples,");
    bad("--env-rot 3", "--env-rot;", "--env-rotate,");
    bad("-method ssdo", "-method", "--method,");
    bad("--thikness 1", "--thikness", "--thickness,");
    bad("-x", "unknown option -x", "-o, -v, -q and -h");
    bad("--a-very-long-name-that-is-longer-than-any-option-could-ever-be", "unknown option --a-very-long",
        "see ssdo-filter --help");
}

static void wrong_values_say_what_is_right(void **state)
{
    (void)state;
    bad("--samples 0", "from 1 to 65536", "'0'");
    bad("--samples 3.5", "a whole number", "'3.5'");
    bad("--samples 99999999999999", "from 1 to 65536", "'99999999999999'");
    bad("--samples many", "--samples must be", "'many'");
    bad("--amount 1.01", "from 0 to 1", "'1.01'");
    bad("--fov 180", "greater than 0 and less than 180", "'180'");
    bad("--fov 0", "greater than 0", "'0'");
    bad("--ortho 0", "--ortho must be a number greater than 0", "'0'");
    bad("--scale -1", "of at least 0", "'-1'");
    bad("--scale 1x", "--scale", "'1x'");
    bad("--scale 0,5", "--scale", "'0,5'");
    bad("--scale nan", "--scale", "'nan'");
    bad("--env-rotate inf", "--env-rotate must be a number", "'inf'");
    bad("--thickness 0", "auto, inf or a number greater than 0", "'0'");
    bad("--blur some", "none or a whole number from 0 to 64", "'some'");
    bad("--env-up x", "--env-up must be y or z", "'x'");
    bad("--mode light", "radiance or visibility", "'light'");
    bad("--compression dwaa", "none, rle, zips, zip or piz", "'dwaa'");
    bad("--method=", "--method needs a value", "not empty");
    bad("--float=yes", "--float takes no value", "'yes'");
    bad("--env", "--env needs a value", "--env FILE");
    bad("--layers --env sky.exr", "--layers needs a value", "--layers LIST");
    bad("--layers --env=sky.exr", "--layers needs a value", "--layers LIST");
}

static void what_excludes_each_other(void **state)
{
    (void)state;
    options o;
    error e;
    bad("--fov 40 --ortho 3", "--fov and --ortho exclude", "give the one");
    bad("-v -q", "-v and -q", "exclude");
    assert_false(parse("-o out.exr", &o, &e));
    assert_non_null(strstr(e.message, "no input file"));
    assert_false(parse("in.exr", &o, &e));
    assert_non_null(strstr(e.message, "no output file"));
    assert_false(parse("", &o, &e));
    assert_int_equal(e.code, ERR_USAGE);
    char many[1024] = "";
    for (int i = 0; i <= OPT_MAX_INPUTS; i++) strcat(many, "x.exr ");
    bad(many, "more than 32 input files", "'x.exr'");
}

// Where --help shows a default that can be typed, typing it changes nothing.
static void shown_defaults_are_true(void **state)
{
    (void)state;
    options plain = good("");
    int compared = 0;
    for (int i = 0; i < option_row_count; i++) {
        const option_row *row = &option_rows[i];
        char line[256];
        options o;
        error e;
        if (!row->fallback || row->kind == OPT_PATH || row->kind == OPT_TEXT) continue;
        snprintf(line, sizeof line, "in.exr -o out.exr --%s %s", row->name, row->fallback);
        if (strchr(row->fallback, ' ') || !parse(line, &o, &e)) continue; // prose
        size_t size = row->kind == OPT_SWITCH ? sizeof(bool) : row->kind == OPT_ENUM || row->kind == OPT_INT ? sizeof(int) : 8;
        assert_memory_equal((const char *)&o + row->offset, (const char *)&plain + row->offset, size);
        compared++;
    }
    assert_true(compared >= 12);
}

static void a_range_in_one_argument_or_two(void **state)
{
    (void)state;
    const char *const forms[] = {"--depth-range 0.5 20", "--depth-range 0.5,20", "--depth-range=0.5,20"};
    for (int i = 0; i < 3; i++) {
        options o = good(forms[i]);
        assert_true(o.depth_range[0] == 0.5 && o.depth_range[1] == 20.0 && o.input_count == 1);
    }
    bad("--depth-range 20 0.5", "--depth-range", "the second the larger");
    bad("--depth-range -1,5", "--depth-range", "at least 0");
    bad("--depth-range 5", "--depth-range", "needs a value");
    bad("--depth-range=5", "--depth-range", "needs a value");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults_are_the_documented_ones),
        cmocka_unit_test(both_forms_of_a_value),
        cmocka_unit_test(short_options),
        cmocka_unit_test(presets_are_defaults),
        cmocka_unit_test(radius_in_three_forms),
        cmocka_unit_test(a_range_in_one_argument_or_two),
        cmocka_unit_test(words_for_values),
        cmocka_unit_test(words_come_from_one_table),
        cmocka_unit_test(channel_options_hit_their_role),
        cmocka_unit_test(unknown_options_name_the_nearest),
        cmocka_unit_test(wrong_values_say_what_is_right),
        cmocka_unit_test(what_excludes_each_other),
        cmocka_unit_test(shown_defaults_are_true),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
