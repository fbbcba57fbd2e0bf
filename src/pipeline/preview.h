// --preview: a PNG contact sheet of the layers, for the eye only (display-encoded, so not for measuring).
#ifndef SSDO_PIPELINE_PREVIEW_H
#define SSDO_PIPELINE_PREVIEW_H

#include "pipeline/result.h"

// One cell a layer, two columns, a label over each, and a legend below. The legend shows the occlusion radius as a number and as
// a bar, of the length that the radius has in the cells at the middle depth; the checkerboard that stands where there is no
// surface; the stereo view; and the display and view that light went through. Each layer of light is exposed so that its 95th
// percentile is at 0.8 (its label says by which factor), and sRGB-encoded; shares are shown as they are, directions and
// coefficients with 0 as grey. A composite with alpha lies over the checkerboard, which is the same under every view. Large
// frames are reduced and small ones enlarged by a whole number, so that a cell is 320 to 960 columns wide.
//
// With an OpenColorIO config (--ocio, $OCIO) light goes through its display and view (--display, --view) instead; without one,
// light in the primaries of a chromaticities attribute is brought to sRGB's.
// The file carries the record of the frame, if it has one.
bool preview_write(const options *o, const frame_result *r, const char *path, error *e);

// Whether the module that writes a PNG and the display and view that previews would go through are there, to be asked before any
// work is done: an error names what is missing, and the displays and views there are. True where no preview is asked for.
bool preview_check(const options *o, error *e);

#endif
