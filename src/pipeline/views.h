// The stereo views of a file: parts with a `view` attribute, or channel names in one part that tell them apart (layer.right.R,
// attribute multiView), the two forms of OpenEXR's multi-view standard.
#ifndef SSDO_PIPELINE_VIEWS_H
#define SSDO_PIPELINE_VIEWS_H

#include "pipeline/result.h"

enum { VIEWS_MAX = EXRIO_VIEWS };

// The views to filter, in the file's order, the default view first: all that parts name, or the one that --view-layer names,
// alone ("right") or after a view layer ("ViewLayer.right"). 0 when the file has none (or only one, which is nothing to choose
// between). Names are the file's.
int views_of(const exrio_file *file, const options *o, const char *names[VIEWS_MAX]);

// What --view-layer leaves to choose within the view: the view layer before a view's name, NULL for none. buf: room for it.
const char *view_layer_within(const options *o, const char *view, char *buf, size_t size);

// True if the part holds something of the view: always for view NULL.
bool view_has(const exrio_part *part, const char *view);

// True if the view is told by channel names and not by parts; false for view NULL.
bool view_in_names(const exrio_file *file, const char *view);

// The name that a channel of ours has in the view: "layer.right.R" for "layer.R" where names tell views, otherwise as it is.
void view_name(const exrio_file *file, const char *view, const char *name, char *out, size_t size);

#endif
