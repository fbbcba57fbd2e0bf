// Which channel is what: Blender and plain names, file names, lists, options.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "described_file.h"
#include "gbuffer/conventions.h"

static void test_blender(void **state)
{
    (void)state;
    resolution r = resolved("Composite.Combined.A,Composite.Combined.B,Composite.Combined.G,Composite.Combined.R,"
                            "View.Layer 1.Combined.A,View.Layer 1.Combined.B,View.Layer 1.Combined.G,View.Layer 1.Combined.R,"
                            "View.Layer 1.Depth.Z,View.Layer 1.DiffCol.B,View.Layer 1.DiffCol.G,View.Layer 1.DiffCol.R,"
                            "View.Layer 1.DiffDir.B,View.Layer 1.DiffDir.G,View.Layer 1.DiffDir.R,"
                            "View.Layer 1.DiffInd.B,View.Layer 1.DiffInd.G,View.Layer 1.DiffInd.R,"
                            "View.Layer 1.Emit.B,View.Layer 1.Emit.G,View.Layer 1.Emit.R,"
                            "View.Layer 1.Normal.X,View.Layer 1.Normal.Y,View.Layer 1.Normal.Z,"
                            "View.Layer 1.Position.X,View.Layer 1.Position.Y,View.Layer 1.Position.Z",
                            NULL);
    assert_string_equal(r.convention, "blender");
    assert_string_equal(r.view_layer, "View.Layer 1");
    check(&r, ROLE_POSITION, "View.Layer 1.Position.X");
    assert_string_equal(name_of(&r, ROLE_POSITION, 2), "View.Layer 1.Position.Z");
    check(&r, ROLE_NORMAL, "View.Layer 1.Normal.X");
    check(&r, ROLE_DEPTH, "View.Layer 1.Depth.Z");
    check(&r, ROLE_ALBEDO, "View.Layer 1.DiffCol.R");
    assert_string_equal(name_of(&r, ROLE_ALBEDO, 2), "View.Layer 1.DiffCol.B");
    check(&r, ROLE_BEAUTY, "View.Layer 1.Combined.R");
    check(&r, ROLE_ALPHA, "View.Layer 1.Combined.A");
    check(&r, ROLE_EMISSION, "View.Layer 1.Emit.R");
    check(&r, ROLE_DIFFUSE_DIRECT, "View.Layer 1.DiffDir.R");
    check(&r, ROLE_DIFFUSE_INDIRECT, "View.Layer 1.DiffInd.R");
    assert_int_equal(r.components[ROLE_ROUGHNESS], 0);
    assert_int_equal(r.albedo, ALBEDO_DIFFUSE);
    assert_int_equal(r.depth, DEPTH_AUTO);
    assert_true(r.up_is_z);
    assert_true(r.background_depth <= 1e10);
    char line[256];
    resolve_describe(&file, &r, ROLE_POSITION, line, sizeof line);
    assert_string_equal(line, "position: View.Layer 1.Position.X/Y/Z (part 0, float)");

    // The File Output node: no view layer, scalar suffix V; newer pass names.
    r = resolved("Depth.V,Emission.R,Emission.G,Emission.B,Image.R,Image.G,Image.B,Image.A,Normal.X,Normal.Y,Normal.Z,"
                 "Position.X,Position.Y,Position.Z",
                 NULL);
    assert_string_equal(r.convention, "blender");
    check(&r, ROLE_DEPTH, "Depth.V");
    check(&r, ROLE_BEAUTY, "Image.R");
    check(&r, ROLE_ALPHA, "Image.A");
    check(&r, ROLE_EMISSION, "Emission.R");
}

static void test_plain(void **state)
{
    (void)state;
    resolution r = resolved("A,B,G,R,N.X,N.Y,N.Z,P.X,P.Y,P.Z,Z,albedo.B,albedo.G,albedo.R,roughness", NULL);
    assert_string_equal(r.convention, "plain");
    check(&r, ROLE_POSITION, "P.X");
    check(&r, ROLE_NORMAL, "N.X");
    check(&r, ROLE_DEPTH, "Z");
    check(&r, ROLE_ALBEDO, "albedo.R");
    check(&r, ROLE_BEAUTY, "R");
    check(&r, ROLE_ALPHA, "A");
    check(&r, ROLE_ROUGHNESS, "roughness");
    assert_int_equal(r.albedo, ALBEDO_BASE);
    assert_false(r.up_is_z);

    r = resolved("n.blue,n.green,n.red,p.b,p.g,p.r,DEPTH.Z,Diffuse_Albedo.red,Diffuse_Albedo.green,Diffuse_Albedo.blue", NULL);
    assert_string_equal(name_of(&r, ROLE_NORMAL, 0), "n.red");
    assert_string_equal(name_of(&r, ROLE_POSITION, 1), "p.g");
    check(&r, ROLE_DEPTH, "DEPTH.Z");
    assert_int_equal(r.albedo, ALBEDO_DIFFUSE);
    assert_int_equal(r.components[ROLE_BEAUTY], 0);

    r = resolved("position.x,position.y,position.z,normal.x,normal.y,normal.z,depth.Z", NULL);
    assert_string_equal(r.convention, "plain");
    check(&r, ROLE_NORMAL, "normal.x");

    // Depth alone: planar unless said otherwise.
    r = resolved("R,G,B,A,Z", NULL);
    assert_string_equal(r.convention, "plain");
    assert_int_equal(r.depth, DEPTH_PLANAR);
    r = resolved("R,G,B,A,Z", &(resolve_options){.depth = DEPTH_RADIAL});
    assert_int_equal(r.depth, DEPTH_RADIAL);

    // An incomplete position is none.
    r = resolved("P.X,P.Y,Z", NULL);
    assert_int_equal(r.components[ROLE_POSITION], 0);
}

// A channel serves one role. X, Y and Z without a name are positions or CIE's colours, and no depth and no picture.
static void test_one_role_each(void **state)
{
    (void)state;
    resolution r = resolved("X,Y,Z", &(resolve_options){.names = {[ROLE_POSITION] = "X,Y,Z"}});
    check(&r, ROLE_POSITION, "X");
    assert_int_equal(r.components[ROLE_DEPTH], 0);
    assert_int_equal(r.components[ROLE_BEAUTY], 0);
    error e = {0};
    assert_false(resolve_channels(with("X,Y,Z"), &(resolve_options){0}, &r, NULL, &e));
    assert_non_null(strstr(e.message, "CIE XYZ"));
    assert_non_null(strstr(e.message, "--position X,Y,Z"));
    r = resolved("A,X,Y,Z,depth.Z", NULL);
    assert_int_equal(r.components[ROLE_BEAUTY], 0);
    check(&r, ROLE_DEPTH, "depth.Z");
    r = resolved("R,G,B,X,Y,Z,depth.V", NULL);
    check(&r, ROLE_BEAUTY, "R");
    check(&r, ROLE_DEPTH, "depth.V");
    r = resolved("R,G,B,A,Z", &(resolve_options){.names = {[ROLE_ALBEDO] = "R,G,B"}});
    assert_int_equal(r.components[ROLE_BEAUTY], 0);
    r = resolved("R,G,B,Z", &(resolve_options){.names = {[ROLE_POSITION] = "R,G,B"}});
    check(&r, ROLE_DEPTH, "Z");
    assert_int_equal(r.components[ROLE_BEAUTY], 0);
}

static resolution resolved_as(char *path, const char *description)
{
    resolution r;
    error e = {0};
    with(description);
    file.path = path;
    if (!resolve_channels(&file, &(resolve_options){0}, &r, NULL, &e)) fail_msg("%s: %s", path, e.message);
    return r;
}

// One pass in one file, whose name tells.
static void test_file_names(void **state)
{
    (void)state;
    static char *const depths[] = {"depth.exr",     "a/shot_depth.0001.exr", "Z.exr",
                                   "depth_rgb.exr", "sh010.Z-Depth.12.exr",  "zdepth.exr"};
    for (size_t i = 0; i < sizeof depths / sizeof *depths; i++)
        for (int form = 0; form < 4; form++) {
            static const char *const channels_of[] = {"Y", "R,G,B", "A,B,G,R", "V"};
            resolution r = resolved_as(depths[i], channels_of[form]);
            check(&r, ROLE_DEPTH, form == 0 ? "Y" : form == 3 ? "V" : "R");
            assert_int_equal(r.components[ROLE_BEAUTY] + r.components[ROLE_ALPHA] + r.components[ROLE_POSITION],
                             form == 2 ? 1 : 0); // alpha
        }
    static char *const positions[] = {"P.exr", "a.b/sh010_P.0001.exr", "world_position.exr", "shot.Position.exr"};
    for (size_t i = 0; i < sizeof positions / sizeof *positions; i++)
        for (int form = 0; form < 2; form++) {
            resolution r = resolved_as(positions[i], form ? "X,Y,Z" : "R,G,B");
            check(&r, ROLE_POSITION, form ? "X" : "R");
            assert_int_equal(r.components[ROLE_BEAUTY] + r.components[ROLE_DEPTH], 0);
        }
    resolution r;
    error e = {0};
    static char other[] = "depths/beauty.exr", reference[] = "Pref.exr";
    with("R,G,B"), file.path = other;
    assert_false(resolve_channels(&file, &(resolve_options){0}, &r, NULL, &e)); // the folder's name says nothing
    e = (error){0};
    with("R,G,B"), file.path = reference;
    assert_false(resolve_channels(&file, &(resolve_options){0}, &r, NULL, &e));
}

// Lists of channels are complete.
static void test_lists(void **state)
{
    (void)state;
    resolution r;
    error e = {0};
    resolve_options wrong = {.names = {[ROLE_DEPTH] = "Depth"}};
    assert_false(resolve_channels(with("A,B,G,R,Z,N.X,N.Y,N.Z"), &wrong, &r, NULL, &e));
    assert_non_null(strstr(e.message, "which has R G B A, Z, N"));
    e = (error){0};
    assert_false(resolve_channels(with("B,G,R"), &(resolve_options){0}, &r, NULL, &e));
    assert_non_null(strstr(e.message, "the file has R G B;"));
    e = (error){0};
    assert_false(resolve_channels(with("rgba:B,G,R,Z;N:X,Y,Z"), &wrong, &r, NULL, &e));
    assert_non_null(strstr(e.message, "which has rgba, rgba.Z, N"));
    // Longer than a line, and longer than any message.
    char many[4096] = "", *at = many;
    for (int i = 0; i < MOST; i++) at += sprintf(at, "%sa_rather_long_name_of_a_layer_%02d", i ? "," : "", i);
    e = (error){0};
    assert_false(resolve_channels(with(many), &(resolve_options){0}, &r, NULL, &e));
    assert_non_null(strstr(e.message, "layer_00, "));
    assert_non_null(strstr(e.message, "layer_39;"));
}

// Names seen in public files and in renderers' sources, as layers of what they are; and those that only look like it.
static void test_names(void **state)
{
    (void)state;
    static const struct {
        const char *layer, *components;
        role role; // ROLE_COUNT: none
    } names[] = {
        {"VRaySamplerInfo", "R,G,B", ROLE_POSITION},
        {"World Position", "R,G,B", ROLE_POSITION},
        {"world-position", "X,Y,Z", ROLE_POSITION},
        {"WorldPosition", "X,Y,Z", ROLE_POSITION},
        {"Info:Position", "R,G,B", ROLE_POSITION},
        {"Position", "[red],[green],[blue]", ROLE_POSITION},
        {"Pcam", "X,Y,Z", ROLE_POSITION},
        {"P_cam", "x,y,z", ROLE_POSITION},
        {"P_world", "x,y,z", ROLE_POSITION},
        {"CGeometry_WorldPosition", "R,G,B", ROLE_POSITION},
        {"World Coordinate", "X,Y,Z", ROLE_POSITION},
        {"ShNormal", "X,Y,Z", ROLE_NORMAL},
        {"normals", "R,G,B", ROLE_NORMAL},
        {"worldNormal", "R,G,B", ROLE_NORMAL},
        {"World Normal", "R,G,B", ROLE_NORMAL},
        {"N_cam", "X,Y,Z", ROLE_NORMAL},
        {"N_world", "X,Y,Z", ROLE_NORMAL},
        {"Info:Normal", "R,G,B", ROLE_NORMAL},
        {"CGeometry_NormalsShading", "R,G,B", ROLE_NORMAL},
        {"Pref", "X,Y,Z", ROLE_COUNT},
        {"__Pref", "r,g,b", ROLE_COUNT},
        {"P_ref", "X,Y,Z", ROLE_COUNT},
        {"Nref", "X,Y,Z", ROLE_COUNT},
        {"Position Offset", "X,Y,Z", ROLE_COUNT},
        {"motionvector", "X,Y,Z", ROLE_COUNT},
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char of[400] = "R,G,B,A,Z", copy[64], *rest = copy;
        snprintf(copy, sizeof copy, "%s", names[i].components);
        for (char *c; (c = strsep(&rest, ","));) snprintf(of + strlen(of), sizeof of - strlen(of), ",%s.%s", names[i].layer, c);
        // with() parts a part's name at the first colon
        char whole[420];
        snprintf(whole, sizeof whole, "%s%s", strchr(of, ':') ? "one:" : "", of);
        resolution r = resolved(whole, NULL);
        for (int k = ROLE_POSITION; k <= ROLE_NORMAL; k++)
            if ((r.components[k] > 0) != (names[i].role == (role)k)) fail_msg("%s as %s", names[i].layer, role_name((role)k));
        check(&r, ROLE_DEPTH, "Z");
        check(&r, ROLE_BEAUTY, "R");
    }
}

static void test_options(void **state)
{
    (void)state;
    const char odd[] = "where.R,where.G,where.B,facing.X,facing.Y,facing.Z,far,tint.R,tint.G,tint.B,a.X,b.Y,c.Z,Z";
    resolution r = resolved(odd, &(resolve_options){.names = {[ROLE_POSITION] = "where",
                                                              [ROLE_NORMAL] = "a.X,b.Y,c.Z",
                                                              [ROLE_DEPTH] = "far",
                                                              [ROLE_ALBEDO] = "TINT",
                                                              [ROLE_ROUGHNESS] = "tint.G"},
                                                    .albedo = ALBEDO_DIFFUSE,
                                                    .depth = DEPTH_RADIAL});
    check(&r, ROLE_POSITION, "where.R");
    check(&r, ROLE_NORMAL, "a.X");
    assert_string_equal(name_of(&r, ROLE_NORMAL, 2), "c.Z");
    check(&r, ROLE_DEPTH, "far");
    check(&r, ROLE_ALBEDO, "tint.R");
    check(&r, ROLE_ROUGHNESS, "tint.G");
    assert_int_equal(r.albedo, ALBEDO_DIFFUSE);
    assert_int_equal(r.depth, DEPTH_RADIAL);

    error e = {0};
    assert_false(resolve_channels(with(odd), &(resolve_options){.names = {[ROLE_NORMAL] = "nix"}}, &r, NULL, &e));
    assert_string_equal(e.channel, "nix");
    assert_non_null(strstr(e.message, "--normal"));
    assert_non_null(strstr(e.message, "facing"));
    e = (error){0};
    assert_false(resolve_channels(with(odd), &(resolve_options){.names = {[ROLE_NORMAL] = "far"}}, &r, NULL, &e));
    assert_non_null(strstr(e.message, "X Y Z"));
}

static void test_nothing(void **state)
{
    (void)state;
    resolution r;
    error e = {0};
    assert_false(resolve_channels(with("R,G,B,spec.R,spec.G,spec.B"), &(resolve_options){0}, &r, NULL, &e));
    assert_int_equal(e.code, ERR_INPUT);
    assert_non_null(strstr(e.message, "--position"));
    assert_non_null(strstr(e.message, "--depth"));
    assert_non_null(strstr(e.message, "spec"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_blender),    cmocka_unit_test(test_plain),   cmocka_unit_test(test_one_role_each),
        cmocka_unit_test(test_file_names), cmocka_unit_test(test_lists),   cmocka_unit_test(test_names),
        cmocka_unit_test(test_options),    cmocka_unit_test(test_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
