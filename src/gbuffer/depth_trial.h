// Readings of a depth without positions, and what speaks for each. Internal to the room.
#ifndef SSDO_GBUFFER_DEPTH_TRIAL_H
#define SSDO_GBUFFER_DEPTH_TRIAL_H

#include "gbuffer/build.h"
#include "gbuffer/evidence.h"

enum { TRIAL_SAMPLES = 1200, MOST_TRIALS = DEPTH_KINDS };

// Raw values of the frame.
typedef struct values {
    size_t looked_at, negative, zero, one, within; // within: 0 < v < 1
    size_t beyond;                                 // v > 1, background left out, unless a filter's negative lobes explain it
    size_t under;                                  // v < -1
} values;

// What was done to a distance before it was stored, and no kind undoes: it is v to the power of `by`, e to that of `by` v, or v
// and `by`.
typedef enum depth_curve { CURVE_NONE, CURVE_POWER, CURVE_EXPONENTIAL, CURVE_OFFSET } depth_curve;

typedef struct trial {
    depth_code code;
    depth_curve curve; // then code is of planar distance
    double by;
    double fit, loss; // by the normals; loss INFINITY without
    double flat;      // share of pixels on planes
} trial;

// depth_open.c
bool depth_background(const build *b, double value);
values depth_look(const build *b);
// Values of both signs, more than a filter or a few broken pixels would leave.
bool depth_both_signs(const values *s);
bool depth_marks_background(const values *s, size_t count);
// Near and far by an option, or by names that headers use.
bool depth_find_range(const build *b, double *near, double *far);
// Sets the error that asks for a range; `what` is known. Returns false.
bool depth_no_range(build *b, const char *what);

// depth_trial.c
void trial_start(trial *t, depth_code code);
// Planar distance at a pixel as the trial has it, 0 where there is none.
double trial_distance(const build *b, const trial *t, int x, int y);
// False, with the error set, where memory is short.
bool trial_ask_normals(build *b, trial *t, evidence *scratch);
// `bend`: second difference over the first, below which a profile is a line.
void trial_ask_planes(const build *b, trial *t, double bend);
// a fits the normals, and clearly better than b.
bool trial_fits_better(const trial *a, const trial *b);
bool trial_more_planes(const trial *a, const trial *b);
bool trial_has_planes(const trial *t);
bool trial_has_normals(const trial *t);

// depth_curve.c: false, with the error set, where a curve lies over the distance. `best`: the likeliest reading.
bool depth_question_curve(build *b, const values *s, const trial *best, evidence *scratch);

// depth_question.c
// Planes confirm 1 / z and every z-buffer alike. What stands for the background tells them apart, else outlines. *open: nothing
// does. False, with the error set, where it is a z-buffer without a range.
bool depth_settle_hyperbolic(build *b, const values *s, const trial *list, int n, int *best, bool *open);
void depth_doubt(build *b, const char *why);
// Doubts, or false, with the error set.
bool depth_question(build *b, const values *s, const trial *list, int n, int best, bool confirmed, bool range);

#endif
