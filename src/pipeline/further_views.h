// The further G-buffers of a run: --also, and the frames of the shot that --surround shot chooses.
#ifndef SSDO_PIPELINE_FURTHER_VIEWS_H
#define SSDO_PIPELINE_FURTHER_VIEWS_H

#include "cli/frames.h"
#include "pipeline/result.h"

enum { SHOT_VIEWS = 8 };
_Static_assert(SHOT_VIEWS + OPT_MOST_PATHS <= MAX_FURTHER, "shaders/include/constants.glsl");

// Of all frames of the shot that exist, whatever --frames says, at most SHOT_VIEWS: the first, the last and those at even steps
// between them. So every task of a farm, and every run over the same files, has the same. ERR_USAGE where the input is no
// sequence, ERR_INPUT where no file fits its pattern. Free the list with frames_free.
bool shot_frames(const options *o, frame_list *out, error *e);

// Reads them into job->views, once for all frames, if anything that is made of the frame looks at them. ERR_INPUT where they, or
// the frame, have no place in the world; with --keep-going a frame of the shot that cannot be read is left out, with a warning.
bool further_views_load(job *j, const frame_result *r, error *e);

#endif
