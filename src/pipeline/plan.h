// Which layers a frame has, and what they need: a pass runs only if a layer that was asked for needs it and the input can feed
// it. The passes in their order are steps.h's.
#ifndef SSDO_PIPELINE_PLAN_H
#define SSDO_PIPELINE_PLAN_H

#include "base/log.h"
#include "cli/options.h"
#include "gbuffer/resolve.h"
#include "passes/method.h"
#include "pipeline/layers.h"

typedef struct plan {
    const method *method;
    unsigned layers;      // that will be written
    unsigned need;        // gbuffer_need bits
    unsigned need_to_fit; // the same, of what only outside_fit.h looks at; 0: it has nothing to do
    bool light;           // the environment is needed on the GPU
    bool relight;         // the composite is lit by us; otherwise the beauty is occluded
    bool visibility_mode;
    bool want_radiance, want_visibility, want_bent, want_error;
    bool irradiance, blur, tone, bounce, edges, specular, depthmask, composite;
    bool bounce_in_composite;
    bool from_sh;                                // the method's SH vector is read from the file
    const struct bounce_kind *estimator;         // of the bounce that --bounce names, else the method's own; NULL: none
    const char *why_no_bounce, *why_no_specular; // where there is none
} plan;

// Decides. A default layer that cannot be made is left out with a warning; one named in --layers is ERR_INPUT naming the channel
// that is missing.
bool plan_make(const options *o, const exrio_file *file, const resolution *r, plan *out, log_t *log, error *e);

// Whether --outside auto has anything to decide: no method but arc asks, and only for light.
bool plan_asks_outside(const options *o);

#endif
