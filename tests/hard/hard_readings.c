// Files whose meaning has to be found: the same scenes in every space, handedness, encoding, kind of depth, container and filter,
// drawn by a fixed sequence, against the plain file. A case is right if its occlusion is the plain file's within .01 rms and no
// role is doubted; wrong in silence if it is neither right nor warned of nor refused.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "gbuffer/solve.h"
#include "hard.h"
#include "pipeline/frame.h"
#include "reading_file.h"

// Of the cases that went through a filter, how many times as wide and high the picture is: pixels that outlines cross are a sixth
// of a picture of 128 x 96, and a twenty-fifth, still more than of a renderer's frame, of one of 512 x 384.
enum { FAST = 60, WHOLE = 600, LARGE = 4 };
static const double most_rms = 0.01;

// One scene at a time.
typedef struct readings {
    hard *h;
    master m;
    frame_result plain[2]; // without and with normals
    bool no_range;         // --depth-range is not given
} readings;

static void set_options(readings *r, const reading_case *c)
{
    options *o = &r->h->rig.options;
    const master *m = &r->m;
    options_defaults(o);
    o->layers = "occlusion";
    o->radius_unit = RADIUS_WORLD, o->radius = m->radius;
    if (c->position == ABSENT && m->view.camera.kind == CAMERA_PERSPECTIVE)
        o->fov = 2.0 * atan(0.5 * m->width / m->view.camera.fx) / 0.017453292519943295;
    else if (c->position == ABSENT)
        o->ortho = m->width / m->view.camera.fx;
    if (c->position == ABSENT && depth_needs_range(c->depth) && !r->no_range)
        o->depth_range[0] = m->near, o->depth_range[1] = m->far;
    log_free(&r->h->rig.log);
    log_init(&r->h->rig.log, LOG_QUIET);
}

static bool run_case(readings *r, const reading_case *c, frame_result *out, error *e)
{
    char path[128];
    snprintf(path, sizeof path, "%s/case.exr", r->h->folder);
    set_options(r, c);
    return reading_write(&r->m, c, path, e) && hard_frame(r->h, path, out, e);
}

static void open_scene(readings *r, reading_scene which, int scale)
{
    error e = {0};
    must(master_make(which, scale, &r->m, &e), &e);
    for (int n = 0; n < 2; n++) {
        const reading_case plain = {.scene = which, .position = WORLD, .normal = n ? WORLD : ABSENT};
        must(run_case(r, &plain, &r->plain[n], &e), &e);
    }
}

static void close_scene(readings *r)
{
    master_free(&r->m);
    for (int n = 0; n < 2; n++) frame_free(&r->plain[n]);
}

static int open_readings(void **state)
{
    readings *r = calloc(1, sizeof *r);
    void *h = NULL;
    if (!r || hard_open(&h) != 0) return -1;
    r->h = h;
    *state = r;
    return 0;
}

static int close_readings(void **state)
{
    readings *r = *state;
    void *h = r->h;
    free(r);
    return hard_close(&h);
}

// ---- verdicts

typedef enum outcome { RIGHT, DOUBTED, WARNED, REFUSED, SILENT, OUTCOMES } outcome;

// A warning that names the geometry: of doubt, or of damage.
static bool warned_of_geometry(const readings *r)
{
    static const char *const roles[] = {"normal", "position", "depth"};
    for (int w = 0; w < r->h->rig.log.warning_count; w++)
        for (int k = 0; k < 3; k++)
            if (strstr(r->h->rig.log.keys[w], roles[k])) return true;
    return false;
}

static bool doubted(const gbuffer *g)
{
    return g->position_verdict.doubtful || g->normal_verdict.doubtful || g->depth_verdict.doubtful;
}

// rms over the surfaces of both; 1 if more than a fiftieth of the plain file's surfaces is missing.
static double rms_of(const readings *r, const reading_case *c, const frame_result *out)
{
    const frame_result *plain = &r->plain[c->normal != ABSENT];
    difference d = hard_compare(plain, out, LAYER_OCCLUSION, NULL);
    return 50 * d.count < 49 * plain->gb.valid ? 1.0 : d.rms;
}

static outcome judge(readings *r, const reading_case *c, double *rms)
{
    frame_result out;
    error e = {0};
    outcome result = REFUSED;
    *rms = (double)NAN;
    if (run_case(r, c, &out, &e)) {
        *rms = rms_of(r, c, &out);
        bool doubt = doubted(&out.gb);
        result = *rms <= most_rms ? (doubt ? DOUBTED : RIGHT) : warned_of_geometry(r) ? WARNED : SILENT;
    } else if (e.code != ERR_INPUT) {
        fail_msg("%s", e.message);
    }
    if (getenv("SSDO_READINGS") && result != RIGHT) {
        char name[256];
        reading_name(c, name, sizeof name);
        printf("%-8s rms %.4f  %s\n", (const char *[]){"right", "doubted", "warned", "refused", "SILENT"}[result], *rms, name);
        if (result == REFUSED) printf("         %s\n", e.message);
        for (int w = 0; w < r->h->rig.log.warning_count && result != REFUSED; w++)
            printf("         %.120s\n", r->h->rig.log.warnings[w]);
        for (int i = 0; result != REFUSED && i < out.gb.evidence_count; i++) printf("           %s\n", out.gb.evidence[i]);
    }
    frame_free(&out);
    return result;
}

// ---- the draw

static int pick(uint64_t *random, const int *shares, int count)
{
    int sum = 0, at = 0;
    for (int i = 0; i < count; i++) sum += shares[i];
    int value = (int)(solve_random(random) % (uint64_t)sum);
    while (value >= shares[at]) value -= shares[at++];
    return at;
}

static reading_case draw(uint64_t *random)
{
    static const double turns[] = {0, 3, 5, 10, 20, 30, 45, 60, 90, 120, 135, 150, 170};
    static const int scenes[READING_SCENES] = {3, 3, 2, 2, 1}, turn[13] = {2, 1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2},
                     positions[READING_SPACES] = {8, 8, 3, 1, 1, 1}, normals[READING_SPACES] = {2, 8, 8, 2, 2, 1},
                     encodings[NORMAL_ENCODINGS] = {8, 6, 1, 1, 1, 1}, flips[8] = {16, 1, 1, 1, 1, 1, 1, 1},
                     depths[DEPTH_KINDS] = {0, 8, 4, 2, 1, 1, 1, 1}, filters[READING_FILTERS] = {9, 1, 1, 1},
                     layouts[READING_LAYOUTS] = {2, 1, 1}, rarely[2] = {5, 1}, half[2] = {2, 1}, often[2] = {1, 1};
    reading_case c = {0};
    c.scene = (reading_scene)pick(random, scenes, READING_SCENES);
    c.axis = (int)(solve_random(random) % 3), c.turn = turns[pick(random, turn, 13)];
    c.mirrored = pick(random, rarely, 2);
    c.position = (reading_space)pick(random, positions, READING_SPACES);
    c.normal = (reading_space)pick(random, normals, READING_SPACES);
    c.encoding = (normal_encoding)pick(random, encodings, NORMAL_ENCODINGS);
    c.flips = pick(random, flips, 8);
    c.depth = (depth_kind)pick(random, depths, DEPTH_KINDS);
    if (c.position != ABSENT && pick(random, often, 2)) c.depth = DEPTH_AUTO;
    c.negative_depth = c.depth != DEPTH_AUTO && c.depth <= DEPTH_RADIAL && pick(random, rarely, 2);
    c.filter = (reading_filter)pick(random, filters, READING_FILTERS);
    c.layout = (reading_layout)pick(random, layouts, READING_LAYOUTS);
    c.half_normals = pick(random, half, 2);
    // An orthographic picture has no radial depth of its own; without normals there are no flips.
    if (c.scene == SCENE_ORTHO && c.depth >= DEPTH_RADIAL) c.depth = DEPTH_PLANAR;
    return c;
}

// Where the direction of an orthographic camera rests on handedness alone, the doubt is the truth.
static bool openly_ambiguous(const reading_case *c)
{
    return c->scene == SCENE_ORTHO && c->position != ABSENT && c->depth == DEPTH_AUTO;
}

typedef struct tally {
    int all, of[OUTCOMES];
} tally;

enum { CLOSEST, OPEN, FILTERED, KINDS };

static int kind_of(const reading_case *c)
{
    return c->filter != FILTER_CLOSEST ? FILTERED : openly_ambiguous(c) ? OPEN : CLOSEST;
}

// Judges the cases of one scene; of a large picture only those that went through a filter.
static void judge_scene(readings *r, const reading_case *cases, int count, reading_scene which, int scale, tally by_kind[KINDS])
{
    open_scene(r, which, scale);
    for (int i = 0; i < count; i++) {
        int kind = kind_of(&cases[i]);
        double rms;
        if (cases[i].scene != which || (scale > 1 && kind != FILTERED)) continue;
        by_kind[kind].all++, by_kind[kind].of[judge(r, &cases[i], &rms)]++;
    }
    close_scene(r);
}

static void print_tally(const tally *t, const char *name)
{
    printf("figure: stored forms, %s: %d; right %d, doubted though right %d, wrong and warned of %d, refused %d, wrong in "
           "silence %d\n",
           name, t->all, t->of[RIGHT], t->of[DOUBTED], t->of[WARNED], t->of[REFUSED], t->of[SILENT]);
    assert_int_equal(t->of[SILENT], 0);
}

static void every_combination(void **state)
{
    static const char *const names[KINDS] = {"one sample a pixel", "orthographic without depth", "through a filter, 128 x 96"};
    static reading_case cases[WHOLE];
    readings *r = *state;
    uint64_t random = 1;
    int count = hard_whole() ? WHOLE : FAST;
    tally small[KINDS] = {0}, large[KINDS] = {0};
    for (int i = 0; i < count; i++) cases[i] = draw(&random);
    for (int s = 0; s < READING_SCENES; s++) {
        judge_scene(r, cases, count, (reading_scene)s, 1, small);
        if (hard_whole()) judge_scene(r, cases, count, (reading_scene)s, LARGE, large);
    }
    for (int k = 0; k < KINDS; k++) print_tally(&small[k], names[k]);
    if (hard_whole()) print_tally(&large[FILTERED], "through a filter, 512 x 384");
    int right = small[CLOSEST].of[RIGHT] + small[OPEN].of[RIGHT], doubtful = small[CLOSEST].of[DOUBTED] + small[OPEN].of[DOUBTED];
    assert_int_equal(small[CLOSEST].of[RIGHT], small[CLOSEST].all);
    assert_true(100 * right >= 95 * (small[CLOSEST].all + small[OPEN].all));
    assert_true(!hard_whole() || 50 * doubtful <= right + doubtful);
}

// Filtered passes against closest ones, positions and encoded normals in world space; beside them what a closest pass that was
// sampled a fifth of a pixel off the centres does, because `occlusion` depends on what the pixels of an outline hold.
static void filtered_against_closest(void **state)
{
    static const char *const scenes[] = {"flat", "round", "bumpy", "facets", "clutter, orthographic"};
    static const char *const filters[] = {"closest, 0.2 pixels aside", "box, 1 pixel", "Gauss, 3 pixels", "Lanczos, 4 pixels"};
    readings *r = *state;
    FILE *t = hard_table("80-filtered", "**Filtered passes** (P, and N as 0..1) against closest ones: rms change of `occlusion`; "
                                        "beside them closest ones sampled a fifth of a pixel off the centres");
    hard_cell(t, "| scene | filter | 128 x 96 | 512 x 384 |\n| --- | --- | --- | --- |\n");
    double rms[READING_SCENES][READING_FILTERS][2] = {0}, worst[2] = {0}, most = 0.0;
    bool whole = hard_whole() || t;
    for (int s = 0; s < READING_SCENES; s++) {
        for (int large = 0; large <= whole; large++) {
            open_scene(r, (reading_scene)s, large ? LARGE : 1);
            for (int f = FILTER_CLOSEST; f < READING_FILTERS; f++) {
                if (!whole && f != FILTER_CLOSEST && (s + f) % 4) continue; // the share of the fast subset
                const reading_case c = {.scene = (reading_scene)s,
                                        .position = WORLD,
                                        .normal = WORLD,
                                        .encoding = NORMAL_UNORM,
                                        .filter = (reading_filter)f,
                                        .aside = f == FILTER_CLOSEST};
                frame_result out;
                error e = {0};
                must(run_case(r, &c, &out, &e), &e);
                assert_true(!out.gb.normals_from_depth && (f == FILTER_CLOSEST || warned_of_geometry(r)));
                rms[s][f][large] = hard_compare(&r->plain[1], &out, LAYER_OCCLUSION, NULL).rms;
                if (f != FILTER_CLOSEST) worst[large] = fmax(worst[large], rms[s][f][large]);
                if (f != FILTER_CLOSEST) most = fmax(most, rms[s][f][large] / rms[s][FILTER_CLOSEST][large]);
                frame_free(&out);
            }
            close_scene(r);
        }
        for (int f = 0; f < READING_FILTERS; f++)
            hard_cell(t, "| %s | %s | %.4f | %.4f |\n", scenes[s], filters[f], rms[s][f][0], rms[s][f][1]);
    }
    hard_table_end(t);
    printf("figure: filtered positions and encoded normals: at most %.4f rms off the closest ones, %.2f times what a fifth of a "
           "pixel does\n",
           worst[0], most);
    if (hard_whole()) printf("figure: the same in 512 x 384: at most %.4f rms\n", worst[1]);
    assert_true(worst[0] < 0.04 && worst[1] < 0.014 && most < 2.0);
}

// The case's rms; fails unless it is read right.
static double must_be_right(readings *r, const reading_case *c)
{
    char name[256];
    double rms;
    reading_name(c, name, sizeof name);
    if (judge(r, c, &rms) != RIGHT) fail_msg("rms %.4f: %s", rms, name);
    return rms;
}

// A filter takes means of what is stored: distances from the eye, 1 / z, values within 0..1 that its negative lobes leave,
// normals behind a display curve. The kind of depth is found although the edges fit none.
static void filtered_as_stored(void **state)
{
    static const struct {
        reading_space position;
        normal_encoding encoding;
        depth_kind depth;
        reading_filter filter;
    } forms[] = {
        {ABSENT, NORMAL_SIGNED, DEPTH_RADIAL, FILTER_BOX},    {ABSENT, NORMAL_SIGNED, DEPTH_RADIAL, FILTER_GAUSS},
        {ABSENT, NORMAL_SIGNED, DEPTH_INVERSE, FILTER_BOX},   {ABSENT, NORMAL_UNORM, DEPTH_INVERSE, FILTER_GAUSS},
        {ABSENT, NORMAL_UNORM, DEPTH_INVERTED, FILTER_LOBES}, {ABSENT, NORMAL_UNORM, DEPTH_ZBUFFER, FILTER_LOBES},
        {EYE_BACK, NORMAL_SRGB, DEPTH_AUTO, FILTER_BOX},      {EYE_BACK, NORMAL_DEGAMMA, DEPTH_AUTO, FILTER_BOX},
        {WORLD, NORMAL_GAMMA, DEPTH_AUTO, FILTER_LOBES},      {WORLD, NORMAL_DESRGB, DEPTH_PLANAR, FILTER_GAUSS},
    };
    readings *r = *state;
    double worst = 0.0;
    open_scene(r, SCENE_FLAT, 1);
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        const reading_case c = {.scene = SCENE_FLAT,
                                .axis = 1,
                                .turn = 20.0,
                                .position = forms[i].position,
                                .normal = WORLD,
                                .encoding = forms[i].encoding,
                                .depth = forms[i].depth,
                                .filter = forms[i].filter};
        worst = fmax(worst, must_be_right(r, &c));
    }
    close_scene(r);
    printf("figure: filtered passes of every kind of value: at most %.4f rms\n", worst);
}

// Without normals. Planes say the same of 1 / z and of every z-buffer; the background tells them apart, but not 0..1 from a -1..1
// whose values are all positive. A range that nobody knows
// is asked for.
static void depth_alone(void **state)
{
    static const struct {
        depth_kind depth;
        bool no_range;
        outcome expected;
    } forms[] = {{DEPTH_INVERSE, false, RIGHT}, {DEPTH_ZBUFFER, false, DOUBTED}, {DEPTH_REVERSED, false, RIGHT},
                 {DEPTH_NDC, false, RIGHT},     {DEPTH_ZBUFFER, true, REFUSED},  {DEPTH_NDC, true, REFUSED}};
    readings *r = *state;
    open_scene(r, SCENE_ROUND, 1);
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        const reading_case c = {.scene = SCENE_ROUND, .depth = forms[i].depth};
        double rms;
        r->no_range = forms[i].no_range;
        outcome found = judge(r, &c, &rms);
        if (found != forms[i].expected) fail_msg("%s: outcome %d, rms %.4f", word_of(depth_kind_words, c.depth), (int)found, rms);
    }
    r->no_range = false;
    close_scene(r);
}

// A logarithm, a root and an offset lie over no distance that is read without a word, and no other depth is taken for one (all
// those above). A z-buffer of -1..1 that holds no negative value looks like one of 0..1.
static void changed_depths(void **state)
{
    readings *r = *state;
    int cases = 0, told = 0;
    for (int s = 0; s < READING_SCENES; s++) {
        open_scene(r, (reading_scene)s, 1);
        double near = r->m.near;
        for (int k = 0; k < 2 * (READING_CHANGES + 1); k++) {
            reading_case c = {.scene = (reading_scene)s, .axis = 2, .turn = 30.0, .depth = DEPTH_PLANAR};
            c.normal = k % 2 ? WORLD : ABSENT, c.change = (reading_change)(k / 2 % READING_CHANGES);
            if (k / 2 == READING_CHANGES) c.depth = DEPTH_NDC, r->m.near = 0.3 * near;
            if (s == SCENE_ORTHO && (c.depth == DEPTH_NDC || c.change == LESS_NEAR)) continue; // the same shapes
            double rms;
            char name[256];
            outcome found = judge(r, &c, &rms);
            r->m.near = near;
            reading_name(&c, name, sizeof name);
            if (found == SILENT) fail_msg("rms %.4f in silence: %s", rms, name);
            cases += c.change != UNCHANGED, told += c.change != UNCHANGED && found == REFUSED;
        }
        close_scene(r);
    }
    printf("figure: depths under a root, a logarithm or an offset: %d, refused %d, wrong in silence 0\n", cases, told);
}

// Round surfaces and the bumps on them are followed to their outlines.
static void filtered_outlines(void **state)
{
    static const struct {
        reading_scene scene;
        int scale;
        reading_filter filter;
    } forms[] = {{SCENE_ROUND, 1, FILTER_BOX},
                 {SCENE_ROUND, 2, FILTER_BOX},
                 {SCENE_ROUND, 2, FILTER_GAUSS},
                 {SCENE_BUMPY, LARGE, FILTER_BOX}};
    readings *r = *state;
    double worst = 0.0;
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        const reading_case c = {
            .scene = forms[i].scene, .position = WORLD, .normal = WORLD, .encoding = NORMAL_UNORM, .filter = forms[i].filter};
        open_scene(r, forms[i].scene, forms[i].scale);
        worst = fmax(worst, must_be_right(r, &c));
        close_scene(r);
    }
    printf("figure: outlines of filtered passes: at most %.4f rms\n", worst);
}

// Where more than two surfaces meet in a pixel, or one is too narrow to fill one.
static void filtered_corners(void **state)
{
    readings *r = *state;
    const reading_case c = {
        .scene = SCENE_FACETS, .position = WORLD, .normal = WORLD, .encoding = NORMAL_UNORM, .filter = FILTER_LOBES};
    open_scene(r, SCENE_FACETS, LARGE);
    const double rms = must_be_right(r, &c);
    close_scene(r);
    printf("figure: corners of filtered passes: %.4f rms\n", rms);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_combination),  cmocka_unit_test(filtered_against_closest),
                                       cmocka_unit_test(filtered_as_stored), cmocka_unit_test(filtered_outlines),
                                       cmocka_unit_test(filtered_corners),   cmocka_unit_test(depth_alone),
                                       cmocka_unit_test(changed_depths)};
    if (argc > 1) cmocka_set_test_filter(argv[1]);
    return cmocka_run_group_tests(tests, open_readings, close_readings);
}
