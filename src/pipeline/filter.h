// The GPU part of a frame: upload, the planned passes in order, read back into result->layers.
#ifndef SSDO_PIPELINE_FILTER_H
#define SSDO_PIPELINE_FILTER_H

#include "pipeline/frame.h"

bool filter_frame(job *j, frame_result *result, error *e);

#endif
