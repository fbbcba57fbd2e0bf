// Error against time, drawn by gnuplot from a script with its data inside (kept as bench.gp).
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"

typedef enum panel { PANEL_OCCLUSION, PANEL_RADIANCE, PANEL_INDIRECT, PANELS } panel;

static const char *const colours[] = {"#d62728", "#1f77b4", "#ff7f0e", "#8c564b", "#7f7f7f",
                                      "#17becf", "#2ca02c", "#9467bd", "#bcbd22", "#e377c2"};
enum { COLOURS = sizeof colours / sizeof *colours };
static const char RAYTRACE_COLOUR[] = "#000000";

static double error_of(const bench_summary *s, panel p)
{
    return p == PANEL_OCCLUSION ? s->occlusion : p == PANEL_RADIANCE ? s->radiance : s->indirect;
}
static double time_of(const bench_summary *s, panel p) { return p == PANEL_OCCLUSION ? s->yards : s->all_yards; }

static bool drawn(const bench_row *row, const bench_summary *s, panel p)
{
    return bench_competes(row) && isfinite(error_of(s, p)) && isfinite(time_of(s, p));
}

// One colour a method; its variants share it. Rows with blur are a curve of their own.
static const char *colour_of(const method *m)
{
    int place = 0;
    for (const method *other = method_next(NULL, SEES_PICTURE); other && other != m; other = method_next(other, SEES_PICTURE))
        place++;
    return m->source == SEES_MESH ? RAYTRACE_COLOUR : colours[place % COLOURS];
}
static bool is_variant(const bench_row *row) { return strcmp(row->name, row->m->name) != 0; }
static bool same_curve(const bench_row *a, const bench_row *b)
{
    return a->kind == b->kind && strcmp(a->name, b->name) == 0 && (a->blur > 0) == (b->blur > 0);
}

static bool starts_curve(const bench_results *r, const bench_summary *s, int i, panel p)
{
    for (int k = 0; k < i; k++)
        if (same_curve(&r->rows[k], &r->rows[i]) && drawn(&r->rows[k], &s[k], p)) return false;
    return drawn(&r->rows[i], &s[i], p);
}

static void curve_data(FILE *f, const bench_results *r, const bench_summary *s, int first, panel p)
{
    fprintf(f, "$c%d_%d << END\n", (int)p, first);
    for (int i = first; i < r->row_count; i++)
        if (same_curve(&r->rows[first], &r->rows[i]) && drawn(&r->rows[i], &s[i], p))
            fprintf(f, "%.5f %.6f\n", time_of(&s[i], p), error_of(&s[i], p));
    fprintf(f, "END\n");
}

// No other row is both cheaper and better.
static bool on_front(const bench_results *r, const bench_summary *s, int i, panel p)
{
    if (!drawn(&r->rows[i], &s[i], p)) return false;
    for (int k = 0; k < r->row_count; k++)
        if (drawn(&r->rows[k], &s[k], p) && time_of(&s[k], p) < time_of(&s[i], p) && error_of(&s[k], p) <= error_of(&s[i], p))
            return false;
    return true;
}

// From the left to the right.
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

static void set_range(FILE *f, const bench_results *r, const bench_summary *s, panel p)
{
    double x0 = INFINITY, x1 = 0.0, y0 = INFINITY, y1 = 0.0;
    for (int i = 0; i < r->row_count; i++) {
        double y = error_of(&s[i], p);
        if (isfinite(y)) y0 = fmin(y0, y), y1 = fmax(y1, y);
        if (drawn(&r->rows[i], &s[i], p)) x0 = fmin(x0, time_of(&s[i], p)), x1 = fmax(x1, time_of(&s[i], p));
    }
    if (x1 > 0.0) fprintf(f, "set xrange [%g:%g]\nset yrange [%g:%g]\n", 0.7 * x0, 1.5 * x1, 0.88 * y0, 1.12 * y1);
}

static void plot_panel(FILE *f, const bench_results *r, const bench_summary *s, panel p)
{
    static const char *titles[] = {"occlusion", "radiance (relative)", "indirect (relative)"};
    double left = 0.05 + 0.325 * p;
    fprintf(f, "set lmargin at screen %g\nset rmargin at screen %g\nset title '%s'\n", left, left + 0.285, titles[p]);
    fprintf(f, "set xlabel '%s'\n",
            p == PANEL_OCCLUSION ? "GL time of occlusion, yardsticks" : "GL time of all layers, yardsticks");
    fprintf(f, "set ylabel '%s' offset 1\n", p == PANEL_OCCLUSION ? "rmse against path-traced truth" : "");
    set_range(f, r, s, p);
    fprintf(f, "unset label\n");
    for (int i = 0; i < r->row_count; i++)
        if (r->rows[i].kind != ROW_METHOD && isfinite(error_of(&s[i], p)))
            fprintf(f, "set label '%s' at graph %s, first %.6f %s offset 0,0.5 tc rgb '#666666' font ',10'\n", r->rows[i].name,
                    p == PANEL_OCCLUSION ? "0.99" : "0.01", error_of(&s[i], p), p == PANEL_OCCLUSION ? "right" : "left");
    fprintf(f, "plot $front%d using 1:2 with steps lw 7 lc rgb '#e4e4e4' notitle", (int)p);
    for (int i = 0; i < r->row_count; i++)
        if (starts_curve(r, s, i, p))
            fprintf(f, ", $c%d_%d using 1:2 smooth unique with linespoints lw %g pt %d ps 0.7 lc rgb '%s' dt %d notitle", (int)p,
                    i, is_variant(&r->rows[i]) ? 0.8 : 1.8, r->rows[i].blur ? 4 : 7, colour_of(r->rows[i].m),
                    r->rows[i].blur           ? 2
                    : is_variant(&r->rows[i]) ? 3
                                              : 1);
    for (int i = 0; i < r->row_count; i++)
        if (r->rows[i].kind != ROW_METHOD && isfinite(error_of(&s[i], p)))
            fprintf(f, ", %.6f with lines lw 1 dt 4 lc rgb '#666666' notitle", error_of(&s[i], p));
    fprintf(f, ", $front%d using 1:2 with points pt 6 ps 1.5 lw 1.2 lc rgb '#000000' notitle\n", (int)p);
}

// A legend for all panels: an empty plot whose key lies along the bottom.
static void legend_of(FILE *f, const bench_results *r, const method *m)
{
    bool used = false;
    for (int i = 0; i < r->row_count; i++) used |= r->rows[i].m == m;
    if (used) fprintf(f, "NaN with linespoints lw 1.8 pt 7 ps 0.7 lc rgb '%s' title '%s', ", colour_of(m), m->name);
}

static void legend(FILE *f, const bench_results *r)
{
    fprintf(f,
            "unset label\nset lmargin at screen 0.05\nset rmargin at screen 0.985\nset title ''\nset xlabel ''\nset ylabel ''\n"
            "unset tics\nunset border\nset key at screen 0.5, 0.10 center center horizontal maxrows 2 samplen 2 width 2\n"
            "set xrange [1:2]\nset yrange [1:2]\nplot ");
    for (const method *m = method_next(NULL, SEES_PICTURE); m; m = method_next(m, SEES_PICTURE)) legend_of(f, r, m);
    legend_of(f, r, method_find("raytrace"));
    fprintf(f, "NaN with linespoints lw 1.8 pt 4 ps 0.7 dt 2 lc rgb '#000000' title 'with its blur', "
               "NaN with linespoints lw 0.8 pt 7 ps 0.7 dt 3 lc rgb '#000000' title 'variant of a method', "
               "NaN with points pt 6 ps 1.5 lc rgb '#000000' title 'Pareto front'\n");
}

static void script(FILE *f, const bench_results *r, const bench_summary *s)
{
    for (int p = 0; p < PANELS; p++) {
        front_data(f, r, s, (panel)p);
        for (int i = 0; i < r->row_count; i++)
            if (starts_curve(r, s, i, (panel)p)) curve_data(f, r, s, i, (panel)p);
    }
    fprintf(
        f, "set encoding utf8\nset grid lc rgb '#eeeeee'\nset border 3 lc rgb '#444444'\nset logscale xy\nset xtics nomirror\n"
           "set ytics nomirror (0.02, 0.03, 0.04, 0.05, 0.06, 0.08, 0.1, 0.12, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1, 1.2, "
           "1.5, 2)\nset key off\nset tmargin at screen 0.88\nset bmargin at screen 0.24\n");
    fprintf(f, "set multiplot title '%s: error against time, root mean square over the scenes'\n", r->title);
    for (int p = 0; p < PANELS; p++) plot_panel(f, r, s, (panel)p);
    legend(f, r);
    fprintf(f, "unset multiplot\n");
}

static bool draw(const bench_results *r, const bench_summary *s, const char *terminal, const char *dir, const char *name,
                 error *e)
{
    char path[512], command[560];
    snprintf(path, sizeof path, "%s/bench.gp", dir);
    FILE *f = fopen(path, "w");
    if (!f) return err_set(e, ERR_OUTPUT, path, NULL, "cannot be written: %s", strerror(errno));
    fprintf(f, "set terminal %s size 1500,640 background '#ffffff' noenhanced\nset output '%s/%s'\n", terminal, dir, name);
    script(f, r, s);
    bool written = fclose(f) == 0;
    snprintf(command, sizeof command, "gnuplot '%s'", path);
    if (written && system(command) == 0) return true;
    return err_set(e, ERR_OUTPUT, path, NULL, "gnuplot cannot draw this; `make deps-bench` installs it");
}

// The rendered scenes; without any, nothing was timed but the generated ones.
bool bench_write_plot(const bench_results *r, const char *dir, error *e)
{
    static bench_summary s[BENCH_ROWS];
    bench_summarise(r, SET_SAMPLES, s);
    if (s[0].scenes == 0) bench_summarise(r, SET_GENERATED, s);
    return draw(r, s, "svg font 'sans-serif,13'", dir, "bench.svg", e) &&
           draw(r, s, "pngcairo font 'sans-serif,11'", dir, "bench.png", e);
}
