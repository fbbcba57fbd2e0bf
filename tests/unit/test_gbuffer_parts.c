// Which part, view and view layer a channel is taken from.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "described_file.h"

static void test_parts(void **state)
{
    (void)state;
    resolution r = resolved("rgba:R,G,B,A;P:R,G,B;N:X,Y,Z;depth:Z;albedo:R,G,B", NULL);
    assert_int_equal(r.channels[ROLE_POSITION][0].part, 1);
    assert_int_equal(r.channels[ROLE_NORMAL][0].part, 2);
    assert_int_equal(r.channels[ROLE_DEPTH][0].part, 3);
    assert_int_equal(r.channels[ROLE_ALBEDO][0].part, 4);
    assert_int_equal(r.channels[ROLE_BEAUTY][0].part, 0);
    assert_int_equal(r.channels[ROLE_ALPHA][0].part, 0);
    assert_int_equal(r.main_part, 1);

    r = resolved("beauty:R,G,B,A;data:P.X,P.Y,P.Z,N.X,N.Y,N.Z;more:albedo.R,albedo.G,albedo.B", NULL);
    assert_string_equal(r.view_layer, "data");
    assert_int_equal(r.channels[ROLE_ALBEDO][0].part, 2);
    assert_int_equal(r.channels[ROLE_BEAUTY][0].part, 0);

    // A stereo pair: a choice is needed, and each eye keeps to its own parts.
    const char stereo[] = "P.left@left:X,Y,Z;P.right@right:X,Y,Z;N.left@left:X,Y,Z;N.right@right:X,Y,Z";
    error e = {0};
    assert_false(resolve_channels(with(stereo), &(resolve_options){0}, &r, NULL, &e));
    assert_non_null(strstr(e.message, "'left', 'right'"));
    r = resolved(stereo, &(resolve_options){.view_layer = "right"});
    assert_int_equal(r.channels[ROLE_POSITION][0].part, 1);
    assert_int_equal(r.channels[ROLE_NORMAL][0].part, 3);
}

// A part is a layer, whatever it is called: RGBA and Z beside it are the picture and its depth.
static void test_parts_of_any_name(void **state)
{
    (void)state;
    static const char *const names[] = {"rgba", "beauty", "persp", "camera1", "ViewLayer", "left", "main"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char text_of[200];
        snprintf(text_of, sizeof text_of, "%s:A,B,G,R,Z;N:X,Y,Z;crypto00:R,G,B,A", names[i]);
        resolution r = resolved(text_of, NULL);
        assert_int_equal(r.channels[ROLE_DEPTH][0].part, 0);
        check(&r, ROLE_DEPTH, "Z");
        check(&r, ROLE_BEAUTY, "R");
        check(&r, ROLE_ALPHA, "A");
        assert_int_equal(r.channels[ROLE_BEAUTY][0].part, 0);
        assert_int_equal(r.channels[ROLE_NORMAL][0].part, 1);
    }
    // Gaffer's tests: a depth of any name; a picture with a depth of its own beside the file's.
    resolution r = resolved("customRgb:B,G,R;customRgba:A,B,G,R;customDepth:Z", NULL);
    assert_string_equal(title_of(&r, ROLE_DEPTH), "depth: customDepth.Z (part 2, float)");
    assert_int_equal(r.channels[ROLE_BEAUTY][0].part, 1);
    r = resolved("rgba.main@main:A,B,G,R;character.main@main:Z,alpha,blue,green,red;depth.main@main:Z", NULL);
    assert_int_equal(r.channels[ROLE_DEPTH][0].part, 2);
    assert_int_equal(r.channels[ROLE_BEAUTY][0].part, 0);
    r = resolved("rgba:A,B,G,R,Z,mask;character:character.A,character.B,character.G,character.R,character.Z", NULL);
    assert_int_equal(r.channels[ROLE_DEPTH][0].part, 0);
    assert_int_equal(r.channels[ROLE_BEAUTY][0].part, 0);
    // Other passes of four channels are no picture.
    r = resolved("CryptoObject00:R,G,B,A;AO:R,G,B,A;depth:Z", NULL);
    assert_int_equal(r.components[ROLE_BEAUTY], 0);
    // Two of equal standing: the first, unless the other is named.
    const char two[] = "persp:R,G,B,A,Z;side:R,G,B,A,Z";
    r = resolved(two, NULL);
    assert_int_equal(r.channels[ROLE_DEPTH][0].part, 0);
    assert_int_equal(r.channels[ROLE_BEAUTY][0].part, 0);
    r = resolved(two, &(resolve_options){.view_layer = "side"});
    assert_int_equal(r.channels[ROLE_DEPTH][0].part, 1);
    assert_int_equal(r.channels[ROLE_BEAUTY][0].part, 1);
}

// LAYER_VIEW: OpenEXR's Beachball sample, Nuke's _main, with and without the part's attribute.
static void test_views_in_part_names(void **state)
{
    (void)state;
    const char joints[] = "_.- ";
    for (const char *j = joints; *j; j++) {
        char of[300];
        snprintf(of, sizeof of,
                 "rgba%cright@right:A,B,G,R;depth%cleft@left:Z;rgba%cleft@left:A,B,G,R;depth%cright@right:Z;mask%cleft@left:mask",
                 *j, *j, *j, *j, *j);
        resolution r = resolved(of, &(resolve_options){.view = "left"});
        assert_int_equal(r.channels[ROLE_DEPTH][0].part, 1);
        assert_int_equal(r.channels[ROLE_BEAUTY][0].part, 2);
        r = resolved(of, &(resolve_options){.view = "right"});
        assert_int_equal(r.channels[ROLE_DEPTH][0].part, 3);
        assert_int_equal(r.channels[ROLE_ALPHA][0].part, 0);
    }
    resolution r = resolved("rgba_main@main:A,B,G,R;depth_main@main:depth.Z", NULL);
    check(&r, ROLE_DEPTH, "depth.Z");
    check(&r, ROLE_BEAUTY, "R");
    r = resolved("rgba_main:B,G,R;depth_main:depth.Z", NULL);
    check(&r, ROLE_DEPTH, "depth.Z");
    check(&r, ROLE_BEAUTY, "R");
    // No attribute: never the one eye's depth with the other's picture.
    const char bare[] = "rgba_left:A,B,G,R;depth_right:Z;rgba_right:A,B,G,R;depth_left:Z";
    error e = {0};
    assert_false(resolve_channels(with(bare), &(resolve_options){0}, &r, NULL, &e));
    assert_non_null(strstr(e.message, "'right', 'left'"));
    r = resolved(bare, &(resolve_options){.view_layer = "left"});
    assert_int_equal(r.channels[ROLE_DEPTH][0].part, 3);
    assert_int_equal(r.channels[ROLE_BEAUTY][0].part, 0);
    // Light groups of those names are no views of the picture.
    r = resolved("rgba:A,B,G,R,Z;key_left:R,G,B;key_right:R,G,B", NULL);
    assert_int_equal(r.channels[ROLE_BEAUTY][0].part, 0);
}

// A name on the command line is the channel of the view that is filtered, or refused.
static void test_names_and_views(void **state)
{
    (void)state;
    const char stereo[] = "rgba_right@right:A,B,G,R;depth_left@left:Z;rgba_left@left:A,B,G,R;depth_right@right:Z";
    static const char *const fit[] = {"Z", "depth_right.Z", "depth_right", "depth", "z"};
    for (size_t i = 0; i < sizeof fit / sizeof *fit; i++) {
        resolution r = resolved(stereo, &(resolve_options){.view = "right", .names = {[ROLE_DEPTH] = fit[i]}});
        assert_int_equal(r.channels[ROLE_DEPTH][0].part, 3);
    }
    resolution r;
    error e = {0};
    resolve_options other = {.view = "right", .names = {[ROLE_DEPTH] = "depth_left.Z"}};
    assert_false(resolve_channels(with(stereo), &other, &r, NULL, &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_non_null(strstr(e.message, "--view-layer left"));
    // What --explain prints is a name.
    r = resolved(stereo, &(resolve_options){.view = "left"});
    assert_string_equal(title_of(&r, ROLE_DEPTH), "depth: depth_left.Z (part 1, float)");

    // Without views: several parts have the channel.
    const char parts_of_z[] = "rgba:R,G,B,A;a:Z;b:Z";
    e = (error){0};
    assert_false(resolve_channels(with(parts_of_z), &(resolve_options){.names = {[ROLE_DEPTH] = "Z"}}, &r, NULL, &e));
    assert_non_null(strstr(e.message, "a.Z, b.Z"));
    r = resolved(parts_of_z, &(resolve_options){.names = {[ROLE_DEPTH] = "b.Z"}});
    assert_int_equal(r.channels[ROLE_DEPTH][0].part, 2);
    e = (error){0};
    assert_false(resolve_channels(with(parts_of_z), &(resolve_options){0}, &r, NULL, &e)); // and no guess between them
}

static void test_view_layers(void **state)
{
    (void)state;
    const char two[] = "fg.Position.X,fg.Position.Y,fg.Position.Z,fg.DiffCol.R,fg.DiffCol.G,fg.DiffCol.B,"
                       "bg 2.Position.X,bg 2.Position.Y,bg 2.Position.Z,bg 2.Normal.X,bg 2.Normal.Y,bg 2.Normal.Z";
    resolution r;
    error e = {0};
    assert_false(resolve_channels(with(two), &(resolve_options){0}, &r, NULL, &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_string_equal(e.file, "in.exr");
    assert_non_null(strstr(e.message, "'fg', 'bg 2'"));
    assert_non_null(strstr(e.message, "--view-layer"));
    r = resolved(two, &(resolve_options){.view_layer = "bg 2"});
    check(&r, ROLE_POSITION, "bg 2.Position.X");
    check(&r, ROLE_NORMAL, "bg 2.Normal.X");
    assert_int_equal(r.components[ROLE_ALBEDO], 0); // the other layer's albedo is not borrowed
    r = resolved(two, &(resolve_options){.view_layer = "FG"});
    check(&r, ROLE_ALBEDO, "fg.DiffCol.R");
    e = (error){0};
    assert_false(resolve_channels(with(two), &(resolve_options){.view_layer = "mid"}, &r, NULL, &e));
    assert_non_null(strstr(e.message, "'mid'"));
    assert_non_null(strstr(e.message, "'fg'"));
    // Naming the position decides it too.
    r = resolved(two, &(resolve_options){.names = {[ROLE_POSITION] = "bg 2.Position"}});
    check(&r, ROLE_NORMAL, "bg 2.Normal.X");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_parts_of_any_name),
        cmocka_unit_test(test_views_in_part_names),
        cmocka_unit_test(test_names_and_views),
        cmocka_unit_test(test_view_layers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
