// Learns how open the unseen outside of a frame is from the light that its renderer has put into the picture.
//
// With everything else known, the light of a frame is a linear function of the openness of each side (passes/openness.h): what
// comes with all sides closed, plus what each adds. The frame is estimated at a small size with all closed, with each side open
// alone, and with its suns let in; the shares are those, 0 to 1, whose sum comes nearest to the picture's own light.
#ifndef SSDO_PIPELINE_OUTSIDE_FIT_H
#define SSDO_PIPELINE_OUTSIDE_FIT_H

#include "pipeline/result.h"

// After the G-buffer is built: keeps the picture's own diffuse light at a small size in r->lit, if the plan asks for it, and
// gives up what nobody else needs. From any thread.
bool outside_fit_gather(const job *j, frame_result *r, error *e);

// On the device's thread. light: what lit the picture, or with !told may have. out: what is known of the outside without that,
// the prior. It stays if the light cannot be explained; if nobody told that the environment lit the picture and the picture shows
// neither a roof nor that it is dark for this environment; and where the light says nothing. Says what it found to the log.
bool outside_fit(job *j, frame_result *r, job_light *light, bool told, openness *out, error *e);

#endif
