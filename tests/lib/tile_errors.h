// The estimate of --error against the true error, tile by tile.
//
// The true error is the difference from the method's own limit, a mean of runs with very many samples and no filter. It holds the
// samples' noise and what too few steps miss, and not what the method's assumptions get wrong.
#ifndef SSDO_TESTS_TILE_ERRORS_H
#define SSDO_TESTS_TILE_ERRORS_H

#include "rig.h"

typedef struct tile_errors {
    double rms;           // of the whole picture
    double estimated;     // the same by the error layer; 0 without one
    int tiles;            // with a surface
    double largest;       // of the tiles' root mean square errors
    int below;            // tiles whose error is below `wanted`
    int within_2, over_2; // tiles whose true error is within a factor of 2 of the estimate; more than twice it
} tile_errors;

// The occlusion a method tends to: the mean of `runs` runs of `samples` samples, without a filter. Free with free().
float *tile_limit(rig *r, const gbuffer *gb, const method *m, pass_settings set, int samples, int runs, error *e);

// `estimate` may be NULL. Errors below what half floats tell apart near 1 (5e-4) count as that.
tile_errors tile_errors_of(const gbuffer *gb, const float *occlusion, const float *limit, const float *estimate, double wanted);

#endif
