// --report: what a frame did, as JSON (schema in the man page).
#ifndef SSDO_PIPELINE_REPORT_H
#define SSDO_PIPELINE_REPORT_H

#include "pipeline/result.h"

// Points of the disc that a sphere of the occlusion radius covers on the screen, that lie outside the frame, as a share.
struct json_object *report_rounds(const frame_result *r); // what --error came to
double report_off_frame_share(const frame_result *r);

extern const char *const report_stage_names[STAGE_COUNT];

bool report_write(const job *j, const frame_result *r, const char *output, const char *path, error *e);

#endif
