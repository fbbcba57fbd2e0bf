// make bench: see bench.h.
//   bench [--samples DIR] [--out DIR] [--cache DIR] [--rounds N] [--title TEXT] [--command TEXT] [--rendered-only]
//   [--generated-only] [--meshes DIR] [--only WORD: rows whose name holds it, for a quick look]
#include <errno.h>
#include <getopt.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "base/clock.h"
#include "base/mem.h"
#include "bench.h"

typedef struct arguments {
    const char *samples, *out, *cache, *meshes, *only, *title, *command;
    int rounds;
    bool rendered, generated;
} arguments;

static bool parse(int argc, char **argv, arguments *a)
{
    static const struct option table[] = {{"samples", 1, NULL, 's'},
                                          {"out", 1, NULL, 'o'},
                                          {"cache", 1, NULL, 'c'},
                                          {"rounds", 1, NULL, 'r'},
                                          {"title", 1, NULL, 't'},
                                          {"command", 1, NULL, 'm'},
                                          {"rendered-only", 0, NULL, 'R'},
                                          {"generated-only", 0, NULL, 'G'},
                                          {"meshes", 1, NULL, 'e'},
                                          {"only", 1, NULL, 'w'},
                                          {NULL, 0, NULL, 0}};
    *a = (arguments){"samples", "build/bench", "build/bench-cache", NULL, NULL, "Bench", "make bench", 3, true, true};
    for (int c; (c = getopt_long(argc, argv, "", table, NULL)) != -1;) {
        if (c == 's') a->samples = optarg;
        if (c == 'o') a->out = optarg;
        if (c == 'c') a->cache = optarg;
        if (c == 'e') a->meshes = optarg;
        if (c == 'w') a->only = optarg;
        if (c == 't') a->title = optarg;
        if (c == 'm') a->command = optarg;
        if (c == 'r') a->rounds = atoi(optarg);
        if (c == 'R') a->generated = false;
        if (c == 'G') a->rendered = false;
        if (c == '?') return false;
    }
    return optind == argc && a->rounds >= 1 && a->rounds <= BENCH_ROUNDS;
}

static double seconds(void) { return 1e-3 * clock_wall_ms(); }

static void say(double start, const char *what)
{
    fprintf(stderr, "bench: %4.0f s (CPU %.0f s)  %s\n", seconds() - start, (double)clock() / CLOCKS_PER_SEC, what);
}

// Folders of a path, one after the other.
static void make_folder(const char *path)
{
    char part[512];
    for (size_t i = 1; i <= strlen(path) && i < sizeof part; i++)
        if (path[i] == '/' || !path[i]) {
            memcpy(part, path, i);
            part[i] = 0;
            mkdir(part, 0777);
        }
}

static int open_scenes(const arguments *a, rig *r, bench_scene *list, error *e)
{
    char sky[512] = "";
    int n = 0;
    if (a->rendered && (n = bench_samples(a->samples, a->meshes, r, list, BENCH_SCENES, e)) == 0) return 0;
    if (!a->generated) return n;
    snprintf(sky, sizeof sky, "%s/sky_soft.exr", a->samples);
    int more = bench_generated(sky, a->cache, r, list + n, BENCH_SCENES - n, e);
    return more ? n + more : 0;
}

static bool run_once(rig *r, const bench_scene *s, const bench_row *row, unsigned layers, bench_time *direct, bench_time *all,
                     error *e)
{
    frame_result f;
    if (!bench_run(r, s, row, layers, &f, direct, all, e)) return false;
    rig_free_result(&f);
    return true;
}

// Compiles what the rows need on this scene, with the fewest samples.
static bool warm_up(rig *r, const bench_results *b, const bench_scene *s, error *e)
{
    for (int i = 0; i < b->row_count; i++) {
        bench_row row = b->rows[i];
        if (row.kind != ROW_METHOD || row.once || !bench_runs(&row, s) || (row.samples != 8 && !row.standard)) continue;
        row.samples = 8;
        if (!run_once(r, s, &row, bench_layers(&row), NULL, NULL, e) ||
            !run_once(r, s, &row, 1u << LAYER_OCCLUSION | row.extra, NULL, NULL, e))
            return false;
    }
    return true;
}

// All layers in one run tell the time of occlusion alone where light is but a multiplication.
static bool tells_both(const bench_row *row)
{
    bool scalar = !method_makes(row->m, MAKES_LIGHT) && !(bench_layers(row) & 1u << LAYER_INDIRECT);
    return scalar || bench_layers(row) == 1u << LAYER_OCCLUSION;
}

// The first round also measures the errors. The long rows, and what costs a march of its own for light, are timed only there.
static bool do_row(rig *r, const bench_scene *s, const bench_row *row, bench_cell *cell, int round, const char *cache, error *e)
{
    const unsigned occlusion = 1u << LAYER_OCCLUSION | row->extra;
    if (!bench_runs(row, s)) return true;
    if (round == 0) {
        if (!bench_measure(r, s, row, cache, cell, e)) return false;
        if (row->kind != ROW_METHOD) return true;
        cell->rounds = cell->all_rounds = 1;
        return s->generated || tells_both(row) || run_once(r, s, row, occlusion, &cell->direct[0], NULL, e);
    }
    if (row->kind != ROW_METHOD || row->once || row->samples > BENCH_LONG) return true;
    int i = cell->rounds++;
    cell->round[i] = round;
    if (tells_both(row) || row->standard) {
        cell->all_rounds++;
        if (!run_once(r, s, row, bench_layers(row), &cell->direct[i], &cell->all[i], e)) return false;
    }
    return tells_both(row) || run_once(r, s, row, occlusion, &cell->direct[i], NULL, e);
}

static void measure_yardstick(const yardstick *y, bench_time *sum)
{
    enum { REPEATS = 3 };
    for (int i = 0; i < REPEATS; i++) {
        bench_time t = yardstick_run(y);
        sum->cpu += t.cpu / (2 * REPEATS), sum->wall += t.wall / (2 * REPEATS);
    }
}

// Half of the yardsticks before the rows and half after: the machine may have changed meanwhile.
static bool do_scene(rig *r, bench_results *b, bench_cell *cells, int s, int round, const char *cache, error *e)
{
    yardstick y;
    const bench_scene *scn = &b->scenes[s];
    if (round == 0 && !warm_up(r, b, scn, e)) return false;
    if (!yardstick_open(&y, scn->gb.width, scn->gb.height, e)) return false;
    measure_yardstick(&y, &b->yard[s][round]);
    bool ok = true;
    for (int i = 0; ok && i < b->row_count; i++)
        ok = do_row(r, scn, &b->rows[i], &cells[i * b->scene_count + s], round, cache, e);
    measure_yardstick(&y, &b->yard[s][round]);
    yardstick_close(&y);
    return ok;
}

// References are made before anything is timed: they would only heat the machine.
static bool prepare_references(const bench_results *b, const char *cache, double start, error *e)
{
    for (int s = 0; s < b->scene_count; s++) {
        char text[128];
        for (int i = 0; i < b->row_count; i++) free(bench_reference(&b->scenes[s], &b->rows[i], cache, e));
        snprintf(text, sizeof text, "references of %s", b->scenes[s].s.name);
        say(start, text);
    }
    return e->code == ERR_NONE;
}

static bool do_rounds(rig *r, bench_results *b, bench_cell *cells, const char *cache, double start, error *e)
{
    for (int round = 0; round < b->rounds; round++) {
        for (int s = 0; s < (round == 0 ? b->scene_count : b->timed_count); s++) {
            char text[128];
            if (!do_scene(r, b, cells, s, round, cache, e)) return false;
            snprintf(text, sizeof text, "round %d: %s", round + 1, b->scenes[s].s.name);
            say(start, text);
        }
    }
    return true;
}

// GL time of the default method on a frame with one surface pixel in ten, in a block, against the frame full of surfaces.
static bool measure_empty(rig *r, const bench_scene *s, double *ratio, error *e)
{
    enum { ROUNDS = 5 };
    const method *m = method_default();
    bench_row row = {
        .kind = ROW_METHOD, .m = m, .samples = m->samples, .blur = m->blur, .thickness = -1, .scale = 1, .contrast = 1};
    bench_scene empty = *s;
    int w = s->gb.width, h = s->gb.height;
    size_t n = (size_t)w * (size_t)h;
    empty.gb.depth = mem_pixels(n, sizeof(float), e);
    if (!empty.gb.depth) return false;
    double side = sqrt(0.1);
    for (int i = 0; i < w * h; i++) {
        bool inside = fabs(i % w + 0.5 - 0.5 * w) < 0.5 * side * w && fabs(i / w + 0.5 - 0.5 * h) < 0.5 * side * h;
        empty.gb.depth[i] = inside ? s->gb.depth[i] : 0.0f;
    }
    double ratios[ROUNDS];
    bool ok = true;
    for (int i = 0; ok && i < ROUNDS; i++) {
        bench_time full = {0}, part = {0};
        ok = run_once(r, s, &row, bench_layers(&row), NULL, &full, e) &&
             run_once(r, &empty, &row, bench_layers(&row), NULL, &part, e);
        ratios[i] = part.cpu / full.cpu;
    }
    if (ok) *ratio = bench_median(ratios, ROUNDS);
    free(empty.gb.depth);
    return ok;
}

// The scene with the most surface: a full frame.
static const bench_scene *fullest(const bench_scene *list, int n)
{
    const bench_scene *best = list;
    for (int i = 1; i < n; i++) {
        double a = (double)best->gb.valid / bench_megapixels(best), b = (double)list[i].gb.valid / bench_megapixels(&list[i]);
        if (b > a) best = &list[i];
    }
    return best;
}

// The rendered scenes come first; where there are none, the generated ones stand in.
static int rendered_count(const bench_scene *list, int n)
{
    int rendered = 0;
    while (rendered < n && !list[rendered].generated) rendered++;
    return rendered ? rendered : n;
}

static int rows_with(bench_row *rows, int n, const char *word)
{
    int kept = 0;
    for (int i = 0; i < n; i++)
        if (!word || strstr(rows[i].name, word)) rows[kept++] = rows[i];
    return kept;
}

static bool bench(const arguments *a, error *e)
{
    static rig r;
    static bench_scene scenes[BENCH_SCENES];
    static bench_row rows[BENCH_ROWS];
    static bench_results b;
    double start = seconds();
    make_folder(a->out);
    make_folder(a->cache);
    b = (bench_results){.title = a->title, .command = a->command, .rounds = a->rounds, .scenes = scenes, .rows = rows};
    if (!rig_open(&r, NULL, e)) return false;
    b.renderer = r.job.g.renderer;
    b.scene_count = open_scenes(a, &r, scenes, e);
    b.timed_count = rendered_count(scenes, b.scene_count);
    say(start, "scenes and their truth");
    bench_cell *cells = NULL;
    bool ok = b.scene_count > 0 && bench_fit_alchemy(&r, scenes, b.timed_count, &b.alchemy_scale, &b.alchemy_contrast, e);
    if (ok) {
        b.row_count = rows_with(rows, bench_rows(rows, BENCH_ROWS, b.alchemy_scale, b.alchemy_contrast), a->only);
        b.cells = cells = mem_zero((size_t)b.row_count * (size_t)b.scene_count, sizeof *cells, e);
        ok = cells && prepare_references(&b, a->cache, start, e);
    }
    ok = ok && do_rounds(&r, &b, cells, a->cache, start, e);
    ok = ok && measure_empty(&r, fullest(scenes, b.scene_count), &b.empty_ratio, e);
    b.seconds = seconds() - start;
    ok = ok && bench_write_csv(&b, a->out, e) && bench_write_markdown(&b, a->out, e) && bench_write_plot(&b, a->out, e);
    for (int i = 0; i < b.scene_count; i++) bench_scene_free(&scenes[i]);
    rig_close(&r);
    free(cells);
    if (ok)
        fprintf(stderr, "bench: %4.0f s  wrote %s/bench.md, bench.csv, errors.csv, bench.svg, bench.png\n", b.seconds, a->out);
    return ok;
}

int main(int argc, char **argv)
{
    arguments a;
    error e = {0};
    setlocale(LC_NUMERIC, "C");
    if (!parse(argc, argv, &a)) {
        fprintf(stderr, "bench: unknown option or a number of rounds outside 1..%d\n", BENCH_ROUNDS);
        return ERR_USAGE;
    }
    return bench_end("bench", bench(&a, &e), &e);
}
