// The layers we write, as the command line names them; their rows are in passes/image_rows.h, and what each holds stands in
// README.md, The layers.
#ifndef SSDO_PIPELINE_LAYERS_H
#define SSDO_PIPELINE_LAYERS_H

#include "passes/images.h"

// "occlusion,radiance" to a bit set (1 << layer). NULL gives the default four. ERR_USAGE names an unknown layer and those there
// are.
bool layers_parse(const char *list, unsigned *set, error *e);

#endif
