// From the options to one frame's settings.
#ifndef SSDO_PIPELINE_SETTINGS_H
#define SSDO_PIPELINE_SETTINGS_H

#include "pipeline/frame.h"

// The occlusion radius in scene units: given, in pixels at the median depth, the shot's, or measured.
double settings_radius(const job *j, const gbuffer *gb);
// Whether z is the environment's up axis: as asked for, else the renderer's.
bool settings_up_z(const job *j, const frame_result *r);
pass_settings settings_of(const job *j, const frame_result *r, double radius);

#endif
