// Error against time, drawn by gnuplot from a script with its data inside.
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"

// The curve a row belongs to: its name, blurred rows apart.
static bool same_curve(const bench_row *a, const bench_row *b)
{
    return a->kind == ROW_METHOD && b->kind == ROW_METHOD && strcmp(a->name, b->name) == 0 && (a->blur > 0) == (b->blur > 0);
}

typedef enum panel { PANEL_OCCLUSION, PANEL_RADIANCE, PANEL_INDIRECT, PANELS } panel;

static double error_of(const bench_summary *s, panel p)
{
    return p == PANEL_OCCLUSION ? s->occlusion : p == PANEL_RADIANCE ? s->radiance : s->indirect;
}
static double time_of(const bench_summary *s, panel p) { return p == PANEL_OCCLUSION ? s->yards : s->all_yards; }

static bool drawn(const bench_summary *s, panel p) { return isfinite(error_of(s, p)) && isfinite(time_of(s, p)); }

static void curve_data(FILE *f, const bench_results *r, const bench_summary *s, int first, panel p)
{
    fprintf(f, "$c%d_%d << END\n", (int)p, first);
    for (int i = first; i < r->row_count; i++)
        if (same_curve(&r->rows[first], &r->rows[i]) && drawn(&s[i], p))
            fprintf(f, "%.5f %.6f\n", time_of(&s[i], p), error_of(&s[i], p));
    fprintf(f, "END\n");
}

static bool starts_curve(const bench_results *r, const bench_summary *s, int i, panel p)
{
    if (r->rows[i].kind != ROW_METHOD || !drawn(&s[i], p)) return false;
    for (int k = 0; k < i; k++)
        if (same_curve(&r->rows[k], &r->rows[i]) && drawn(&s[k], p)) return false;
    return true;
}

// No other row is both cheaper and better.
static bool on_front(const bench_results *r, const bench_summary *s, int i, panel p)
{
    double x = time_of(&s[i], p), y = error_of(&s[i], p);
    if (r->rows[i].kind != ROW_METHOD || !drawn(&s[i], p)) return false;
    for (int k = 0; k < r->row_count; k++)
        if (r->rows[k].kind == ROW_METHOD && time_of(&s[k], p) < x && error_of(&s[k], p) <= y) return false;
    return true;
}

static void front_data(FILE *f, const bench_results *r, const bench_summary *s, panel p)
{
    double last = -1.0;
    fprintf(f, "$front%d << END\n", (int)p);
    for (;;) {
        int next = -1;
        for (int i = 0; i < r->row_count; i++)
            if (on_front(r, s, i, p) && time_of(&s[i], p) > last && (next < 0 || time_of(&s[i], p) < time_of(&s[next], p)))
                next = i;
        if (next < 0) break;
        last = time_of(&s[next], p);
        fprintf(f, "%.5f %.6f\n", last, error_of(&s[next], p));
    }
    fprintf(f, "END\n");
}

// Axes that just hold the panel's rows. gnuplot's own choice on logarithmic axes wastes half the room.
static void axes(FILE *f, const bench_results *r, const bench_summary *s, panel p)
{
    double x0 = INFINITY, x1 = 0.0, y0 = INFINITY, y1 = 0.0;
    for (int i = 0; i < r->row_count; i++) {
        if (isfinite(error_of(&s[i], p))) y0 = fmin(y0, error_of(&s[i], p)), y1 = fmax(y1, error_of(&s[i], p));
        if (r->rows[i].kind == ROW_METHOD && drawn(&s[i], p)) x0 = fmin(x0, time_of(&s[i], p)), x1 = fmax(x1, time_of(&s[i], p));
    }
    if (x1 > 0.0 && y1 > 0.0) fprintf(f, "set xrange [%g:%g]\nset yrange [%g:%g]\n", x0 / 1.3, x1 * 1.3, y0 / 1.1, y1 * 1.1);
    // Below the panels there is room for the longest key.
    fprintf(f, "set lmargin at screen %g\nset rmargin at screen %g\nset tmargin at screen 0.9\nset bmargin at screen 0.42\n",
            0.05 + 0.33 * (int)p, 0.31 + 0.33 * (int)p);
}

static void plot_panel(FILE *f, const bench_results *r, const bench_summary *s, panel p)
{
    static const char *titles[] = {"occlusion", "radiance", "indirect"};
    fprintf(f, "set title \"%s\"\nset ylabel \"%s rmse against path-traced truth\"\n", titles[p],
            p == PANEL_OCCLUSION ? "" : "relative");
    axes(f, r, s, p);
    fprintf(f, "plot $front%d using 1:2 with steps lw 6 lc rgb '#d8d8d8' title 'Pareto front'", (int)p);
    for (int i = 0, colour = 1; i < r->row_count; i++) {
        if (!starts_curve(r, s, i, p)) continue;
        fprintf(f, ", $c%d_%d using 1:2 smooth unique with linespoints lw 1.5 pt %d ps 0.8 lc %d dt %d title '%s%s'", (int)p, i,
                r->rows[i].blur ? 4 : 7, colour, r->rows[i].blur ? 2 : 1, r->rows[i].name, r->rows[i].blur ? ", with blur" : "");
        colour++;
    }
    for (int i = 0; i < r->row_count; i++)
        if (r->rows[i].kind != ROW_METHOD && isfinite(error_of(&s[i], p)))
            fprintf(f, ", %.6f with lines lw 1 dt 3 lc rgb '#888888' title '%s'", error_of(&s[i], p), r->rows[i].name);
    fprintf(f, ", $front%d using 1:2 with points pt 6 ps 1.7 lc rgb '#000000' notitle\n", (int)p);
}

static void script(FILE *f, const bench_results *r, const bench_summary *s)
{
    for (int p = 0; p < PANELS; p++) {
        front_data(f, r, s, (panel)p);
        for (int i = 0; i < r->row_count; i++)
            if (starts_curve(r, s, i, (panel)p)) curve_data(f, r, s, i, (panel)p);
    }
    fprintf(f, "set grid lc rgb '#eeeeee'\nset border lc rgb '#444444'\nset logscale xy\nset xtics nomirror\nset ytics nomirror\n"
               "set ytics (0.02, 0.03, 0.04, 0.05, 0.07, 0.1, 0.14, 0.2, 0.3, 0.4, 0.5, 0.7, 1, 1.4, 2)\n"
               "set key outside below center vertical Left reverse samplen 2 maxcols 1\n");
    fprintf(f,
            "set xlabel \"GL time of the frame in yardsticks\"\nset multiplot layout 1,%d title \"%s: error against time, root "
            "mean square over the scenes\"\n",
            PANELS, r->title);
    for (int p = 0; p < PANELS; p++) plot_panel(f, r, s, (panel)p);
    fprintf(f, "unset multiplot\n");
}

static bool draw(const bench_results *r, const bench_summary *s, const char *terminal, const char *path, error *e)
{
    FILE *f = popen("gnuplot", "w");
    if (!f) return err_set(e, ERR_OUTPUT, path, NULL, "gnuplot cannot be started; `make deps-bench` installs it");
    fprintf(f, "set terminal %s\nset output '%s'\nset encoding utf8\n", terminal, path);
    script(f, r, s);
    return pclose(f) == 0 || err_set(e, ERR_OUTPUT, path, NULL, "gnuplot failed; `make deps-bench` installs it");
}

bool bench_write_plot(const bench_results *r, const char *dir, error *e)
{
    static bench_summary s[BENCH_ROWS];
    char path[512];
    bench_summarise(r, SET_SAMPLES, s);
    if (s[0].scenes == 0) bench_summarise(r, SET_GENERATED, s);
    snprintf(path, sizeof path, "%s/bench.svg", dir);
    if (!draw(r, s, "svg size 1600,1000 font 'sans-serif,14' background '#ffffff' noenhanced", path, e)) return false;
    snprintf(path, sizeof path, "%s/bench.png", dir);
    return draw(r, s, "pngcairo size 1600,1000 font 'sans-serif,11' background '#ffffff' noenhanced", path, e);
}
