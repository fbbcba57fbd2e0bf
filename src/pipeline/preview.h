// --preview: a PNG contact sheet of the layers, for the eye only (display-encoded, so not for measuring).
#ifndef SSDO_PIPELINE_PREVIEW_H
#define SSDO_PIPELINE_PREVIEW_H

#include "pipeline/frame.h"

// One cell a layer, two columns, a label over each. Light is exposed so that the 95th percentile of the composite (or radiance)
// is at 0.8, and sRGB-encoded; shares are shown as they are.
bool preview_write(const frame_result *r, const char *path, error *e);

#endif
