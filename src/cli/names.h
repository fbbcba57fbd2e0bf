// File names of the command line, before anything is opened: what a # in them means, and whether an output's name is one.
#ifndef SSDO_CLI_NAMES_H
#define SSDO_CLI_NAMES_H

#include "base/log.h"
#include "cli/options.h"

// The sentence for frames of a sequence given one by one; %s is their pattern.
#define NAMES_SEQUENCE                                                                                                           \
    "these are frames of one sequence, as a shell makes them of a *; write '%s' in quotes instead, and such a place in the "     \
    "output's name (several files on a line are the passes of one frame)"

// Whether two paths differ in one number of the file's name alone, as two frames of a sequence do. pattern receives the path
// with #### in its place, cut to `size`.
bool names_are_frames(const char *a, const char *b, char *pattern, size_t size);

// Whether the first input is a file of exactly its name although it holds a place for the frame ("shot #1.exr"): there is such a
// file, and no frames are asked for, and no file fits the pattern or the output has no place for the frame.
// ERR_INPUT where the system does not say.
bool names_are_literal(const options *o, bool *literal, error *e);

// Refuses an output that names another image format ("out.png"); ERR_USAGE says what to do.
bool names_check_output(const char *output, error *e);

// What is done as asked and probably not meant: an unknown ending, a place for the frame that nothing fills, a pattern that is
// also a file's very name.
void names_warn(const options *o, log_t *log);

#endif
