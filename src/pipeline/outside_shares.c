#include "pipeline/outside_shares.h"

#include <math.h>

enum {
    ROUNDS = 10,
    AREA = 8 // pixels on a side: what is left unexplained is measured over areas, where the noise of the picture averages out
};

// Samples that are off by more than this many times the root mean square count by their distance, not by its square (Huber 1964).
static const double OUTLIER = 3.0;
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
    double squares, weight;    // of single pixels: what is left, squared, times the weight; the weight
    double left, light, areas; // of areas: squares of what is left and of the light, times the weight; how many there are
    double suns, all_suns;     // squares of suns' light: where they are seen, and of all
} sums;

typedef struct area {
    double left[3], light[3], weight; // times the weight
} area;

// One pixel: its light, what is left of it, and whether that is less with suns.
static void add_pixel(const fit *f, sums *t, area *in, size_t pixel, double limit)
{
    const float *beauty = f->lit->beauty + 4 * pixel;
    double weight = (double)beauty[3], light[3], off[3], dark = 0.0, bright = 0.0;
    if (!(f->lit->depth[pixel] > 0.0f) || weight <= 0.0) return;
    in->weight += weight, t->weight += 3.0 * weight;
    for (size_t c = 0; c < 3; c++) {
        double suns = (double)f->column[SHARE_SUNS][3 * pixel + c];
        light[c] = (double)beauty[c] / weight;
        off[c] = light[c] - predicted(f, 3 * pixel + c);
        dark += off[c] * off[c], bright += (off[c] - suns) * (off[c] - suns);
    }
    for (size_t c = 0; c < 3; c++) {
        size_t i = 3 * pixel + c;
        double suns = (double)f->column[SHARE_SUNS][i], seen = bright < dark ? suns : 0.0, left = off[c] - seen;
        double rest = light[c] - seen - (double)f->column[SHARE_CLOSED][i];
        double w = weight * fmin(1.0, limit / fmax(fabs(left), 1e-30));
        in->left[c] += weight * left, in->light[c] += weight * light[c];
        t->squares += weight * left * left;
        t->suns += seen * suns, t->all_suns += suns * suns;
        for (int k = 0; k < SHARE_UNKNOWNS; k++) {
            double wk = w * (double)f->column[k][i];
            t->n.b[k] += wk * rest;
            for (int l = 0; l < SHARE_UNKNOWNS; l++) t->n.a[k][l] += wk * (double)f->column[l][i];
        }
    }
}

static void add_area(const fit *f, sums *t, int left, int top, double limit)
{
    area in = {0};
    for (int y = top; y < top + AREA && y < f->lit->height; y++)
        for (int x = left; x < left + AREA && x < f->lit->width; x++)
            add_pixel(f, t, &in, (size_t)y * (size_t)f->lit->width + (size_t)x, limit);
    if (in.weight <= 0.0) return;
    t->areas += 1.0;
    for (int c = 0; c < 3; c++) {
        t->left += in.left[c] * in.left[c] / in.weight;
        t->light += in.light[c] * in.light[c] / in.weight;
    }
}

// Each area counts as one sample of what is left. A share is the mean of what is open or closed, so that its mean square about
// the prior is at most p (1 - p); the bounce's is a guess.
static void add_prior(sums *t, const double prior[SHARE_UNKNOWNS])
{
    const double least_doubt = 0.01, bounce_doubt = 0.25;
    for (int k = 0; k < SHARE_UNKNOWNS; k++) {
        double doubt = k == SHARE_BOUNCE ? bounce_doubt : fmax(prior[k] * (1.0 - prior[k]), least_doubt);
        double weight = t->left / (fmax(t->areas, 1.0) * doubt) + 1e-30;
        t->n.a[k][k] += weight, t->n.b[k] += weight * prior[k];
    }
}

void shares_fit(const gbuffer *lit, float *const column[SHARE_COLUMNS], const double prior[SHARE_UNKNOWNS], shares *s)
{
    const fit f = {lit, column, s};
    double limit = INFINITY;
    for (int round = 0; round <= ROUNDS; round++) {
        sums t = {0};
        for (int y = 0; y < lit->height; y += AREA)
            for (int x = 0; x < lit->width; x += AREA) add_area(&f, &t, x, y, limit);
        s->unexplained = t.light > 0.0 ? sqrt(t.left / t.light) : 1.0;
        s->x[SHARE_SUNS] = t.all_suns > 0.0 ? t.suns / t.all_suns : prior[SHARE_SUNS];
        if (round == ROUNDS) break;
        limit = OUTLIER * sqrt(t.squares / fmax(t.weight, 1.0));
        add_prior(&t, prior);
        solve(&t.n, s->x);
    }
}

// ---- an open sky

typedef struct products {
    double light, open;              // times the weight
    double squares, mixed, of_light; // of areas: open x open, open x light, light x light; times the weight
} products;

static void compare_area(const gbuffer *lit, const float *open, products *p, int left, int top)
{
    double weight = 0.0, of_light[3] = {0}, of_open[3] = {0};
    for (int y = top; y < top + AREA && y < lit->height; y++)
        for (int x = left; x < left + AREA && x < lit->width; x++) {
            size_t i = (size_t)y * (size_t)lit->width + (size_t)x;
            double w = (double)lit->beauty[4 * i + 3];
            if (!(lit->depth[i] > 0.0f) || w <= 0.0) continue;
            weight += w;
            for (size_t c = 0; c < 3; c++)
                of_light[c] += (double)lit->beauty[4 * i + c], of_open[c] += w * (double)open[3 * i + c];
        }
    for (int c = 0; c < 3 && weight > 0.0; c++) {
        p->light += of_light[c], p->open += of_open[c];
        p->squares += of_open[c] * of_open[c] / weight;
        p->mixed += of_open[c] * of_light[c] / weight;
        p->of_light += of_light[c] * of_light[c] / weight;
    }
}

light_comparison shares_compare(const gbuffer *lit, const float *open)
{
    products p = {0};
    for (int y = 0; y < lit->height; y += AREA)
        for (int x = 0; x < lit->width; x += AREA) compare_area(lit, open, &p, x, y);
    double alike = p.squares > 0.0 && p.of_light > 0.0 ? p.mixed * p.mixed / (p.squares * p.of_light) : 0.0;
    return (light_comparison){p.open > 0.0 ? p.light / p.open : 1.0, sqrt(fmax(0.0, 1.0 - alike))};
}
