// Scores files that the program wrote from rendered scenes (samples/render.py) against their path-traced truth.
//
//     score DIR list          a line for each scene of DIR/scenes.json: name, file, environment, its turn, AO distance
//     score DIR OUT [NAME...]  Markdown: a row for each scene with a file OUT/NAME.exr, then the mean and the worst of all
//
// Occlusion: root mean square error and bias. Light: the root mean square error over the truth's own root mean square, so that a
// black picture has 1 also where a scene is dark; the same over the truth's mean; the ratio of the means; and the median of the
// pixels' relative error. The truth's noise is left out (tests/lib/sample.h).
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "sample.h"

enum { LIGHTS = 2 };
static const char *const light_layers[LIGHTS] = {"radiance", "indirect"};

typedef struct light_score {
    double over_rms, over_mean, means, median;
} light_score;

typedef struct scene_score {
    double occlusion, bias, edges, inside;
    light_score light[LIGHTS];
} scene_score;

static double luminance_of(const float *c) { return luminance((double)c[0], (double)c[1], (double)c[2]); }

// Of |x - t| / t in luminance, t the mean of the two renders.
static double median_error(const sample *s, const float *x, const float *a, const float *b)
{
    size_t n = (size_t)s->width * (size_t)s->height, kept = 0;
    double *errors = malloc(n * sizeof *errors), median = NAN;
    for (size_t i = 0; errors && i < n; i++) {
        double t = 0.5 * (luminance_of(a + 3 * i) + luminance_of(b + 3 * i));
        if (sample_is_surface(s, (int)i) && t > 0.0) errors[kept++] = fabs(luminance_of(x + 3 * i) - t) / t;
    }
    if (kept > 0) {
        sort_doubles(errors, kept);
        median = errors[kept / 2];
    }
    free(errors);
    return median;
}

static light_score score_light(const sample *s, const float *x, float *const truth[2])
{
    score r = sample_score(s, x, truth[0], truth[1], 3);
    double rms = sqrt(r.mean * r.mean + r.constant_rmse * r.constant_rmse);
    return (light_score){r.rmse / rms, r.rmse / r.mean, 1.0 + r.bias / r.mean, median_error(s, x, truth[0], truth[1])};
}

// Whether the depth steps by more than this share between the pixel and one beside it.
static const double STEP = 0.05;

static bool is_edge(const sample *s, int i)
{
    int x = i % s->width, y = i / s->width;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            int u = x + dx, v = y + dy;
            if (u < 0 || v < 0 || u >= s->width || v >= s->height) continue;
            double a = (double)s->depth[i], b = (double)s->depth[v * s->width + u];
            if (fabs(a - b) > STEP * fmin(a, b)) return true;
        }
    return false;
}

static double occlusion_where(const sample *s, const float *x, bool edges)
{
    double sum = 0.0, n = 0.0;
    for (int i = 0; i < s->width * s->height; i++) {
        if (!sample_is_surface(s, i) || is_edge(s, i) != edges) continue;
        sum += ((double)x[i] - (double)s->ao[0][i]) * ((double)x[i] - (double)s->ao[1][i]), n += 1.0;
    }
    return n > 0.0 ? sqrt(fmax(0.0, sum / n)) : 0.0;
}

static bool score_scene(sample *s, const char *path, scene_score *r, error *e)
{
    if (!sample_load(s, e)) return false;
    float *occlusion = sample_read(path, "occlusion", "R", e);
    if (occlusion) {
        score o = sample_score(s, occlusion, s->ao[0], s->ao[1], 1);
        r->occlusion = o.rmse, r->bias = o.bias;
        r->edges = occlusion_where(s, occlusion, true), r->inside = occlusion_where(s, occlusion, false);
    }
    float *const *truths[LIGHTS] = {s->direct, s->indirect};
    for (int k = 0; k < LIGHTS && e->code == ERR_NONE; k++) {
        float *x = sample_read(path, light_layers[k], "RGB", e);
        if (x) r->light[k] = score_light(s, x, truths[k]);
        free(x);
    }
    free(occlusion);
    sample_free(s);
    return e->code == ERR_NONE;
}

static void print_row(const char *name, const scene_score *r)
{
    printf("| %s | %.4f | %+.4f | %.4f | %.4f |", name, r->occlusion, r->bias, r->edges, r->inside);
    for (int k = 0; k < LIGHTS; k++)
        printf(" %.3f | %.3f | %.2f | %.2f |", r->light[k].over_rms, r->light[k].over_mean, r->light[k].means,
               r->light[k].median);
    putchar('\n');
}

// The figures as one list, for means and worst cases; a ratio of means is worst where it is furthest from 1, either way.
static void take(scene_score *mean, scene_score *worst, const scene_score *r, int count)
{
    double *m = &mean->occlusion, *w = &worst->occlusion;
    const double *v = &r->occlusion;
    for (size_t i = 0; i < sizeof *r / sizeof(double); i++) {
        m[i] += v[i] / count;
        bool is_means = v + i == &r->light[0].means || v + i == &r->light[1].means;
        bool worse = is_means ? fabs(log(v[i])) > fabs(log(w[i])) : fabs(v[i]) > fabs(w[i]);
        if (w[i] == 0.0 || worse) w[i] = v[i];
    }
}

static bool is_named(const char *name, char **names, int count)
{
    bool named = count == 0;
    for (int i = 0; i < count; i++) named = named || strcmp(names[i], name) == 0;
    return named;
}

static bool score_all(sample *scenes, int n, const char *out, char **names, int name_count, error *e)
{
    scene_score all[SAMPLE_MAX] = {0}, mean = {0}, worst = {0};
    char path[512];
    int count = 0;
    printf(
        "| scene | occlusion | bias | at edges | elsewhere | radiance / rms | / mean | ratio | median | indirect / rms | / mean "
        "| ratio | median |\n| --- |%s\n",
        " ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for (int i = 0; i < n; i++) {
        if (snprintf(path, sizeof path, "%s/%s.exr", out, scenes[i].name) >= (int)sizeof path)
            return err_set(e, ERR_USAGE, out, NULL, "the folder's name is too long");
        FILE *f = is_named(scenes[i].name, names, name_count) ? fopen(path, "rb") : NULL;
        if (!f) continue;
        fclose(f);
        if (!score_scene(&scenes[i], path, &all[count], e)) return false;
        print_row(scenes[i].name, &all[count++]);
    }
    if (count == 0) return err_set(e, ERR_INPUT, out, NULL, "no file here is of a scene");
    for (int i = 0; i < count; i++) take(&mean, &worst, &all[i], count);
    print_row("mean", &mean);
    print_row("worst", &worst);
    return true;
}

int main(int argc, char **argv)
{
    static sample scenes[SAMPLE_MAX];
    error e = {0};
    char text[1600];
    setlocale(LC_NUMERIC, "C");
    if (argc < 3) return fprintf(stderr, "usage: score DIR list | score DIR OUT [NAME...]\n"), 2;
    int n = samples_list(argv[1], scenes, SAMPLE_MAX, &e);
    bool ok = n > 0;
    if (ok && strcmp(argv[2], "list") == 0)
        for (int i = 0; i < n; i++)
            printf("%s %s %s %g %g\n", scenes[i].name, scenes[i].file, scenes[i].env, scenes[i].env_rotate,
                   scenes[i].ao_distance);
    else if (ok)
        ok = score_all(scenes, n, argv[2], argv + 3, argc - 3, &e);
    if (ok) return 0;
    err_format(&e, text, sizeof text);
    fprintf(stderr, "score: %s\n", text);
    return 1;
}
