// The further G-buffers of a run: --also, and the frames of the shot that --surround shot chooses.
#ifndef SSDO_PIPELINE_FURTHER_VIEWS_H
#define SSDO_PIPELINE_FURTHER_VIEWS_H

#include "pipeline/result.h"

// Reads them into job->views, once for all frames, if anything that is made of the frame looks at them. ERR_INPUT where they, or
// the frame, have no place in the world; with --keep-going a frame of the shot that cannot be read is left out, with a warning.
bool further_views_load(job *j, const frame_result *r, error *e);

#endif
