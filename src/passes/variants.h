// Every shader program that a pass can ask for.
//
// A variant is a set of words ("RUNS PLANES BENT SCALARS=2"), each a #define of the shader. A row names a shader and a
// pattern of the sets it is asked for in; a pass that asks for another is refused. Rows of the passes that serve every method are
// in variants.c, a method's in the method's own file (passes/method.h); several rows may name one shader. Lint, the check of GL's
// limits and the tests that link every program walk all of them.
#ifndef SSDO_PASSES_VARIANTS_H
#define SSDO_PASSES_VARIANTS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct variant_row {
    const char *program; // shaders/<program>.comp
    // Alternatives between bars; in each, words that must be there and, in brackets, words that may: "RUNS [PLANES] | HORIZON".
    const char *pattern;
    bool drawable; // its outputs are all TARGETs (shaders/include/images.glsl)
    bool exact;    // it is also dispatched where passes are drawn
} variant_row;

// The rows of a method or bounce, numbered from 0 on; false after the last. In method.c: nothing here knows what a method is.
bool variants_of_maker(int maker, const variant_row **rows);
const variant_row *variant_row_at(int i); // all rows, from 0 on; NULL after the last

enum { VARIANT_TEXT = 256 };

// A set of words on its way. All zero: the empty set.
typedef struct variant {
    char words[VARIANT_TEXT];
} variant;

// Adds a word if `wanted`.
void variant_add(variant *v, bool wanted, const char *word);
void variant_number(variant *v, const char *word, int number); // "SCALARS=2"

// The row that allows these words; NULL: there is none.
const variant_row *variant_find(const char *program, const char *words);
bool variant_allowed(const variant_row *row, const char *words);

// The words as gpu_program_get takes them ("RUNS 1\nSCALARS 2\n"). False if they do not fit.
bool variant_defines(const char *words, char *out, size_t size);

// Calls `visit` with every set of the row, of both kinds of camera (the word ORTHOGRAPHIC comes last). Stops when it returns
// false, and returns that.
bool variant_each(const variant_row *row, bool (*visit)(void *context, const char *words), void *context);

#endif
