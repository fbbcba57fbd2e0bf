// Which channel is what: names, space, unit and encoding of the input's channels, by convention table and by measurement.
//
// The table (conventions.c) has a row per renderer; every conclusion can be overridden by an option.
#ifndef SSDO_GBUFFER_RESOLVE_H
#define SSDO_GBUFFER_RESOLVE_H

#include "base/error.h"
#include "base/log.h"
#include "gbuffer/resolution.h"

// Finds the roles in the headers (no pixels needed). Several candidate sets (view layers) without --view-layer: ERR_INPUT listing
// them. An override that names no channel: ERR_INPUT naming it. Neither position nor depth: ERR_INPUT listing what was looked
// for, what the file has, and the flags that help. A missing normal is no error here (they can come from depth).
bool resolve_channels(const exrio_file *file, const resolve_options *options, resolution *out, log_t *log, error *e);

// "position: ViewLayer.Position.X/Y/Z (part 0, float)", one line a role, into buf.
void resolve_describe(const exrio_file *file, const resolution *r, role which, char *buf, size_t size);

#endif
