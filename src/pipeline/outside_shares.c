#include "pipeline/outside_shares.h"

#include <math.h>

enum { ROUNDS = 10 };

// Samples that are off by more than this many times the root mean square count by their distance, not by its square (Huber 1964).
static const double OUTLIER = 3.0;
// The prior weighs as much as it is known: a share may be off it by DOUBT, root mean square. What the light leaves unexplained is
// alike over areas, not noise of single pixels, so a picture counts as this many samples.
static const double DOUBT = 0.5, AREAS = 256.0;

typedef struct normal_equations {
    double a[SHARE_UNKNOWNS][SHARE_UNKNOWNS], b[SHARE_UNKNOWNS];
} normal_equations;

typedef struct fit {
    const gbuffer *lit;
    float *const *column;
    shares *s;
} fit;

static double least(int k) { return k == SHARE_BOUNCE ? 0.5 : 0.0; }
static double most(int k) { return k == SHARE_BOUNCE ? 3.0 : 1.0; }

// Each unknown in turn, until nothing moves. The matrix is positive definite, so this converges. All but the suns' share.
static void solve(const normal_equations *n, double x[SHARE_UNKNOWNS])
{
    for (int round = 0; round < 500; round++)
        for (int i = 0; i < SHARE_UNKNOWNS; i++) {
            double sum = n->b[i];
            for (int k = 0; k < SHARE_UNKNOWNS; k++) sum -= k == i || k == SHARE_SUNS ? 0.0 : n->a[i][k] * x[k];
            if (i != SHARE_SUNS) x[i] = fmin(most(i), fmax(least(i), sum / n->a[i][i]));
        }
}

// Without suns.
static double predicted(const fit *f, size_t i)
{
    double sum = (double)f->column[SHARE_CLOSED][i];
    for (int k = 0; k < SHARE_UNKNOWNS; k++) sum += k == SHARE_SUNS ? 0.0 : f->s->x[k] * (double)f->column[k][i];
    return sum;
}

// What one round finds with the shares of the last one.
typedef struct sums {
    normal_equations n;
    double left, light, weight; // squares, times the weight; the weight
    double suns, all_suns;      // squares of suns' light: where they are seen, and of all
} sums;

// One pixel: r g b of its light before suns, as it is and as predicted, and that of its suns.
static void add_pixel(const fit *f, sums *t, size_t pixel, double limit)
{
    const float *beauty = f->lit->beauty + 4 * pixel;
    double weight = (double)beauty[3], light[3], off[3], dark = 0.0, bright = 0.0;
    if (!(f->lit->depth[pixel] > 0.0f) || weight <= 0.0) return;
    for (size_t c = 0; c < 3; c++) {
        double suns = (double)f->column[SHARE_SUNS][3 * pixel + c];
        light[c] = (double)beauty[c] / weight;
        off[c] = light[c] - predicted(f, 3 * pixel + c);
        dark += off[c] * off[c], bright += (off[c] - suns) * (off[c] - suns);
    }
    for (size_t c = 0; c < 3; c++) {
        size_t i = 3 * pixel + c;
        double suns = (double)f->column[SHARE_SUNS][i], seen = bright < dark ? suns : 0.0;
        double rest = light[c] - seen - (double)f->column[SHARE_CLOSED][i];
        double w = weight * fmin(1.0, limit / fmax(fabs(off[c] - seen), 1e-30));
        t->left += weight * (off[c] - seen) * (off[c] - seen), t->light += weight * light[c] * light[c], t->weight += weight;
        t->suns += seen * suns, t->all_suns += suns * suns;
        for (int k = 0; k < SHARE_UNKNOWNS; k++) {
            double wk = w * (double)f->column[k][i];
            t->n.b[k] += wk * rest;
            for (int l = 0; l < SHARE_UNKNOWNS; l++) t->n.a[k][l] += wk * (double)f->column[l][i];
        }
    }
}

void shares_fit(const gbuffer *lit, float *const column[SHARE_COLUMNS], const double prior[SHARE_UNKNOWNS], shares *s)
{
    const fit f = {lit, column, s};
    const size_t pixels = (size_t)lit->width * (size_t)lit->height;
    double limit = INFINITY;
    for (int round = 0; round <= ROUNDS; round++) {
        sums t = {0};
        for (size_t i = 0; i < pixels; i++) add_pixel(&f, &t, i, limit);
        s->unexplained = t.light > 0.0 ? sqrt(t.left / t.light) : 1.0;
        s->x[SHARE_SUNS] = t.all_suns > 0.0 ? t.suns / t.all_suns : prior[SHARE_SUNS];
        if (round == ROUNDS) break;
        limit = OUTLIER * sqrt(t.left / fmax(t.weight, 1.0));
        double prior_weight = t.left / (AREAS * DOUBT * DOUBT) + 1e-30;
        for (int k = 0; k < SHARE_UNKNOWNS; k++) t.n.a[k][k] += prior_weight, t.n.b[k] += prior_weight * prior[k];
        solve(&t.n, s->x);
    }
}
