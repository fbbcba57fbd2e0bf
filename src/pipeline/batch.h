// Many frames in one process: read ahead, filter, write behind.
//
// One GL context, its programs and the environment live for the whole batch. Three threads work on neighbouring frames: one reads
// and prepares, the GL thread (the caller's) keeps the device busy, one converts the layers and writes; loops over pixels and
// chunks are spread over more. A fixed number of frames is in flight, and memory is bounded by it: one for each thread and, where
// layers travel through mapped buffers, one whose layers are under way. The outputs do not depend on that number, on timing or on
// the order of frames.
#ifndef SSDO_PIPELINE_BATCH_H
#define SSDO_PIPELINE_BATCH_H

#include "pipeline/frame.h"

enum { BATCH_IN_FLIGHT = 3, BATCH_MOST_IN_FLIGHT = 4 };

// Runs the sequence. A frame that fails leaves its target as it was; with --keep-going the next frames are done all the same. At
// the end ERR_FRAMES lists what failed, as --frames takes it. One summary line a frame on standard output, unless quiet. When the
// job is stopped, frames under way are dropped unless they are already being written, a line says how far it got, and the batch
// ends with no error of its own.
bool batch_run(job *j, error *e);

#endif
