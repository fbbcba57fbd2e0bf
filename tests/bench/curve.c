// curve: the errors of arc's budgets over the rendered samples, for the table of `make bench-frame` that sets them beside the
// cost of a whole frame. A line for each budget: samples, full or half, and the errors of occlusion, radiance and indirect as in
// `make bench`.
#include <math.h>
#include <stdio.h>

#include "bench.h"

static const int budgets[] = {4, 8, 16, 32, 64};

typedef struct sums {
    double occlusion, radiance, indirect; // of squares
} sums;

static bool add(rig *r, const bench_scene *s, const bench_row *row, sums *to, error *e)
{
    frame_result f;
    if (!bench_run(r, s, row, bench_layers(row), &f, NULL, NULL, e)) return false;
    const sample *t = &s->s;
    score light = sample_score(t, f.layers[LAYER_RADIANCE], t->direct[0], t->direct[1], 3);
    score bounce = sample_score(t, f.layers[LAYER_INDIRECT], t->indirect[0], t->indirect[1], 3);
    double occlusion = sample_score(t, f.layers[LAYER_OCCLUSION], t->ao[0], t->ao[1], 1).rmse;
    to->occlusion += occlusion * occlusion;
    to->radiance += pow(light.rmse / light.mean, 2.0);
    to->indirect += pow(bounce.rmse / bounce.mean, 2.0);
    rig_free_result(&f);
    return true;
}

static bool run(error *e)
{
    static rig r;
    static bench_scene scenes[BENCH_SCENES];
    const method *m = method_default();
    int n = bench_open("samples", &r, scenes, e);
    bool ok = n > 0;
    for (size_t i = 0; ok && i < 2 * (sizeof budgets / sizeof *budgets); i++) {
        bench_row row = {.kind = ROW_METHOD, .m = m, .samples = budgets[i / 2], .blur = m->blur, .half = i % 2 == 0};
        sums all = {0};
        row.thickness = -1.0, row.scale = row.contrast = 1.0;
        for (int k = 0; ok && k < n; k++) ok = add(&r, &scenes[k], &row, &all, e);
        if (ok)
            printf("%d\t%s\t%.3f\t%.3f\t%.3f\n", row.samples, row.half ? "half" : "full", sqrt(all.occlusion / n),
                   sqrt(all.radiance / n), sqrt(all.indirect / n));
    }
    bench_close(&r, scenes, n);
    return ok;
}

int main(void)
{
    error e = {0};
    return bench_end("curve", run(&e), &e);
}
