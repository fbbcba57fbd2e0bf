// Frame ranges and file patterns of sequences.
//
// Ranges, a comma list with optional spaces of: 7, 1-10, 1-100x2, 1-10:4 (x and : are the step), negative numbers allowed, first
// may be larger than last with the step counted downwards. Every frame once, in the order given. A Slurm throttle (%8) at the
// end is accepted and ignored.
// Patterns: #### (one or more, zero padded to that width), %d, %04d, $F, $F4; the last such place in the file name counts.
#ifndef SSDO_CLI_FRAMES_H
#define SSDO_CLI_FRAMES_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"

typedef struct frame_list {
    int *frames;
    int count;
} frame_list;

enum { FRAMES_MAX = 1000000 };

// ERR_USAGE names the part of the text that is not a range.
bool frames_parse(const char *text, frame_list *out, error *e);
void frames_free(frame_list *l);
// "1, 5-8, 12": as frames_parse reads it; runs of three and more rising frames are ranges. What does not fit is replaced by
// "...".
void frames_format(const frame_list *l, char *out, size_t size);

// True if the path holds a frame place.
bool pattern_is(const char *path);
// The path of one frame. False if it does not fit.
bool pattern_path(const char *pattern, int frame, char *out, size_t size);
// The frames whose files exist, in rising order; an empty list is no error here, and neither is a folder that does
// not exist; ERR_INPUT for one that cannot be read.
bool pattern_scan(const char *pattern, frame_list *out, error *e);

#endif
