// What the suites of hard cases share: frames through the whole program without its writing, comparisons, tables.
//
// To be included after cmocka.h. A program here is a cmocka program; every family prints one line "figure: ...", which `make
// check` shows. SSDO_HARD=whole runs every case, otherwise a subset is run that takes seconds. With SSDO_TABLES=FOLDER the
// measured tables are left there as Markdown, NN-name.md (`make hard-tables`).
#ifndef SSDO_TESTS_HARD_H
#define SSDO_TESTS_HARD_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "must.h"
#include "rig.h"
#include "scene_picture.h"

typedef struct hard {
    rig rig;         // rig.options are those of the next frame
    char folder[64]; // scratch, in memory
} hard;

// Fixture of a group: *state becomes a `hard` with default options, lit by the white environment.
int hard_open(void **state);
int hard_close(void **state);
bool hard_whole(void);

// A scene as a file in memory, of 32-bit floats unless asked otherwise; fails the test if it cannot be made.
exrio_file *hard_file(const scene *s, const view *v, const scene_exr_options *o);
// Samples of a channel by its name, NULL if there is none.
float *hard_channel(const exrio_file *f, const char *name);
// Writes it to the scratch folder; the path is valid until the next call.
const char *hard_write(const hard *h, const exrio_file *f, const char *name);

// Reads and filters a file by h->rig.options. False with the error filled; *out is to be freed with frame_free either way.
bool hard_frame(hard *h, const char *path, frame_result *out, error *e);
// hard_write and hard_frame; fails the test with the program's own sentence.
void hard_run(hard *h, const exrio_file *f, frame_result *out);

// Fails unless every layer that was made is finite, shares are in 0..1 and light is not negative.
void hard_check_layers(const frame_result *r, const char *what);

typedef struct difference {
    double mean, rms, worst; // over the pixels with a surface in both
    size_t count;
} difference;

// Of one layer of two results of one size; the pixels of `mask` (NULL: all).
difference hard_compare(const frame_result *a, const frame_result *b, layer_id layer, const unsigned char *mask);

// A Markdown table; NULL-safe: without SSDO_TABLES there is none. `name` is the file's, "10-scale".
FILE *hard_table(const char *name, const char *title);
void hard_cell(FILE *table, const char *format, ...) __attribute__((format(printf, 2, 3))); // nothing if table is NULL
void hard_table_end(FILE *table);

#endif
