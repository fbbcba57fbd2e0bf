// Reading a frame: files, channels, G-buffer.
#ifndef SSDO_PIPELINE_READ_H
#define SSDO_PIPELINE_READ_H

#include "pipeline/result.h"

// Reads a frame. Starts by zeroing the result.
bool frame_read(const job *j, const char *input, frame_result *result, error *e);
// The same for a frame whose passes are in several files.
bool frame_read_files(const job *j, const char *const *inputs, int count, frame_result *result, error *e);
// The same; where the job's device is not open yet, it is opened here, on the calling thread, while another thread reads
// and prepares the frame.
bool read_and_open(job *j, const char *const *inputs, int count, frame_result *r, error *e);

// What a further G-buffer shows of the world, of at most `most` of its pixels.
bool read_world_view(const job *j, const char *path, size_t most, world_view *out, error *e);
// The same of a frame of the shot, whose channels and camera are found as the inputs' are; of stereo the first view.
bool read_shot_view(const job *j, const char *const *paths, int count, size_t most, world_view *out, error *e);

#endif
