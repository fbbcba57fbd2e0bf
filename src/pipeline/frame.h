// One frame: read, resolve, plan, filter, write.
#ifndef SSDO_PIPELINE_FRAME_H
#define SSDO_PIPELINE_FRAME_H

#include "pipeline/prepare.h"
#include "pipeline/read.h"
#include "pipeline/result.h"

// The stages of a frame are frame_read (read.h), frame_filter and frame_write, to be called in this order on one result; after a
// failure only frame_free. When the job is stopped before the passes have ended, filtering returns false without an error.
// Reading and writing may run on other threads than filtering, which belongs to the device's thread and opens the device if
// nobody has; of one job no stage runs twice at a time.
bool frame_filter(job *j, frame_result *result, error *e);

// Filtering in four steps, for who does other frames beside it. frame_prepare (prepare.h) may follow reading on its thread, once
// result->frame is set; frame_begin and frame_wait belong to the device's thread, and between them another frame may begin;
// frame_convert may precede writing on its thread.
bool frame_begin(job *j, frame_result *result, error *e); // the passes; the layers are on their way
bool frame_wait(job *j, frame_result *result, error *e);  // they have arrived
bool frame_convert(const job *j, frame_result *result, error *e);
// Whether there is anything for frame_wait to wait for.
bool frame_is_under_way(const frame_result *result);

bool frame_write(const job *j, frame_result *result, const char *output, error *e);

// Reading and filtering, as the program and the library do it. Where the device is not open yet, it is opened while the file is
// being read. record: NULL for none.
bool frame_make(job *j, const char *const *inputs, int count, const frame_record *record, frame_result *result, error *e);
// The same, and writing.
bool frame_run(job *j, const char *input, const char *output, frame_result *result, error *e);
bool frame_run_files(job *j, const char *const *inputs, int count, const char *output, const frame_record *record,
                     frame_result *result, error *e);
void frame_free(frame_result *result);

// What a sequence must have the same everywhere, measured on one frame of it.
bool frame_measure_shot(job *j, const char *const *inputs, int count, shot_facts *shot, error *e);

#endif
