// The surround on the device: its maps (surround.h), once a batch; what their surfaces send; and which of them a frame looks at.
#ifndef SSDO_PASSES_SURROUND_IMAGE_H
#define SSDO_PASSES_SURROUND_IMAGE_H

#include "passes/params.h"
#include "passes/pass.h"

// Makes c->surround of c->views, unless it is there, and chooses the maps that the frame's directions are looked up in: at most
// SURROUND_TRIES, those first that show most of what neither the frame nor the maps before them do.
bool surround_image_make(pass_context *c, error *e);
// The light that the maps' surfaces send: what reaches them of c's environment, times their albedo where that is known. Made
// again when what the maps do not show counts as open to another degree. After surround_image_make.
bool surround_image_light(pass_context *c, error *e);
// Those maps, for the shader.
void surround_image_put(const pass_context *c, arc_params *p);
void surround_image_free(pass_surround *s);

#endif
