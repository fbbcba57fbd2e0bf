// From a frame that was read to one that the device can begin: its settings, its spheres, what the CPU does for the passes.
#ifndef SSDO_PIPELINE_PREPARE_H
#define SSDO_PIPELINE_PREPARE_H

#include "pipeline/result.h"

// All views of the frame. Nothing if it is done. result->frame must be set.
bool frame_prepare(const job *j, frame_result *result, error *e);

#endif
