// What drivers say of shaders, with the names of files in place of their numbers.
//
// A message about a spliced source begins with the number that "#line n number" gave the file, in one of the forms
//     0:144(5): error: ...                 Mesa
//     0(144) : error C0000: ...            NVIDIA
//     ERROR: 0:144: ...                    AMD, Intel, glslang
#ifndef SSDO_GPU_DIAGNOSE_H
#define SSDO_GPU_DIAGNOSE_H

#include <stdbool.h>

#include "base/error.h"

typedef struct diagnose_place {
    int file, line;
    const char *text; // what follows the place; within the log, to the end of its line
    bool is_error;    // no warning or note
} diagnose_place;

// Reads the place at the beginning of a line; false if the line has none.
bool diagnose_line(const char *line, diagnose_place *place);

// The first error of a log that has a place. False if there is none.
bool diagnose_first(const char *log, diagnose_place *place);

// The log with "arc_light.comp:144: " for each place whose file is one of the `count` files; the rest as it was. To be freed;
// NULL on failure.
char *diagnose_translate(const char *log, const char *const files[], int count, error *e);

#endif
