// Further perspective G-buffers, which the march of an occlusion asks where the frame shows nothing
// (shaders/include/further.glsl).
#ifndef SSDO_PASSES_FURTHER_H
#define SSDO_PASSES_FURTHER_H

#include "passes/params.h"
#include "passes/pass.h"

// Whether any of the frame's views tells more than the frame itself: it is perspective, and not seen by the same camera.
bool further_serves(const pass_context *c);

// Their pictures, in one, once a batch; nothing if none serves.
bool further_make(pass_context *c, error *e);

// Their cameras, as seen from the frame's.
void further_put(const pass_context *c, arc_params *p);

#endif
