// --from-sh: the SH layers that an earlier run left in the input.
#ifndef SSDO_PIPELINE_RELIGHT_H
#define SSDO_PIPELINE_RELIGHT_H

#include "cli/options.h"
#include "gbuffer/gbuffer.h"

// Marks the nine channels <prefix>sh_0.R ... sh_2.B, with --sh-bands 3 also sh_3.H ... sh_3.N, as wanted. ERR_INPUT names the
// first that is missing, and what writes them. view: of a stereo file; NULL for any.
bool relight_want(const options *o, exrio_file *file, const char *view, error *e);

// The loaded channels as floats, four a pixel in each array, as pass_context's images hold them, which the caller frees. NaN and
// infinities become 0.
bool relight_load(const options *o, const exrio_file *file, const char *view, const gbuffer *gb, float *out[5], error *e);

#endif
