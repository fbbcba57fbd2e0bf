// The shares of an outside, found in light that is made of them.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "pipeline/outside_shares.h"

enum { W = 48, H = 32, PIXELS = W * H };

typedef struct picture {
    gbuffer lit;
    float beauty[4 * PIXELS], depth[PIXELS], columns[SHARE_COLUMNS][3 * PIXELS];
    float *column[SHARE_COLUMNS];
    double truth[SHARE_UNKNOWNS];
} picture;

// What each side sends is a wave over the picture, no two of them alike; suns light the upper half.
static void paint(picture *p)
{
    p->lit = (gbuffer){.width = W, .height = H, .beauty = p->beauty, .depth = p->depth};
    for (int k = 0; k < SHARE_COLUMNS; k++) {
        p->column[k] = p->columns[k];
        for (int i = 0; i < PIXELS; i++) {
            int row = i / W;
            double x = (i % W + 0.5) / W, y = (row + 0.5) / H;
            double wave = 1.0 + sin(2.0 * M_PI * ((k % 5 + 1) * x + (k / 5) * y) + k);
            double value = k == SHARE_CLOSED ? 0.02 : k == SHARE_SUNS ? (y < 0.5 ? 8.0 : 0.0) : 0.2 * wave;
            for (int c = 0; c < 3; c++) p->columns[k][3 * i + c] = (float)(value * (1.0 + 0.1 * c));
        }
    }
    for (int k = 0; k < SHARE_UNKNOWNS; k++) p->truth[k] = k == SHARE_BOUNCE ? 1.5 : k % 4 == 0 ? 0.6 : 0.05;
}

// Its light; the suns shine where `patch` wide and `patch` high pixels lie in the upper left corner.
static void light(picture *p, int patch)
{
    for (int i = 0; i < PIXELS; i++) {
        bool sunny = i % W < patch && i / W < patch;
        p->depth[i] = 1.0f;
        p->beauty[4 * i + 3] = 1.0f;
        for (int c = 0; c < 3; c++) {
            double sum = (double)p->columns[SHARE_CLOSED][3 * i + c];
            for (int k = 0; k < SHARE_UNKNOWNS; k++)
                sum += (k == SHARE_SUNS ? (double)sunny : p->truth[k]) * (double)p->columns[k][3 * i + c];
            p->beauty[4 * i + c] = (float)sum;
        }
    }
}

static shares fit(const picture *p)
{
    shares s;
    double prior[SHARE_UNKNOWNS];
    for (int k = 0; k < SHARE_UNKNOWNS; k++) s.x[k] = prior[k] = k == SHARE_BOUNCE ? 1.0 : 0.1;
    shares_fit(&p->lit, p->column, prior, &s);
    return s;
}

static double worst(const picture *p, const shares *s)
{
    double off = 0.0;
    for (int k = 0; k < SHARE_UNKNOWNS; k++)
        if (k != SHARE_SUNS) off = fmax(off, fabs(s->x[k] - p->truth[k]));
    return off;
}

static void shares_come_back(void **state)
{
    (void)state;
    static picture p;
    paint(&p);
    light(&p, 0);
    shares s = fit(&p);
    assert_true(worst(&p, &s) < 0.01);
    assert_true(s.x[SHARE_SUNS] == 0.0);
    assert_true(s.unexplained < 0.01);
}

// A patch of sun, many times brighter than all else, moves no share of a side. Its size is the suns' share.
static void a_patch_of_sun_opens_no_side(void **state)
{
    (void)state;
    static picture p;
    paint(&p);
    light(&p, 10);
    shares s = fit(&p);
    assert_true(worst(&p, &s) < 0.01);
    assert_true(fabs(s.x[SHARE_SUNS] - 10.0 * 10.0 / (0.5 * PIXELS)) < 0.01);
    assert_true(s.unexplained < 0.01);
}

// A side that lights nothing keeps the prior. Light that no share explains leaves all of them nearer to it.
static void the_prior(void **state)
{
    (void)state;
    static picture p;
    paint(&p);
    for (int i = 0; i < 3 * PIXELS; i++) p.columns[4][i] = 0.0f;
    light(&p, 0);
    shares s = fit(&p);
    assert_true(fabs(s.x[4] - 0.1) < 1e-6);
    double told = s.x[8];
    for (int i = 0; i < 4 * PIXELS; i++)
        if (i % 4 < 3) p.beauty[i] *= (i / 4 % W / 8 + i / 4 / W / 8) % 2 ? 1.8f : 0.2f;
    s = fit(&p);
    assert_true(s.unexplained > 0.5);
    assert_true(s.x[8] > 0.1 && s.x[8] < told - 0.02);
}

// Noise of single pixels, as of a picture of few samples, is no light that is left unexplained.
static void noise_refuses_nothing(void **state)
{
    (void)state;
    static picture p;
    paint(&p);
    light(&p, 0);
    for (int i = 0; i < 4 * PIXELS; i++)
        if (i % 4 < 3) p.beauty[i] *= (i / 4 + i / 4 / W) % 2 ? 1.9f : 0.1f;
    shares s = fit(&p);
    assert_true(s.unexplained < 0.2);
    assert_true(worst(&p, &s) < 0.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_come_back),
        cmocka_unit_test(a_patch_of_sun_opens_no_side),
        cmocka_unit_test(the_prior),
        cmocka_unit_test(noise_refuses_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
