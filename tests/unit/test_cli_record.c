// The header record ssdo/args: what it keeps, that it can be typed again, and that a decimal comma never gets in.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <locale.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/options.h"
#include "cli/options_table.h"

enum { MAX_ARGS = 128 };

// Splits as a POSIX shell would: spaces, single quotes, backslash. Works in place.
static int split(char *line, char **argv)
{
    int argc = 1;
    argv[0] = "ssdo-filter";
    char *to = line;
    bool quoted = false, in_word = false;
    for (char *p = line; *p; p++) {
        if (!in_word && *p != ' ') {
            argv[argc++] = to;
            in_word = true;
        }
        if (*p == '\'') {
            quoted = !quoted;
        } else if (*p == '\\' && !quoted && p[1]) {
            *to++ = *++p;
        } else if (*p == ' ' && !quoted) {
            if (in_word) *to++ = '\0';
            in_word = false;
        } else {
            *to++ = *p;
        }
    }
    *to = '\0';
    return argc;
}

static options parse(char *line)
{
    char *argv[MAX_ARGS];
    options o;
    error e = {0};
    int argc = split(line, argv);
    if (!options_parse(argc, argv, &o, &e)) fail_msg("%s", e.message);
    return o;
}

static void assert_options_record(const options *o, const char *wanted)
{
    error e = {0};
    char *record = options_record(o, &e);
    assert_non_null(record);
    assert_string_equal(record, wanted);
    free(record);
}

static void assert_record(char *line, const char *wanted)
{
    options o = parse(line);
    assert_options_record(&o, wanted);
}

static const char *const everything =
    "--layers occlusion,bent --main composite --float --method alchemy --radius 0.1 --quality high --samples 100 --error "
    "0.015625 --thickness inf "
    "--planes off --outside 0.25 --also a.exr --also b.exr --surround shot "
    "--angle-bias 12.5 --sh-bands 3 --sh-sigma 0.25 --from-sh --resolution half --blur none --scale 1.7 "
    "--contrast 0.3333333333333333 --mesh scene.obj --mesh-axes y-up --proxies balls.json --bounce ssdo --bounce-strength 1e-15 "
    "--vpl-count 99 --env "
    "sky.exr --env-up y --env-rotate "
    "-12.5 "
    "--env-scale 3 --beauty-env lit.exr --beauty-env-rotate 12 --beauty-env-scale 0.5 --env-colorspace sRGB --ocio config.ocio "
    "--env-frame camera --env-lod 2.5 --mode visibility --amount 0 --multiply all --depthmask-strength 2 --position 'View "
    "Layer.Position' --normal 'it'\\''s N' "
    "--depth Z "
    "--albedo a --beauty b --roughness r --metallic m --emission e --view-layer 'A \"B\" $C' --depth-kind radial "
    "--depth-range 0.125,20 --normal-space world --normal-encoding unorm-srgb "
    "--albedo-colorspace Cg --albedo-kind "
    "base "
    "--fov 39.6 --radius-from 12";

static void everything_survives_the_round_trip(void **state)
{
    (void)state;
    char line[2048], again[2300], *first, *second;
    error e = {0};
    snprintf(line, sizeof line, "in.exr -o out.exr %s", everything);
    options o = parse(line);
    assert_non_null(first = options_record(&o, &e));
    assert_string_equal(first, everything);
    snprintf(again, sizeof again, "in.exr -o out.exr %s", first);
    options back = parse(again);
    assert_non_null(second = options_record(&back, &e));
    assert_string_equal(second, first);
    assert_true(back.contrast == o.contrast && back.bounce_strength == 1e-15 && back.radius == 0.1);
    assert_string_equal(back.role_names[1], "it's N");
    assert_string_equal(back.view_layer, "A \"B\" $C");
    free(first);
    free(second);
}

// Every row that changes pixels appears above, so that a new row cannot be forgotten.
static void the_round_trip_covers_every_row(void **state)
{
    (void)state;
    for (int i = 0; i < option_row_count; i++) {
        char name[64];
        snprintf(name, sizeof name, "--%s", option_rows[i].name);
        if (option_rows[i].pixels && !strstr(everything, name) && strcmp(option_rows[i].name, "ortho") != 0)
            fail_msg("%s is not covered", name);
    }
}

static void what_changes_no_pixel_is_left_out(void **state)
{
    (void)state;
    char line[] = "/show/in.exr -o /show/out.exr --threads 3 --device 1 --require-gpu --gpu-debug --preview /p.png --report "
                  "/r.json -v --camera /c.json --keep none "
                  "--compression piz --prefix x --env /show/maps/sky.exr --radius auto --amount 1 --mode radiance --scale 1.0";
    assert_record(line, "--env sky.exr");
    char plain[] = "in.exr -o out.exr";
    assert_record(plain, "");
}

// Of any length, to its end: a prefix of a record would be that of other settings.
static void a_long_record_is_whole(void **state)
{
    (void)state;
    enum { LONG = 100000 };
    char *line = calloc(1, LONG + 64), *wanted = calloc(1, LONG + 64);
    int n = sprintf(line, "in.exr -o out.exr --position ");
    memset(line + n, 'p', LONG);
    sprintf(line + n + LONG, " --samples 9");
    sprintf(wanted, "--samples 9 %s", line + n - 11);
    wanted[strlen(wanted) - 12] = '\0';
    assert_record(line, wanted);
    free(line);
    free(wanted);
}

static void variables_that_change_pixels_are_named(void **state)
{
    (void)state;
    setenv("SSDO_TILE", "48", 1);
    setenv("SSDO_SHADER_DIR", "/home/me/my shaders", 1);
    setenv("SSDO_MEMORY", "1000000000", 1);
    char line[] = "in.exr -o out.exr --samples 9";
    assert_record(line, "SSDO_SHADER_DIR='my shaders' SSDO_TILE=48 --samples 9");
    unsetenv("SSDO_TILE");
    unsetenv("SSDO_SHADER_DIR");
    unsetenv("SSDO_MEMORY");
}

// A locale with a decimal comma: an installed one, or one made on the spot by localedef (the build machines have only C).
static bool comma_locale(void)
{
    static const char *const installed[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "nl_NL.UTF-8"};
    for (size_t i = 0; i < 4; i++)
        if (setlocale(LC_ALL, installed[i])) return true;
    char folder[] = "/tmp/ssdo-locale-XXXXXX", command[512];
    if (!mkdtemp(folder)) return false;
    snprintf(command, sizeof command,
             "cd %s && printf 'comment_char %%%%\\nescape_char /\\nLC_NUMERIC\\ndecimal_point \",\"\\nthousands_sep \".\"\\n"
             "grouping 3;3\\nEND LC_NUMERIC\\n' >xx && localedef -c --no-archive -i ./xx ./xx_XX >log 2>&1",
             folder);
    int made = system(command); // localedef returns 1 after its warnings about the missing categories
    setenv("LOCPATH", folder, 1);
    bool ok = made != -1 && setlocale(LC_NUMERIC, "xx_XX") != NULL;
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command) == 0 && ok;
}

static void a_decimal_comma_changes_nothing(void **state)
{
    (void)state;
    if (!comma_locale()) skip();
    char sign[16];
    snprintf(sign, sizeof sign, "%.1f", 0.5);
    assert_string_equal(sign, "0,5"); // else the rest would prove nothing
    char line[] = "in.exr -o out.exr --radius 0.25 --scale=1.5 --env-rotate -1234567.5";
    options o = parse(line);
    assert_true(o.radius == 0.25 && o.scale == 1.5 && o.env_rotate == -1234567.5);
    assert_options_record(&o, "--radius 0.25 --scale 1.5 --env-rotate -1234567.5");
    snprintf(sign, sizeof sign, "%.1f", 0.5);
    assert_string_equal(sign, "0,5"); // the caller's locale is left as it was
    setlocale(LC_ALL, "C");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(everything_survives_the_round_trip),     cmocka_unit_test(the_round_trip_covers_every_row),
        cmocka_unit_test(what_changes_no_pixel_is_left_out),      cmocka_unit_test(a_long_record_is_whole),
        cmocka_unit_test(variables_that_change_pixels_are_named), cmocka_unit_test(a_decimal_comma_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
