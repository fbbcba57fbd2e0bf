// Which passes a frame needs: a pass runs only if a layer that was asked for needs it and the input can feed it.
#ifndef SSDO_PIPELINE_PLAN_H
#define SSDO_PIPELINE_PLAN_H

#include "base/log.h"
#include "cli/options.h"
#include "gbuffer/resolve.h"
#include "passes/method.h"
#include "pipeline/layers.h"

enum { PLAN_STEPS = 12 };

typedef struct plan_step {
    const char *pass;
    bool runs;
    const char *why; // why it runs, or why not
} plan_step;

typedef struct plan {
    const method *method;
    unsigned layers; // that will be written
    unsigned need;   // gbuffer_need bits
    bool light;      // the environment is needed on the GPU
    bool relight;    // the composite is lit by us; otherwise the beauty is occluded
    bool visibility_mode;
    bool want_radiance, want_visibility, want_bent, want_error;
    bool irradiance, blur, tone, bounce, edges, specular, depthmask, composite;
    bool bounce_in_composite;
    bool from_sh;                        // the method's SH vector is read from the file
    const struct bounce_kind *estimator; // of the bounce that --bounce names, else the method's own; NULL: none
    plan_step steps[PLAN_STEPS];
    int step_count;
} plan;

// Decides. A default layer that cannot be made is left out with a warning; one named in --layers is ERR_INPUT naming the channel
// that is missing.
bool plan_make(const options *o, const exrio_file *file, const resolution *r, plan *out, log_t *log, error *e);

#endif
