// Assembling the output file: the input's channels as they were, our layers beside them.
#ifndef SSDO_PIPELINE_OUTPUT_H
#define SSDO_PIPELINE_OUTPUT_H

#include "pipeline/result.h"

// Writes the file. Of a stereo file each view is treated so: its parts keep their `view`, and our layers have the same names in
// each; where channel names tell the views (one part), ours do too: occlusion.right.R. Parts of no filtered view pass through as
// they are. A single-part input stays single-part. Parts of a multi-part input
// are merged into one where windows and names allow; otherwise they are kept as they are and our layers go into a part of their
// own, named "ssdo".
bool output_write(const job *j, frame_result *r, const char *path, error *e);

#endif
