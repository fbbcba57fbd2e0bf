// From the options to one frame's settings.
#ifndef SSDO_PIPELINE_SETTINGS_H
#define SSDO_PIPELINE_SETTINGS_H

#include "pipeline/frame.h"

// What all views of a frame and all frames of a sequence share, as asked for, as measured on the sequence, or measured on `r`:
// radius: of the occlusion, in scene units (given, in pixels at the median depth, or automatic);
// outside: how open the unseen outside is, 0 to 1 (--outside).
shot_facts settings_shot(const job *j, const frame_result *r);
// The same of a sequence: on this frame of it.
shot_facts settings_measure_shot(const job *j, const frame_result *r);
// Whether --outside auto has anything to decide: no method but arc asks, and only for light.
bool settings_asks_outside(const options *o);
// Whether z is the environment's up axis: as asked for, else the renderer's.
bool settings_up_z(const job *j, const frame_result *r);
pass_settings settings_of(const job *j, const frame_result *r, shot_facts shot);

#endif
