// The stereo views of a multi-part file (OpenEXR's multi-view standard: parts with a `view` attribute).
#ifndef SSDO_PIPELINE_VIEWS_H
#define SSDO_PIPELINE_VIEWS_H

#include "pipeline/frame.h"

enum { VIEWS_MAX = 16 };

// The views to filter, in the file's order, the default view first: all that parts name, or the one that --view-layer names.
// 0 when the file has none (or only one, which is nothing to choose between). Names are the file's.
int views_of(const exr_file *file, const options *o, const char *names[VIEWS_MAX]);

// True if the part belongs to the view: always for view NULL.
bool view_has(const exr_part *part, const char *view);

#endif
