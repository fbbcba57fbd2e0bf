// sequences SAMPLES SEEDS [WORD]: error of `arc` by the sequence that its slices, steps and sectors draw from, and by the spacing
// of its steps, as a Markdown table: root mean square over the scenes of a folder, mean of SEEDS seeds, and in brackets how far
// those differ (standard deviation), in units of the last digit. Run by sequences.sh, which prepares the shaders.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"

enum { SEEDS_MAX = 32, ERRORS = 3 };

// Of sequences.glsl and spacings.glsl.
static const struct {
    const char *name;
    int angle, jitter, spacing;
} variants[] = {
    {"as it is", 0, 0, 0},
    {"angle: hash", 1, 0, 0},
    {"angle: IGN", 2, 0, 0},
    {"angle: Hilbert-R2", 3, 0, 0},
    {"angle: Owen-scrambled Sobol", 4, 0, 0},
    {"jitters: hash", 0, 1, 0},
    {"jitters: IGN", 0, 2, 0},
    {"jitters: lattices R4", 0, 5, 0},
    {"jitters: none", 0, 6, 0},
    {"all: hash", 1, 1, 0},
    {"all: IGN", 2, 2, 0},
    {"all: Hilbert-R2", 3, 3, 0},
    {"all: Owen-scrambled Sobol", 4, 4, 0},
    {"spacing: power 1.5, at least a pixel each", 0, 0, 1},
    {"spacing: squares, at least a pixel each", 0, 0, 2},
    {"spacing: power 2.5, at least a pixel each", 0, 0, 3},
    {"spacing: cubes, at least a pixel each", 0, 0, 4},
    {"spacing: squares alone", 0, 0, 5},
};

static const struct {
    const char *name;
    int samples;
    bool half, blurred, light;
} budgets[] = {
    {"half, 16", 16, true, true, false}, {"32", 32, false, true, false},    {"64, no blur", 64, false, false, false},
    {"256", 256, false, true, false},    {"**64**", 64, false, true, true},
};

static void add(const sample *t, const frame_result *f, bool light, double to[ERRORS])
{
    score o = sample_score(t, f->layers[LAYER_OCCLUSION], t->ao[0], t->ao[1], 1);
    to[0] += o.rmse * o.rmse;
    if (!light) return;
    score r = sample_score(t, f->layers[LAYER_RADIANCE], t->direct[0], t->direct[1], 3);
    score i = sample_score(t, f->layers[LAYER_INDIRECT], t->indirect[0], t->indirect[1], 3);
    to[1] += pow(r.rmse / r.mean, 2.0);
    to[2] += pow(i.rmse / i.mean, 2.0);
}

static void print(const double *errors, int count, int digits)
{
    double mean = 0.0, squares = 0.0, unit = pow(10.0, digits);
    for (int i = 0; i < count; i++) mean += errors[i] / count;
    for (int i = 0; i < count; i++) squares += pow(errors[i] - mean, 2.0);
    printf(" %.*f", digits, mean);
    if (count > 1) printf(" (%.0f)", unit * sqrt(squares / (count - 1)));
    printf(" |");
}

static bool run_variant(rig *r, const bench_scene *scenes, int n, size_t v, int seeds, error *e)
{
    const method *m = method_default();
    printf("| %s |", variants[v].name);
    for (size_t b = 0; b < sizeof budgets / sizeof *budgets; b++) {
        double errors[ERRORS][SEEDS_MAX];
        unsigned layers = budgets[b].light ? 1u << LAYER_RADIANCE | 1u << LAYER_INDIRECT : 0u;
        for (int q = 0; q < seeds; q++) {
            double sums[ERRORS] = {0};
            unsigned seed = (unsigned)q * 2654435761u >> 20; // scattered: the lattices turn by the seed
            bench_row row = {.kind = ROW_METHOD, .m = m, .samples = budgets[b].samples, .blur = budgets[b].blurred ? m->blur : 0};
            row.half = budgets[b].half, row.thickness = -1.0, row.scale = row.contrast = 1.0;
            row.seed = (int)seed | variants[v].angle << 16 | variants[v].jitter << 20 | variants[v].spacing << 24;
            for (int k = 0; k < n; k++) {
                frame_result f;
                if (!bench_run(r, &scenes[k], &row, 1u << LAYER_OCCLUSION | layers, &f, NULL, NULL, e)) return false;
                add(&scenes[k].s, &f, budgets[b].light, sums);
                rig_free_result(&f);
            }
            for (int i = 0; i < ERRORS; i++) errors[i][q] = sqrt(sums[i] / n);
        }
        for (int i = 0; i < (budgets[b].light ? ERRORS : 1); i++) print(errors[i], seeds, i == 2 ? 4 : 5);
    }
    printf("\n");
    fflush(stdout);
    return true;
}

static bool run(const char *dir, int seeds, const char *word, error *e)
{
    static rig r;
    static bench_scene scenes[BENCH_SCENES];
    int n = bench_open(dir, &r, scenes, e);
    bool ok = n > 0;
    size_t count = sizeof budgets / sizeof *budgets;
    printf("|  |");
    for (size_t b = 0; b < count; b++) printf(" %s: occlusion |", budgets[b].name);
    printf(" radiance | indirect |\n|");
    for (size_t b = 0; b < count + ERRORS; b++) printf(" --- |");
    printf("\n");
    for (size_t v = 0; ok && v < sizeof variants / sizeof *variants; v++)
        if (strstr(variants[v].name, word)) ok = run_variant(&r, scenes, n, v, seeds, e);
    bench_close(&r, scenes, n);
    return ok;
}

int main(int argc, char **argv)
{
    error e = {0};
    int seeds = argc > 2 ? atoi(argv[2]) : 0;
    if (seeds < 1 || seeds > SEEDS_MAX) {
        fprintf(stderr, "sequences: SAMPLES SEEDS [WORD], of 1 to %d seeds\n", SEEDS_MAX);
        return 2;
    }
    return bench_end("sequences", run(argv[1], seeds, argc > 3 ? argv[3] : "", &e), &e);
}
