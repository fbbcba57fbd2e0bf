// --report: what a frame did, as JSON (schema in the man page).
#ifndef SSDO_PIPELINE_REPORT_H
#define SSDO_PIPELINE_REPORT_H

#include "pipeline/frame.h"

bool report_write(const job *j, const frame_result *r, const char *output, const char *path, error *e);

#endif
