// make bench-paper: what ssdo's light and bounce cost over its own occlusion, beside the figures of the paper, and s3ho over
// hemisphere at equal samples. CPU time of the GL work on one sample, medians over interleaved rounds of times and of the rounds'
// ratios, blur included.
//   paper [SAMPLE]     its name in samples/scenes.json, "still"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"

enum {
    ROUNDS = 9,
    OCCLUSION = 1 << LAYER_OCCLUSION,
    LIGHT = OCCLUSION | 1 << LAYER_RADIANCE,
    BOUNCE = LIGHT | 1 << LAYER_INDIRECT
};

typedef struct kind {
    const char *name, *method;
    unsigned layers;
    int samples, bands;
    double ms[ROUNDS];
} kind;

static bool measure(rig *r, const bench_scene *s, kind *k, double *ms, error *e)
{
    const method *m = method_find(k->method);
    bench_row row = {.kind = ROW_METHOD,
                     .m = m,
                     .samples = k->samples,
                     .blur = m->blur,
                     .thickness = -1,
                     .scale = 1,
                     .contrast = 1,
                     .sh_bands = k->bands};
    frame_result f;
    bench_time all;
    if (!bench_run(r, s, &row, k->layers, &f, NULL, &all, e)) return false;
    *ms = all.cpu;
    rig_free_result(&f);
    return true;
}

// Rounds over all kinds, so that what slows the machine for a while slows all of them; the first, which compiles, is not counted.
static bool measure_all(rig *r, const bench_scene *s, kind *kinds, int count, error *e)
{
    double ignored;
    for (int round = -1; round < ROUNDS; round++)
        for (int i = 0; i < count; i++)
            if (!measure(r, s, &kinds[i], round < 0 ? &ignored : &kinds[i].ms[round], e)) return false;
    return true;
}

// Of the rounds' own ratios: what slows the machine in one round slows both.
static double percent_over(const kind *a, const kind *base)
{
    double ratio[ROUNDS];
    for (int i = 0; i < ROUNDS; i++) ratio[i] = a->ms[i] / base->ms[i];
    return 100.0 * (bench_median(ratio, ROUNDS) - 1.0);
}

static bool compare(const char *name, error *e)
{
    static rig r;
    static bench_scene scenes[BENCH_SCENES];
    int n = bench_open("samples", &r, scenes, e), at = 0;
    for (int i = 0; i < n; i++)
        if (strcmp(scenes[i].s.name, name) == 0) at = i;
    kind kinds[] = {
        {"ssdo, occlusion", "ssdo", OCCLUSION, 8, 0, {0}},
        {"+ direct light", "ssdo", LIGHT, 8, 0, {0}},
        {"+ bounce", "ssdo", BOUNCE, 8, 0, {0}},
        {"ssdo, occlusion", "ssdo", OCCLUSION, 16, 0, {0}},
        {"+ direct light", "ssdo", LIGHT, 16, 0, {0}},
        {"+ bounce", "ssdo", BOUNCE, 16, 0, {0}},
        {"ssdo, occlusion", "ssdo", OCCLUSION, 64, 0, {0}},
        {"+ direct light", "ssdo", LIGHT, 64, 0, {0}},
        {"+ bounce", "ssdo", BOUNCE, 64, 0, {0}},
        {"hemisphere", "hemisphere", LIGHT, 32, 0, {0}},
        {"s3ho", "s3ho", LIGHT, 32, 2, {0}},
        {"s3ho --sh-bands 3", "s3ho", LIGHT, 32, 3, {0}},
        {"hemisphere", "hemisphere", LIGHT, 64, 0, {0}},
        {"s3ho", "s3ho", LIGHT, 64, 2, {0}},
        {"s3ho --sh-bands 3", "s3ho", LIGHT, 64, 3, {0}},
    };
    const int count = sizeof kinds / sizeof *kinds;
    bool ok = n > 0 && measure_all(&r, &scenes[at], kinds, count, e);
    if (ok) printf("| %s | samples | CPU ms | over the first |\n| --- | --- | --- | --- |\n", scenes[at].s.name);
    for (int i = 0; ok && i < count; i++)
        printf("| %s | %d | %.0f | %+.0f %% |\n", kinds[i].name, kinds[i].samples, bench_median(kinds[i].ms, ROUNDS),
               percent_over(&kinds[i], &kinds[i / 3 * 3]));
    if (ok) printf("\nThe paper, net of the base pass: direct light +3 to +11 %%, with one bounce +70 to +100 %%.\n");
    bench_close(&r, scenes, n);
    return ok;
}

int main(int argc, char **argv)
{
    error e = {0};
    return bench_end("paper", compare(argc > 1 ? argv[1] : "still", &e), &e);
}
