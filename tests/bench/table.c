#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "bench.h"

static FILE *create(const char *dir, const char *name, char *path, size_t size, error *e)
{
    snprintf(path, size, "%s/%s", dir, name);
    FILE *f = fopen(path, "w");
    if (!f) err_set(e, ERR_OUTPUT, path, NULL, "cannot be written: %s", strerror(errno));
    return f;
}

static bool finish(FILE *f, const char *path, error *e)
{
    return fclose(f) == 0 || err_set(e, ERR_OUTPUT, path, NULL, "cannot be written: %s", strerror(errno));
}

// A figure, or a dash where there is none.
static const char *figure(char buf[32], const char *format, double v)
{
    if (!isfinite(v)) return "–";
    snprintf(buf, 32, format, v);
    return buf;
}

static void put(FILE *f, bool there, const char *format, double v)
{
    fputc(',', f);
    if (there && isfinite(v)) fprintf(f, format, v);
}

static void put_errors(FILE *f, const bench_cell *c)
{
    put(f, c->has_occlusion, "%.6f", c->occlusion.rmse);
    put(f, c->has_occlusion, "%.6f", c->occlusion.bias);
    put(f, c->has_occlusion, "%.6f", c->occlusion.p99);
    put(f, c->has_radiance, "%.6f", c->radiance.rmse / c->radiance.mean);
    put(f, c->has_radiance, "%.6f", c->radiance.bias / c->radiance.mean);
    put(f, c->has_indirect, "%.6f", c->indirect.rmse / c->indirect.mean);
    put(f, c->has_indirect, "%.6f", c->indirect.bias / c->indirect.mean);
    put(f, c->has_a, "%.6f", c->a_rmse);
    put(f, c->has_a, "%.6f", c->a_bias);
    put(f, c->has_a_radiance, "%.6f", c->a_radiance);
    put(f, c->has_a_indirect, "%.6f", c->a_indirect);
}

static void put_times(FILE *f, const bench_results *r, int row, int which)
{
    bool timed = r->rows[row].kind == ROW_METHOD;
    double mp = bench_megapixels(&r->scenes[which]), rmse = r->cells[row * r->scene_count + which].occlusion.rmse;
    bench_time t = bench_cell_time(r, row, which, false), all = bench_cell_time(r, row, which, true);
    double yards = bench_cell_yards(r, row, which, false);
    put(f, timed, "%.2f", t.cpu / mp);
    put(f, timed, "%.2f", t.wall);
    put(f, timed, "%.3f", yards);
    put(f, timed, "%.2f", all.cpu / mp);
    put(f, timed, "%.2f", all.wall);
    put(f, timed, "%.3f", bench_cell_yards(r, row, which, true));
    put(f, timed, "%.2f", 1.0 / (rmse * rmse * yards));
}

// bench.csv holds everything; errors.csv only what every run must repeat to the last digit.
bool bench_write_csv(const bench_results *r, const char *dir, error *e)
{
    for (int errors_only = 0; errors_only < 2; errors_only++) {
        char path[512];
        FILE *f = create(dir, errors_only ? "errors.csv" : "bench.csv", path, sizeof path, e);
        if (!f) return false;
        fprintf(f,
                "scene,method,samples,blur,occlusion_rmse,occlusion_bias,occlusion_p99,radiance_relative_rmse,"
                "radiance_relative_bias,indirect_relative_rmse,indirect_relative_bias,a_rmse,a_bias,a_radiance_relative_rmse,a_"
                "indirect_relative_rmse%s\n",
                errors_only
                    ? ""
                    : ",cpu_ms_per_mp,wall_ms,yards,all_layers_cpu_ms_per_mp,all_layers_wall_ms,all_layers_yards,efficiency");
        for (int s = 0; s < r->scene_count; s++)
            for (int i = 0; i < r->row_count; i++) {
                fprintf(f, "%s,\"%s\",%d,%d", r->scenes[s].s.name, r->rows[i].name, r->rows[i].samples, r->rows[i].blur);
                put_errors(f, &r->cells[i * r->scene_count + s]);
                if (!errors_only) put_times(f, r, i, s);
                fputc('\n', f);
            }
        if (!finish(f, path, e)) return false;
    }
    return true;
}

// ---- Markdown

static void budget_of(const bench_row *row, char buf[48])
{
    if (row->kind != ROW_METHOD)
        snprintf(buf, 48, "–");
    else
        snprintf(buf, 48, row->blur ? "%d + blur %d" : "%d", row->samples, row->blur);
}

static void summary_row(FILE *f, const bench_row *row, const bench_summary *s)
{
    char b[48], n[12][32];
    bool timed = row->kind == ROW_METHOD;
    budget_of(row, b);
    double yards = timed ? s->yards : NAN;
    fprintf(f, "| %s%s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s |\n", row->name, s->front ? " \\*" : "", b,
            figure(n[0], "%.3f", s->occlusion), figure(n[1], "%.3f", s->radiance), figure(n[2], "%.3f", s->indirect),
            figure(n[3], "%.4f", s->a), figure(n[9], "%.3f", s->a_radiance), figure(n[10], "%.3f", s->a_indirect),
            figure(n[4], "%.0f", timed ? s->cpu : NAN), figure(n[5], "%.1f", timed ? s->wall : NAN), figure(n[6], "%.2f", yards),
            figure(n[7], "%.2f", timed ? s->all_yards : NAN), figure(n[8], "%.1f", 1.0 / (s->occlusion * s->occlusion * yards)));
}

static void summary_table(FILE *f, const bench_results *r, int set, bool standard)
{
    bench_summary s[BENCH_ROWS];
    bench_summarise(r, set, s);
    if (s[0].scenes == 0) return;
    fprintf(f, "\n### %s, %s\n\n", set == SET_SAMPLES ? "Rendered scenes" : "Generated scenes",
            standard ? "each method as it ships" : "every budget");
    fprintf(f, "| method | samples | occlusion | radiance | indirect | A: occlusion | A: radiance | A: indirect | CPU ms/MP | "
               "wall ms | x yard | all layers, x yard | "
               "efficiency |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (int i = 0; i < r->row_count; i++)
        if (!standard || r->rows[i].standard) summary_row(f, &r->rows[i], &s[i]);
}

// Error of a method's blurred rows at a given time, between the two nearest (straight in the logarithms); NAN outside them.
static double error_at(const bench_results *r, const bench_summary *s, const char *name, double yards)
{
    int low = -1, high = -1;
    for (int i = 0; i < r->row_count; i++) {
        if (r->rows[i].blur == 0 || strcmp(r->rows[i].name, name) != 0 || !isfinite(s[i].yards)) continue;
        if (s[i].yards <= yards && (low < 0 || s[i].yards > s[low].yards)) low = i;
        if (s[i].yards >= yards && (high < 0 || s[i].yards < s[high].yards)) high = i;
    }
    if (low < 0 || high < 0) return NAN;
    if (low == high) return s[low].occlusion;
    double f = log(yards / s[low].yards) / log(s[high].yards / s[low].yards);
    return exp(log(s[low].occlusion) * (1.0 - f) + log(s[high].occlusion) * f);
}

static void equal_time(FILE *f, const bench_results *r)
{
    bench_summary s[BENCH_ROWS];
    bench_summarise(r, SET_SAMPLES, s);
    int shipped = -1;
    for (int i = 0; i < r->row_count; i++)
        if (shipped < 0 && r->rows[i].standard && r->rows[i].m == method_default()) shipped = i;
    if (shipped < 0 || s[0].scenes == 0) return;
    double yards = s[shipped].yards;
    fprintf(f,
            "\nOcclusion at the GL time of the default (%.1f yardsticks), with each method's blur, between its measured budgets:",
            yards);
    for (int i = 0; i < r->row_count; i++) {
        const bench_row *row = &r->rows[i];
        double v = row->kind == ROW_METHOD && row->standard ? error_at(r, s, row->name, yards) : NAN;
        if (isfinite(v)) fprintf(f, " %s %.4f;", row->name, v);
    }
    fprintf(f, " methods whose budgets do not reach that time are left out.\n");
}

static void scene_table(FILE *f, const bench_results *r, int which)
{
    const bench_scene *b = &r->scenes[which];
    fprintf(f, "\n### %s (%d x %d, radius %g)\n\n", b->s.name, b->gb.width, b->gb.height, b->radius);
    fprintf(
        f, "| method | samples | occlusion rmse | bias | 99 %% | radiance | indirect | A rmse | A bias | CPU ms/MP | wall ms | x "
           "yard | efficiency |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    for (int i = 0; i < r->row_count; i++) {
        const bench_cell *c = &r->cells[i * r->scene_count + which];
        char u[48], n[12][32];
        bool timed = r->rows[i].kind == ROW_METHOD;
        bench_time t = bench_cell_time(r, i, which, false);
        double rmse = c->has_occlusion ? c->occlusion.rmse : NAN, yards = timed ? bench_cell_yards(r, i, which, false) : NAN;
        budget_of(&r->rows[i], u);
        fprintf(f, "| %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s |\n", r->rows[i].name, u,
                figure(n[0], "%.4f", rmse), figure(n[1], "%+.4f", c->has_occlusion ? c->occlusion.bias : NAN),
                figure(n[2], "%.3f", c->has_occlusion ? c->occlusion.p99 : NAN),
                figure(n[3], "%.3f", c->has_radiance ? c->radiance.rmse / c->radiance.mean : NAN),
                figure(n[4], "%.3f", c->has_indirect ? c->indirect.rmse / c->indirect.mean : NAN),
                figure(n[5], "%.4f", c->has_a ? c->a_rmse : NAN), figure(n[6], "%+.4f", c->has_a ? c->a_bias : NAN),
                figure(n[7], "%.0f", timed ? t.cpu / bench_megapixels(b) : NAN), figure(n[8], "%.1f", timed ? t.wall : NAN),
                figure(n[9], "%.2f", yards), figure(n[10], "%.1f", 1.0 / (rmse * rmse * yards)));
    }
}

static void noise(FILE *f, const bench_results *r)
{
    double cpu[BENCH_SCENES * BENCH_ROUNDS], wall[BENCH_SCENES * BENCH_ROUNDS];
    int n = 0;
    for (int s = 0; s < r->timed_count; s++)
        for (int i = 0; i < r->rounds; i++, n++) {
            double mp = bench_megapixels(&r->scenes[s]);
            cpu[n] = r->yard[s][i].cpu / mp, wall[n] = r->yard[s][i].wall / mp;
        }
    fprintf(f,
            "Machine: %s. The yardstick took %.0f ms of CPU per megapixel (median of %d; p10 %.0f, p90 %.0f) and %.0f ms of wall "
            "time "
            "(p10 %.0f, p90 %.0f): ratios of time are good to about %.0f %%.\n",
            r->renderer, bench_median(cpu, n), n, bench_percentile(cpu, n, 0.1), bench_percentile(cpu, n, 0.9),
            bench_median(wall, n), bench_percentile(wall, n, 0.1), bench_percentile(wall, n, 0.9),
            50.0 * (bench_percentile(cpu, n, 0.9) - bench_percentile(cpu, n, 0.1)) / bench_median(cpu, n));
}

static void legend(FILE *f, const bench_results *r)
{
    fprintf(f, "# %s\n\nMade by `%s` in %.0f s.\n\n", r->title, r->command, r->seconds);
    noise(f, r);
    fprintf(f,
            "\nErrors are root mean squares over the scenes, free of the truth's own noise (mean((x - A)(x - B)) with two "
            "independent "
            "renders); radiance and indirect are relative to the mean of the truth. *A*: against the brute-force reference "
            "that makes the method's own assumptions on the same layers, at %d stratified pixels a scene (%d for the bounce of "
            "virtual lights). Times are of the GL work "
            "for "
            "occlusion alone (CPU time of the process; no upload, no read-back), medians of %d interleaved rounds (one, above %d "
            "samples), on the rendered scenes; *x yard* is in "
            "units of the yardstick, a 64-tap (8 x 8) texelFetch box over an R32F texture of the frame's size, run in the same "
            "round; "
            "*all layers* adds radiance and, where the method has one, its bounce. Efficiency is 1 / (occlusion rmse^2 x yards). "
            "\\*: on the Pareto front of error against time. *Middle third*: the picture cut to it, scored there, times "
            "scaled to a whole frame; with --proxies, what stands beside it is given as spheres. *--from-sh*: only the relight. "
            "*raytrace* is timed once.\n",
            BENCH_PIXELS, BENCH_VPL_PIXELS, r->rounds, BENCH_LONG);
    fprintf(f, "\nAlchemy's best single scale and contrast over these scenes: %.1f and %.2f.\n", r->alchemy_scale,
            r->alchemy_contrast);
    fprintf(f,
            "\nA frame nine tenths empty costs %.1f %% of the full frame's GL time (%s, its defaults, all layers; the limit is "
            "25).\n",
            100.0 * r->empty_ratio, method_default()->name);
}

bool bench_write_markdown(const bench_results *r, const char *dir, error *e)
{
    char path[512];
    FILE *f = create(dir, "bench.md", path, sizeof path, e);
    if (!f) return false;
    legend(f, r);
    for (int set = SET_SAMPLES; set <= SET_GENERATED; set++) summary_table(f, r, set, true);
    equal_time(f, r);
    for (int set = SET_SAMPLES; set <= SET_GENERATED; set++) summary_table(f, r, set, false);
    fprintf(f, "\n## Scene by scene\n");
    for (int s = 0; s < r->scene_count; s++) scene_table(f, r, s);
    return finish(f, path, e);
}
