#include <stdlib.h>

#include "base/sort.h"
#include "bench.h"

double bench_percentile(const double *values, int count, double share)
{
    double v[BENCH_SCENES * BENCH_ROUNDS];
    if (count == 0) return NAN;
    for (int i = 0; i < count; i++) v[i] = values[i];
    sort_doubles(v, (size_t)count);
    double at = share * (count - 1);
    int low = (int)at, high = low + 1 < count ? low + 1 : low;
    return v[low] + (at - low) * (v[high] - v[low]);
}

double bench_median(const double *values, int count) { return bench_percentile(values, count, 0.5); }

double bench_megapixels(const bench_scene *b) { return 1e-6 * b->gb.width * b->gb.height; }

bench_time bench_cell_time(const bench_results *r, int row, int which, bool all)
{
    const bench_cell *c = &r->cells[row * r->scene_count + which];
    const bench_time *t = all ? c->all : c->direct;
    double cpu[BENCH_ROUNDS], wall[BENCH_ROUNDS];
    int n = all ? c->all_rounds : c->rounds;
    for (int i = 0; i < n; i++) cpu[i] = t[i].cpu, wall[i] = t[i].wall;
    if (n == 0 || which >= r->timed_count || (all && !c->has_radiance)) return (bench_time){NAN, NAN};
    return (bench_time){bench_median(cpu, n), bench_median(wall, n)};
}

double bench_cell_yards(const bench_results *r, int row, int which, bool all)
{
    const bench_cell *c = &r->cells[row * r->scene_count + which];
    const bench_time *t = all ? c->all : c->direct;
    double ratio[BENCH_ROUNDS];
    int n = all ? c->all_rounds : c->rounds;
    for (int i = 0; i < n && which < r->timed_count; i++) ratio[i] = t[i].cpu / r->yard[which][c->round[i]].cpu;
    return n == 0 || which >= r->timed_count || (all && !c->has_radiance) ? NAN : bench_median(ratio, n);
}

static double square(double x) { return x * x; }

static void summarise_row(const bench_results *r, int row, int set, bench_summary *out)
{
    int n = 0, with_a = 0, with_radiance = 0, with_indirect = 0;
    *out = (bench_summary){0};
    for (int i = 0; i < r->scene_count; i++) {
        if (r->scenes[i].generated != (set == SET_GENERATED)) continue;
        const bench_cell *c = &r->cells[row * r->scene_count + i];
        bench_time t = bench_cell_time(r, row, i, false), all = bench_cell_time(r, row, i, true);
        double mp = bench_megapixels(&r->scenes[i]);
        n++;
        out->occlusion += c->has_occlusion ? square(c->occlusion.rmse) : NAN;
        out->radiance += c->has_radiance ? square(c->radiance.rmse / c->radiance.mean) : NAN;
        out->indirect += c->has_indirect ? square(c->indirect.rmse / c->indirect.mean) : NAN;
        if (c->has_a) out->a += square(c->a_rmse), with_a++;
        if (c->has_a_radiance) out->a_radiance += square(c->a_radiance), with_radiance++;
        if (c->has_a_indirect) out->a_indirect += square(c->a_indirect), with_indirect++;
        out->cpu += t.cpu / mp, out->wall += t.wall, out->all_cpu += all.cpu / mp;
        out->yards += bench_cell_yards(r, row, i, false), out->all_yards += bench_cell_yards(r, row, i, true);
    }
    out->scenes = n;
    if (n == 0) return;
    out->occlusion = sqrt(out->occlusion / n), out->radiance = sqrt(out->radiance / n), out->indirect = sqrt(out->indirect / n);
    out->a = with_a ? sqrt(out->a / with_a) : NAN;
    out->a_radiance = with_radiance ? sqrt(out->a_radiance / with_radiance) : NAN;
    out->a_indirect = with_indirect ? sqrt(out->a_indirect / with_indirect) : NAN;
    double *means[] = {&out->cpu, &out->wall, &out->all_cpu, &out->yards, &out->all_yards};
    for (size_t i = 0; i < sizeof means / sizeof *means; i++) *means[i] /= n;
}

void bench_summarise(const bench_results *r, int set, bench_summary *out)
{
    for (int i = 0; i < r->row_count; i++) summarise_row(r, i, set, &out[i]);
    for (int i = 0; i < r->row_count; i++) {
        out[i].front = bench_competes(&r->rows[i]);
        for (int k = 0; k < r->row_count; k++)
            if (bench_competes(&r->rows[k]) && out[k].yards < out[i].yards && out[k].occlusion <= out[i].occlusion)
                out[i].front = false;
        if (!isfinite(out[i].yards)) out[i].front = false;
    }
}
