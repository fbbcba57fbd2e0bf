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
#include "reading_file.h"

enum { FAST = 60, WHOLE = 600 };
static const double most_rms = 0.01;

typedef struct readings {
    hard *h;
    master masters[READING_SCENES];
    frame_result plain[READING_SCENES][2]; // without and with normals
} readings;

static void set_options(readings *r, const reading_case *c)
{
    options *o = &r->h->rig.options;
    const master *m = &r->masters[c->scene];
    options_defaults(o);
    o->layers = "occlusion";
    o->radius_unit = RADIUS_WORLD, o->radius = m->radius;
    if (c->position == ABSENT && m->view.camera.kind == CAMERA_PERSPECTIVE)
        o->fov = 2.0 * atan(0.5 * READING_WIDTH / m->view.camera.fx) / 0.017453292519943295;
    else if (c->position == ABSENT)
        o->ortho = READING_WIDTH / m->view.camera.fx;
    if (c->position == ABSENT && depth_needs_range(c->depth)) o->depth_range[0] = m->near, o->depth_range[1] = m->far;
    log_free(&r->h->rig.log);
    log_init(&r->h->rig.log, LOG_QUIET);
}

static bool run_case(readings *r, const reading_case *c, frame_result *out, error *e)
{
    char path[128];
    snprintf(path, sizeof path, "%s/case.exr", r->h->folder);
    set_options(r, c);
    return reading_write(&r->masters[c->scene], c, path, e) && hard_frame(r->h, path, out, e);
}

static int open_readings(void **state)
{
    readings *r = calloc(1, sizeof *r);
    void *h = NULL;
    if (!r || hard_open(&h) != 0) return -1;
    r->h = h;
    for (int s = 0; s < READING_SCENES; s++) {
        error e = {0};
        must(master_make((reading_scene)s, &r->masters[s], &e), &e);
        for (int n = 0; n < 2; n++) {
            const reading_case plain = {.scene = (reading_scene)s, .position = WORLD, .normal = n ? WORLD : ABSENT};
            must(run_case(r, &plain, &r->plain[s][n], &e), &e);
        }
    }
    *state = r;
    return 0;
}

static int close_readings(void **state)
{
    readings *r = *state;
    for (int s = 0; s < READING_SCENES; s++) {
        master_free(&r->masters[s]);
        for (int n = 0; n < 2; n++) frame_free(&r->plain[s][n]);
    }
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

enum { NEAR_EDGE = 3 };

// 1 where no outline lies within NEAR_EDGE pixels: where neighbours' depths differ by more than a tenth, or only one has any.
static void away_from_edges(const gbuffer *g, unsigned char *mask)
{
    for (int y = 0; y < g->height; y++)
        for (int x = 0; x < g->width; x++) {
            double low = INFINITY, high = 0.0;
            for (int v = y - NEAR_EDGE; v <= y + NEAR_EDGE; v++)
                for (int u = x - NEAR_EDGE; u <= x + NEAR_EDGE; u++) {
                    if (u < 0 || v < 0 || u >= g->width || v >= g->height) continue;
                    double z = (double)g->depth[v * g->width + u];
                    low = fmin(low, z), high = fmax(high, z);
                }
            mask[y * g->width + x] = low > 0.0 && high < 1.1 * low;
        }
}

static double rms_away(const readings *r, const reading_case *c, const frame_result *out)
{
    const frame_result *plain = &r->plain[c->scene][c->normal != ABSENT];
    unsigned char mask[READING_WIDTH * READING_HEIGHT];
    away_from_edges(&plain->gb, mask);
    return hard_compare(plain, out, LAYER_OCCLUSION, mask).rms;
}

// rms over the surfaces of both, of a filtered file away from outlines, where it holds what no renderer's closest sample does; 1
// if more than a fiftieth of the plain file's surfaces is missing.
static double rms_of(const readings *r, const reading_case *c, const frame_result *out)
{
    const frame_result *plain = &r->plain[c->scene][c->normal != ABSENT];
    difference d = hard_compare(plain, out, LAYER_OCCLUSION, NULL);
    if (50 * d.count < 49 * plain->gb.valid) return 1.0;
    return c->filter != FILTER_CLOSEST ? rms_away(r, c, out) : d.rms;
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

static void every_combination(void **state)
{
    readings *r = *state;
    uint64_t random = 1;
    tally closest = {0}, filtered = {0}, open = {0};
    for (int i = 0; i < (hard_whole() ? WHOLE : FAST); i++) {
        double rms;
        reading_case c = draw(&random);
        outcome o = judge(r, &c, &rms);
        tally *t = c.filter != FILTER_CLOSEST ? &filtered : openly_ambiguous(&c) ? &open : &closest;
        t->all++, t->of[o]++;
    }
    const tally *const tallies[] = {&closest, &open, &filtered};
    const char *const names[] = {"one sample a pixel", "orthographic without depth", "through a filter"};
    for (int t = 0; t < 3; t++) {
        const int *of = tallies[t]->of;
        printf("figure: stored forms, %s: %d; right %d, doubted though right %d, wrong and warned of %d, refused %d, wrong in "
               "silence %d\n",
               names[t], tallies[t]->all, of[RIGHT], of[DOUBTED], of[WARNED], of[REFUSED], of[SILENT]);
        assert_int_equal(of[SILENT], 0);
    }
    int right = closest.of[RIGHT] + open.of[RIGHT], doubtful = closest.of[DOUBTED] + open.of[DOUBTED];
    assert_int_equal(closest.of[RIGHT], closest.all);
    assert_true(100 * right >= 95 * (closest.all + open.all));
    assert_true(!hard_whole() || 50 * doubtful <= right + doubtful);
}

// Filtered passes against closest ones, positions and encoded normals in world space. What can be asked of them is measured by a
// closest pass sampled a fifth of a pixel off the centres: `occlusion` depends on what the pixels of an outline hold.
static void filtered_against_closest(void **state)
{
    static const char *const scenes[] = {"flat", "round", "bumpy", "facets", "clutter, orthographic"};
    static const char *const filters[] = {"closest, 0.2 pixels aside", "box, 1 pixel", "Gauss, 3 pixels", "Lanczos, 4 pixels"};
    readings *r = *state;
    FILE *t = hard_table("80-filtered",
                         "**Filtered passes** (P, and N as 0..1, 128 x 96) against closest ones: rms change of `occlusion`, "
                         "everywhere and further than 3 pixels from outlines; beside them closest ones sampled a fifth of a "
                         "pixel off the centres");
    hard_cell(t, "| scene | filter | everywhere | away from outlines |\n| --- | --- | --- | --- |\n");
    double worst = 0.0, most = 0.0, aside = 0.0;
    for (int s = 0; s < READING_SCENES; s++)
        for (int f = FILTER_CLOSEST; f < READING_FILTERS; f++) {
            if (!hard_whole() && !t && f != FILTER_CLOSEST && (s + f) % 4) continue; // the share of the fast subset
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
            double all = hard_compare(&r->plain[s][1], &out, LAYER_OCCLUSION, NULL).rms, away = rms_away(r, &c, &out);
            hard_cell(t, "| %s | %s | %.4f | %.4f |\n", scenes[s], filters[f], all, away);
            frame_free(&out);
            if (f == FILTER_CLOSEST)
                aside = all;
            else
                worst = fmax(worst, away), most = fmax(most, all / aside);
        }
    hard_table_end(t);
    printf("figure: filtered positions and encoded normals: at most %.4f rms off the closest ones away from outlines; everywhere "
           "at most %.2f times what a fifth of a pixel does\n",
           worst, most);
    assert_true(worst < 0.04 && most < 2.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_combination), cmocka_unit_test(filtered_against_closest)};
    return cmocka_run_group_tests(tests, open_readings, close_readings);
}
