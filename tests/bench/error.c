// error [DIR]: --error 0.02 on the rendered samples of DIR: its estimate beside the true error, and its time beside that of
// the fixed budgets which reach the same error. Markdown to standard output. The true error is the difference from the method's
// limit.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"
#include "tile_errors.h"

enum { ROUNDS = 3, BUDGETS = 13, LIMIT_SAMPLES = 2048, LIMIT_RUNS = 4 };

static const double wanted = 0.02;
static const int budgets[BUDGETS] = {64, 96, 128, 160, 192, 256, 320, 384, 512, 640, 768, 1024, 2048};

typedef struct measured {
    tile_errors t;
    double cpu[ROUNDS], mean_samples;
} measured;

static pass_settings settings(const bench_scene *s, int budget)
{
    const method *m = method_default();
    bench_row row = {
        .kind = ROW_METHOD, .m = m, .samples = budget, .blur = m->blur, .thickness = -1.0, .scale = 1.0, .contrast = 1.0};
    pass_settings set = bench_settings(&row, s);
    if (budget == 0) set.samples = m->samples, set.target_error = wanted, set.most_samples = ROUNDS_MOST_SAMPLES;
    return set;
}

static bool measure(rig *r, const bench_scene *s, int budget, const float *limit, int round, measured *m, error *e)
{
    pass_settings set = settings(s, budget);
    frame_result f;
    // The estimate is a layer of its own, which costs a little: where time counts it is not asked for.
    unsigned layers = 1u << LAYER_OCCLUSION | (budget == 0 && round < 0 ? 1u << LAYER_ERROR : 0u);
    if (!rig_run(r, &s->gb, method_default(), &set, layers, &f, e)) return false;
    if (round < 0)
        m->t = tile_errors_of(&s->gb, f.layers[LAYER_OCCLUSION], limit, f.layers[LAYER_ERROR], wanted);
    else
        m->cpu[round] = f.cpu_ms[STAGE_PASSES];
    for (int i = 0; round >= 0 && i < f.timing_count; i++)
        if (strcmp(f.timings[i].name, "upload") == 0) m->cpu[round] -= f.timings[i].cpu_ms;
    m->mean_samples = f.rounds ? f.mean_samples : budget;
    rig_free_result(&f);
    return true;
}

// Time of the fixed budget with an error, on straight lines between the budgets in logarithms; `largest` of the tiles' or of all.
static double time_at(const measured *m, bool largest, double reached)
{
    double x0 = 0.0, t0 = 0.0;
    for (int i = 0; i < BUDGETS; i++) {
        double x = log(largest ? m[i].t.largest : m[i].t.rms), t = log(bench_median(m[i].cpu, ROUNDS));
        if (x <= log(reached)) return exp(i == 0 ? t : t0 + (t - t0) * (log(reached) - x0) / (x - x0));
        x0 = x, t0 = t;
    }
    return INFINITY;
}

static bool add_scene(rig *r, const bench_scene *s, int *tiles, int *within, error *e)
{
    measured rounds = {0}, fixed[BUDGETS] = {0};
    float *limit = tile_limit(r, &s->gb, method_default(), settings(s, 64), LIMIT_SAMPLES, LIMIT_RUNS, e);
    bool ok = limit != NULL;
    for (int round = -1; ok && round < ROUNDS; round++) {
        ok = measure(r, s, 0, limit, round, &rounds, e);
        for (int i = 0; ok && i < BUDGETS; i++) ok = measure(r, s, budgets[i], limit, round, &fixed[i], e);
    }
    free(limit);
    if (!ok) return false;
    const tile_errors *t = &rounds.t;
    double cpu = bench_median(rounds.cpu, ROUNDS);
    printf("| %s | %.0f | %.4f | %.4f | %d of %d | %.3f | %.2f | %.2f |\n", s->s.name, rounds.mean_samples, t->estimated, t->rms,
           t->within_2, t->tiles, t->largest, cpu / time_at(fixed, true, t->largest), cpu / time_at(fixed, false, t->rms));
    fflush(stdout);
    *tiles += t->tiles, *within += t->within_2;
    return true;
}

static bool run(const char *dir, error *e)
{
    static rig r;
    static bench_scene scenes[BENCH_SCENES];
    int tiles = 0, within = 0;
    r.options.report = "timed";
    int n = bench_open(dir, &r, scenes, e);
    bool ok = n > 0;
    printf("| scene | samples | estimated error | true error | tiles within a factor of 2 | largest error of a tile | "
           "CPU time over that of the fixed budget with the same largest error | with the same error |\n"
           "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (int i = 0; ok && i < n; i++) ok = add_scene(&r, &scenes[i], &tiles, &within, e);
    if (ok) printf("\nOf all tiles %.0f %% have a true error within a factor of 2 of the estimate.\n", 100.0 * within / tiles);
    bench_close(&r, scenes, n);
    return ok;
}

int main(int argc, char **argv)
{
    error e = {0};
    return bench_end("error", run(argc > 1 ? argv[1] : "samples", &e), &e);
}
