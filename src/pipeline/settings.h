// From the options to one frame's settings.
#ifndef SSDO_PIPELINE_SETTINGS_H
#define SSDO_PIPELINE_SETTINGS_H

#include "pipeline/result.h"

// What all views of a frame and all frames of a sequence share, as asked for, as measured on the sequence, or measured on `r`:
// radius: of the occlusion, in scene units (given, in pixels at the median depth, or automatic);
// outside: how open the unseen outside is, 0 to 1 (--outside).
shot_facts settings_shot(const job *j, const frame_result *r);
// The same of a sequence: on this frame of it.
shot_facts settings_measure_shot(const job *j, const frame_result *r);
// Whether z is the environment's up axis: as asked for, else the renderer's.
bool settings_up_z(const job *j, const frame_result *r);
// The depth in the middle of the surfaces, 1 where there are none: where a length in pixels and one in the scene are compared.
double frame_median_depth(const gbuffer *gb);

// Lengths are squared in single precision and compared with the smallest that is told from nothing: pictures are computed alike
// where a pixel is at least 1e-14 scene units wide at the median depth and a tenth of the surfaces is nearer than 1e10. ERR_INPUT
// for what is beyond.
bool frame_check_scale(const frame_result *r, error *e);

pass_settings settings_of(const job *j, const frame_result *r, shot_facts shot);

#endif
