// truth_check OLD NEW [SPP]: whether the scenes of folder NEW, rendered by samples/render.py with SPP samples a pixel (384), are
// those of OLD: the same surfaces, and light that differs by no more than the renderer's noise. Exits 1 if not.
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sample.h"

enum { COMMITTED_SPP = 384 };

typedef struct difference {
    double rms, mean;
} difference;

static difference compare(const sample *s, const float *x, const float *y, int channels)
{
    difference d = {0};
    double n = 0.0;
    for (int i = 0; i < s->width * s->height; i++)
        for (int k = 0; k < channels && sample_is_surface(s, i); k++) {
            double v = (double)x[i * channels + k] - (double)y[i * channels + k];
            d.rms += v * v, d.mean += v, n += 1.0;
        }
    d.rms = sqrt(d.rms / n), d.mean /= n;
    return d;
}

// The noise of one render is rms(A - B) / sqrt 2 and falls with the root of its samples; a fifth is left for the tails.
static bool layer_agrees(const char *what, const sample *s, float *const old[2], float *const new[2], int channels, double spp)
{
    double noise = compare(s, old[0], old[1], channels).rms / sqrt(2.0);
    double limit = 1.2 * noise * sqrt(1.0 + COMMITTED_SPP / spp);
    bool good = true;
    for (int half = 0; half < 2; half++) {
        difference d = compare(s, new[half], old[half], channels);
        bool ok = d.rms <= limit && fabs(d.mean) <= 0.1 * limit;
        printf("%-8s %-8s render %c: rms difference %.5f, mean %+.6f; noise allows %.5f%s\n", s->name, what, 'A' + half, d.rms,
               d.mean, limit, ok ? "" : "  <-- differs");
        good = good && ok;
    }
    return good;
}

static bool surfaces_agree(const sample *a, const sample *b)
{
    long n = (long)a->width * a->height, differ = 0;
    if (a->width != b->width || a->height != b->height) return printf("%s: another size\n", a->name), false;
    for (long i = 0; i < n; i++) differ += !(fabs((double)a->depth[i] - (double)b->depth[i]) <= 1e-4 * fabs((double)a->depth[i]));
    printf("%-8s depth    %ld of %ld pixels differ\n", a->name, differ, n);
    return differ * 1000 <= n;
}

static bool scene_agrees(sample *old, sample *new, double spp, error *e)
{
    if (!sample_load(old, e) || !sample_load(new, e)) return false;
    bool good = surfaces_agree(old, new);
    good = good && layer_agrees("AO", old, old->ao, new->ao, 1, spp);
    good = layer_agrees("DiffDir", old, old->direct, new->direct, 3, spp) && good;
    good = layer_agrees("DiffInd", old, old->indirect, new->indirect, 3, spp) && good;
    sample_free(old);
    sample_free(new);
    return good;
}

int main(int argc, char **argv)
{
    static sample old[SAMPLE_MAX], new[SAMPLE_MAX];
    error e = {0};
    char text[1600];
    setlocale(LC_NUMERIC, "C");
    if (argc < 3) return fprintf(stderr, "usage: truth_check OLD NEW [SPP]\n"), 2;
    double spp = argc > 3 ? atof(argv[3]) : COMMITTED_SPP;
    int olds = samples_list(argv[1], old, SAMPLE_MAX, &e), news = samples_list(argv[2], new, SAMPLE_MAX, &e), met = 0;
    bool good = true;
    for (int i = 0; i < news; i++)
        for (int k = 0; k < olds; k++)
            if (strcmp(old[k].name, new[i].name) == 0) good = scene_agrees(&old[k], &new[i], spp, &e) && good, met++;
    if (e.code != ERR_NONE) {
        err_format(&e, text, sizeof text);
        fprintf(stderr, "truth_check: %s\n", text);
    }
    printf("%d scenes compared: %s\n", met, good && met ? "the same within the renderer's noise" : "NOT the same");
    return !(good && met);
}
