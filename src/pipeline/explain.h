// --explain: what is concluded from an input, and why, without filtering anything.
#ifndef SSDO_PIPELINE_EXPLAIN_H
#define SSDO_PIPELINE_EXPLAIN_H

#include <stdio.h>

#include "base/log.h"
#include "cli/options.h"
#include "pipeline/frame.h"

// Reads the input (of a sequence, its first frame) and writes to `to`: the renderer and what named it, a line per role, what was
// measured, the camera, which layers could be made and what runs for them, warnings. Needs no GL. Where the input cannot be used,
// what was found until then is written, and the error returned.
// With --explain=json all of it is one JSON object.
bool explain_write(const options *o, FILE *to, error *e);

// The JSON of an input's views: `built` if they could be read, else *why. Used by explain_write.
void explain_json(const frame_result *first, bool built, const log_t *log, const error *why, FILE *to);

#endif
