// The GPU part of a frame: upload, the planned passes in order, the layers back (read_back.h).
#ifndef SSDO_PIPELINE_FILTER_H
#define SSDO_PIPELINE_FILTER_H

#include "pipeline/result.h"

// What the CPU does for the passes, from result->gb, set and plan. On any thread, but on no result twice at a time.
bool filter_prepare(const job *j, frame_result *result, error *e);
// The passes that the frame takes: with `suns`, those of an environment that has some.
void filter_list(const frame_result *result, bool suns, step_list *out);
// The passes, after filter_prepare if nobody called it. The layers are on their way: read_back_wait and read_back_convert follow.
bool filter_begin(job *j, frame_result *result, error *e);
// What the passes of a plan make of a frame's radiance, plus its indirect light if the plan has a bounce: out, 3 a pixel.
// `views`: with what further G-buffers show.
bool filter_estimate(job *j, const gbuffer *gb, job_light *light, const plan *p, const pass_settings *set,
                     const plane_set *planes, bool views, float *radiance, float *indirect, error *e);
// All of it.
bool filter_frame(job *j, frame_result *result, error *e);

#endif
