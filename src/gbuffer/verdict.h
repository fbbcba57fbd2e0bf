// What was concluded about the meaning of a pass, and on what evidence: for --explain, -v and --strict.
#ifndef SSDO_GBUFFER_VERDICT_H
#define SSDO_GBUFFER_VERDICT_H

#include <stdbool.h>

enum { VERDICT_HYPOTHESES = 12, VERDICT_TEXT = 96 };

// One way to read a pass and how well it fits the others. `fit` is the median cosine (normals) or the median relative difference
// (depth) or distance in pixels (positions) over smooth surface pixels; `loss` is what hypotheses are compared by, 0 at best.
typedef struct hypothesis {
    char name[VERDICT_TEXT];
    double fit, loss;
} hypothesis;

typedef struct verdict {
    bool present;                         // the file has such a pass
    bool used;                            // and it is used; else it is rebuilt or left out
    bool doubtful;                        // a warning was given that the reading may be wrong
    char reading[VERDICT_TEXT];           // the hypothesis that was taken; empty: none could be tested
    const char *measure;                  // what `fit` is, in words
    double fit, next;                     // of the reading and of the next best; NaN where there is none
    hypothesis tried[VERDICT_HYPOTHESES]; // best first
    int count;
} verdict;

// Puts a hypothesis in its place, best first; of those of one name the first stays.
void verdict_try(verdict *v, const char *name, double fit, double loss);

#endif
