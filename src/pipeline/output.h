// Assembling the output file: the input's channels as they were, our layers beside them.
#ifndef SSDO_PIPELINE_OUTPUT_H
#define SSDO_PIPELINE_OUTPUT_H

#include "pipeline/frame.h"

// Input channels that already carry names of ours are replaced if the file says we made them (ssdo/version), else ERR_INPUT
// naming --prefix. Called before any pixel is read, so that a long job does not fail at its end. view: the one to be written.
bool output_check_names(const options *o, const exrio_file *file, const char *view, const plan *p, error *e);

// --layout multipart: true if the part goes through as stored, so that its channels need not be read for writing.
bool output_keeps_chunks(const options *o, const exrio_file *file, int part, const plan *p);

// Whether a channel of the input's part is made anew, or left out with what an earlier run made, instead of being passed through.
// r: the first view, once it was written.
bool output_replaces(const job *j, const frame_result *r, int part, const char *channel);

// Writes the file. Of a stereo file each view is treated so: its parts keep their `view`, and our layers have the same names in
// each; where channel names tell the views (one part), ours do too: occlusion.right.R. Parts of no filtered view pass through as
// they are. A single-part input stays single-part. Parts of a multi-part input
// are merged into one where windows and names allow; otherwise they are kept as they are and our layers go into a part of their
// own, named "ssdo".
bool output_write(const job *j, frame_result *r, const char *path, error *e);

#endif
