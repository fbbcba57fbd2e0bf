// The layers from the GPU to the samples that are written.
#ifndef SSDO_PIPELINE_READ_BACK_H
#define SSDO_PIPELINE_READ_BACK_H

#include "passes/pass.h"
#include "pipeline/frame.h"

// Fills r->samples and r->types of the planned layers, in the type they are written in, r->clamped, and unless the job has no use
// for floats r->layers. Bands of rows pass through one small buffer.
//
// Floats come from the GPU even where halves are written: image stores and drawing to a half target may round either way (GL 4.5,
// 2.3.4.2), and the samples must be the nearest ones on every device.
bool read_back(const job *j, const pass_context *c, frame_result *r, error *e);

#endif
