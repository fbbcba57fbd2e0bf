// The input files: whether they are a sequence, and those of one frame: the names of the command line, with the frame's number in
// their places.
#ifndef SSDO_PIPELINE_INPUTS_H
#define SSDO_PIPELINE_INPUTS_H

#include "cli/frames.h"
#include "cli/options.h"

enum { INPUT_PATH = 4096 };

typedef struct input_paths {
    char text[OPT_MAX_INPUTS][INPUT_PATH];
    const char *list[OPT_MAX_INPUTS];
    int count;
} input_paths;

// Whether the options ask for a sequence: a frame place in the input, or --frames.
bool inputs_are_framed(const options *o);

// A name without a place for the frame is the same file in every frame. False if a path does not fit.
bool inputs_of_frame(const options *o, int frame, input_paths *out);

enum { SHOT_VIEWS = 8 };

// Of all frames of the shot that exist, whatever --frames says, at most SHOT_VIEWS: the first, the last and those at even steps
// between them. So every task of a farm, and every run over the same files, has the same. ERR_USAGE where the input is no
// sequence; an empty list where no file fits its pattern. Free it with frames_free.
bool shot_frames(const options *o, frame_list *out, error *e);

#endif
