// Previews and reports of frames: are they there, whole, and of this very frame?
#ifndef SSDO_PIPELINE_EXTRAS_H
#define SSDO_PIPELINE_EXTRAS_H

#include "pipeline/result.h"

// The preview and the report that the run would write for the frame, as far as it would. A report about a whole sequence is
// written by every run, and is none of these.
bool extras_are_done(const job *j, int frame, const frame_record *r);

// The text that a PNG file carries as `key`, at most size - 1 bytes of it. False for a file that is no PNG, not whole (every
// checksum is compared) or without it.
bool png_text(const char *path, const char *key, char *text, size_t size);

#endif
