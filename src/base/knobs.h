// Environment variables of ours, for tests and for work on the shaders. Nothing else in the program asks the environment for a
// name that begins with SSDO_.
#ifndef SSDO_BASE_KNOBS_H
#define SSDO_BASE_KNOBS_H

#include <stdbool.h>

typedef struct knob {
    const char *name;
    bool pixels; // can change pixels: a warning and the file's record name it
    bool path;   // the record keeps its base name only
} knob;

extern const knob knobs[]; // ends with a NULL name

// The value of a knob, NULL if it is not set or empty. name: one of the table.
const char *knob_value(const char *name);

#endif
