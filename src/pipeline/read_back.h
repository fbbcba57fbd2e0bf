// The layers from the GPU to the samples that are written.
#ifndef SSDO_PIPELINE_READ_BACK_H
#define SSDO_PIPELINE_READ_BACK_H

#include "passes/pass.h"
#include "pipeline/result.h"

// Begins to fetch the planned layers. Where they travel through mapped buffers (gpu/transfer.h) it returns while they are under
// way, and c may end; elsewhere it does all of read_back_convert's work as well, a few rows at a time.
bool read_back_begin(job *j, const pass_context *c, frame_result *r, error *e);
// Waits until all has arrived. On the GL thread.
bool read_back_wait(job *j, const frame_result *r, error *e);
// Fills r->samples and r->types, in the type they are written in, r->clamped, and unless the job has no use for floats r->layers,
// on all threads of the job. From any thread, after read_back_wait.
//
// Floats come from the GPU even where halves are written: image stores and drawing to a half target may round either way (GL 4.5,
// 2.3.4.2), and the samples must be the nearest ones on every device.
bool read_back_convert(const job *j, frame_result *r, error *e);
// Both, each band as it arrives, with the next ones under way. On the GL thread.
bool read_back_finish(job *j, frame_result *r, error *e);
// Gives up what is under way. From any thread.
void read_back_drop(frame_result *r);

#endif
