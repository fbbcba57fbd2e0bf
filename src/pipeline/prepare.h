// From a frame that was read to one that the device can begin: its settings, its spheres, what the CPU does for the passes.
#ifndef SSDO_PIPELINE_PREPARE_H
#define SSDO_PIPELINE_PREPARE_H

#include "pipeline/result.h"

// All views of the frame. Nothing if it is done. result->frame must be set.
bool frame_prepare(const job *j, frame_result *result, error *e);

// An environment that stands still in the world needs the camera's rotation: ERR_INPUT without.
bool frame_check_world(const job *j, const frame_result *r, error *e);

#endif
