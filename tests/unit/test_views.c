// Which views a file has, which of them --view-layer means, and which view a part and a channel of ours belong to.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "pipeline/views.h"

static char empty[] = "", left[] = "left", right[] = "right", middle[] = "middle";

typedef struct trial {
    exrio_part parts[4];
    exrio_file file;
    options o;
} trial;

// Parts by their `view` attribute, NULL for one without.
static trial *in_parts(char *const *views, int count)
{
    static trial t;
    t = (trial){.file = {.part_count = count}};
    t.file.parts = t.parts;
    for (int i = 0; i < count; i++) t.parts[i].view = views[i] ? views[i] : empty;
    return &t;
}

// One part whose channel names tell the views.
static trial *in_names(char *const *views, int count)
{
    trial *t = in_parts((char *[]){NULL}, 1);
    for (int i = 0; i < count; i++) t->parts[0].views[i] = views[i];
    t->parts[0].view_count = count;
    return t;
}

static void expect_views(const trial *t, const char *view_layer, const char *wanted)
{
    const char *names[VIEWS_MAX];
    char found[128] = "";
    options o = t->o;
    o.view_layer = view_layer;
    int count = views_of(&t->file, &o, names);
    for (int i = 0; i < count; i++) strcat(strcat(found, i ? " " : ""), names[i]);
    assert_string_equal(found, wanted);
}

static void views_are_listed_once_in_the_files_order(void **state)
{
    (void)state;
    expect_views(in_parts((char *[]){right, left, right, NULL}, 4), NULL, "right left");
    expect_views(in_names((char *[]){left, right, middle}, 3), NULL, "left right middle");
    expect_views(in_parts((char *[]){NULL, NULL}, 2), NULL, "");
    expect_views(in_parts((char *[]){NULL, right}, 2), NULL, ""); // one is nothing to choose between
    trial *t = in_parts((char *[]){left, right}, 2);
    t->parts[1].deep = true; // never looked at
    expect_views(t, NULL, "");
}

static void view_layer_names_one(void **state)
{
    (void)state;
    const trial *t = in_parts((char *[]){left, right}, 2);
    expect_views(t, "right", "right");
    expect_views(t, "ViewLayer.left", "left");
    expect_views(t, "ViewLayer", "left right");
    expect_views(t, "bright", "left right"); // ends so, but is another word
    expect_views(in_parts((char *[]){NULL, right}, 2), "right", "right");
}

static void the_rest_of_view_layer_stays(void **state)
{
    (void)state;
    const struct {
        const char *view, *given, *left;
    } cases[] = {
        {"right", "right", NULL},      {"right", "ViewLayer.right", "ViewLayer"},
        {"right", "a.b.right", "a.b"}, {"right", "ViewLayer", "ViewLayer"},
        {"right", "bright", "bright"}, {NULL, "ViewLayer.right", "ViewLayer.right"},
        {"right", NULL, NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char buf[64];
        options o = {.view_layer = cases[i].given};
        const char *rest = view_layer_within(&o, cases[i].view, buf, sizeof buf);
        assert_true(!rest == !cases[i].left);
        if (rest) assert_string_equal(rest, cases[i].left);
    }
}

static void a_part_belongs_to_its_view(void **state)
{
    (void)state;
    const trial *t = in_parts((char *[]){left, right, NULL}, 3);
    assert_true(view_has(&t->parts[0], "left") && view_has(&t->parts[1], "right"));
    assert_false(view_has(&t->parts[0], "right") || view_has(&t->parts[2], "left"));
    for (int i = 0; i < 3; i++) assert_true(view_has(&t->parts[i], NULL));
    assert_false(view_in_names(&t->file, "left") || view_in_names(&t->file, NULL));
    t = in_names((char *[]){left, right}, 2);
    assert_true(view_has(&t->parts[0], "left") && view_has(&t->parts[0], "right"));
    assert_false(view_has(&t->parts[0], "middle"));
    assert_true(view_in_names(&t->file, "right"));
    assert_false(view_in_names(&t->file, "middle") || view_in_names(&t->file, NULL));
}

// OpenEXR's rule: the view stands before the component, and a name of one word needs none in the default view.
static void our_channels_are_named_by_the_view(void **state)
{
    (void)state;
    const struct {
        bool names;
        const char *view, *name, *wanted;
    } cases[] = {
        {true, "left", "occlusion.R", "occlusion.left.R"},
        {true, "left", "R", "R"},
        {true, "right", "R", "right.R"},
        {true, "right", "x.occlusion.R", "x.occlusion.right.R"},
        {true, NULL, "occlusion.R", "occlusion.R"},
        {true, "middle", "occlusion.R", "occlusion.R"},
        {false, "left", "occlusion.R", "occlusion.R"},
        {false, "right", "R", "R"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char out[64], *both[] = {left, right};
        const trial *t = cases[i].names ? in_names(both, 2) : in_parts(both, 2);
        view_name(&t->file, cases[i].view, cases[i].name, out, sizeof out);
        assert_string_equal(out, cases[i].wanted);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_are_listed_once_in_the_files_order),
        cmocka_unit_test(view_layer_names_one),
        cmocka_unit_test(the_rest_of_view_layer_stays),
        cmocka_unit_test(a_part_belongs_to_its_view),
        cmocka_unit_test(our_channels_are_named_by_the_view),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
