// The unknowns of a fit of the outside (pipeline/outside_fit.h): how open each side is, how much of the light bounces.
#ifndef SSDO_PIPELINE_OUTSIDE_SHARES_H
#define SSDO_PIPELINE_OUTSIDE_SHARES_H

#include "gbuffer/gbuffer.h"
#include "passes/openness.h"

enum {
    SHARE_SUNS = OPENNESS_COUNT, // before it the sides, as in openness.share
    SHARE_BOUNCE, // a multiple of one bounce: a renderer may make more, and the frame shows only some of what sends
    SHARE_UNKNOWNS,
    SHARE_CLOSED = SHARE_UNKNOWNS, // what comes with all closed
    SHARE_COLUMNS
};

typedef struct shares {
    double x[SHARE_UNKNOWNS];
    double unexplained; // root mean square of what is left of the light, over that of the light; both over areas of 8 x 8 pixels
} shares;

// The light of a picture beside that of an open sky.
typedef struct light_comparison {
    double share;  // how much of it there is
    double unlike; // what is left of it if that sky, brighter or darker, explains it, as `unexplained`
} light_comparison;

// lit: as below. open: 3 a pixel.
light_comparison shares_compare(const gbuffer *lit, const float *open);

// Least squares within bounds. lit: a small frame whose beauty holds the light to be explained, r g b times the weight in the
// fourth. column: 3 a pixel, what each unknown adds if it is 1. prior: what the light says nothing about. s->x: where to start.
// Sunlight falls in patches whose outlines no share can draw. So each pixel has its suns or has not, whichever leaves less of its
// light; the suns' share is that of the light of suns that pixels have.
void shares_fit(const gbuffer *lit, float *const column[SHARE_COLUMNS], const double prior[SHARE_UNKNOWNS], shares *s);

#endif
