// The limit of each method against its own brute-force reference: the mean signed difference over up to 4096 stratified pixels,
// with samples enough that noise leaves a few 1e-5 of it. An error of 5 % in cosine, weight, thickness or measure moves that
// mean by 5e-4 or more on at least one of the views (`make mutate` proves it). In a root mean square the noise would hide it.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "method_fixture.h"
#include "must.h"

enum { WIDTH = 96, HEIGHT = 64 };

// How a method is held to its reference.
typedef struct trial {
    const char *name;
    int samples, pixels;
    double thickness;  // share of the radius; 0: endless
    double angle_bias; // degrees
    double limit;      // of the mean difference
    bool fine;         // a reference with more points
} trial;

// A ground seen so flat that the slices' weights and the angles of their normals differ as much as they can.
static void build_grazing(scene *s)
{
    scene_bar(s, 0.3, 0.2, 0.8, 0.0);
    s->eye = v3(5, -0.6, 0.6);
    s->target = v3(0, 0, 0.1);
}

// A ground seen as flat along the foot of a wall: the slices that hold the view's tilt weigh least by their cosine and most by
// their angle, and only those across them meet the wall.
static void build_along_wall(scene *s)
{
    scene_wall(s, 70.0, 0.4);
    s->eye = v3(-6, -0.9, 0.6);
    s->target = v3(0, -0.6, 0);
}

static void build_wide_clutter(scene *s)
{
    scene_clutter(s);
    s->radius = 2.5; // so that Alchemy's c, a tenth of it, is several pixels
}

static const listed_scene views[] = {
    {"clutter", scene_clutter, false}, {"clutter-ortho", scene_clutter, true},    {"clutter, wide", build_wide_clutter, false},
    {"grazing", build_grazing, false}, {"along a wall", build_along_wall, false}, {NULL, NULL, false}};

static bool unbiased(rig *r, fixture *f, const trial *t, const char *where)
{
    error e = {0};
    figures g;
    const method *m = method_find(t->name);
    pass_settings set = rig_settings(m, f->s.radius);
    set.samples = t->samples;
    if (t->thickness > 0.0) set.thickness = t->thickness * f->s.radius;
    set.angle_bias = t->angle_bias;
    fixture_expect(f, m, &set, t->fine);
    must(fixture_compare(f, r, m, &set, &g, &e), &e);
    bool good = fabs(g.bias) <= t->limit;
    print_message("%-10s %-13s bias %+.5f, rmse %.5f at %d samples, %d pixels%s\n", t->name, where, g.bias, g.rmse, set.samples,
                  f->count, good ? "" : "  <-- too large");
    return good;
}

static void check(void **state)
{
    static fixture f;
    static scene s;
    const trial *t = *state;
    rig r;
    error e = {0};
    int bad = 0;
    must(rig_open(&r, NULL, &e), &e);
    for (const listed_scene *l = views; l->name; l++) {
        l->build(&s);
        view v = listed_view(l, &s, WIDTH, HEIGHT);
        must(fixture_open(&f, &s, &v, t->pixels, &e), &e);
        bad += !unbiased(&r, &f, t, l->name);
        fixture_close(&f);
    }
    rig_close(&r);
    if (bad) fail_msg("%s is off on %d views by more than %g in the mean", t->name, bad, t->limit);
}

// test_bias [METHOD]
int main(int argc, char **argv)
{
    // Fewer pixels where the reference takes long and the noise allows it. The horizon of hbao is sampled, so it stays a little
    // low for any number of steps.
    static trial ssdo = {"ssdo", 4096, 1024, 0.5, 0.0, 0.0004, false}, s3ho = {"s3ho", 4096, 1024, 0.5, 0.0, 0.0004, false},
                 alchemy = {"alchemy", 4096, 1024, 0.0, 0.0, 0.0004, true},
                 hemisphere = {"hemisphere", 4096, 1024, 0.0, 0.0, 0.0006, false},
                 hbao = {"hbao", 16384, 1024, 0.0, 20.0, 0.002, true},
                 gtao = {"gtao", 16384, FIXTURE_PIXELS, 0.0, 0.0, 0.0004, true},
                 bitmask = {"bitmask", 16384, FIXTURE_PIXELS, 0.3, 0.0, 0.0004, true};
    const struct CMUnitTest tests[] = {
        {"ssdo", check, NULL, NULL, &ssdo},       {"s3ho", check, NULL, NULL, &s3ho},
        {"alchemy", check, NULL, NULL, &alchemy}, {"hemisphere", check, NULL, NULL, &hemisphere},
        {"hbao", check, NULL, NULL, &hbao},       {"gtao", check, NULL, NULL, &gtao},
        {"bitmask", check, NULL, NULL, &bitmask},
    };
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests_name("bias", tests, NULL, NULL);
}
