// Runs the real passes on a real GL context over a gbuffer made by a test, without files.
#ifndef SSDO_TESTS_RIG_H
#define SSDO_TESTS_RIG_H

#include "pipeline/filter.h"

typedef struct rig {
    job job;
    options options;
    log_t log;
    proxy_set proxies;            // borrowed; none by default
    float *relight_sh[SH_IMAGES]; // of --from-sh, 4 a pixel; borrowed; none by default
} rig;

// The context and the environment. `env` may be NULL: no light; env->path NULL: the white environment.
// False with the error filled when there is no GL 4.5: a test then fails, because the product does too.
bool rig_open(rig *r, const env_options *env, error *e);
void rig_close(rig *r);

// The settings of a method at its defaults, without blur, thickness infinite.
pass_settings rig_settings(const method *m, double radius);

// Filters: r->layers of the result hold the layers in `layers` (bits of pipeline/layers.h). relight, no coverage, no beauty.
// The gbuffer is borrowed: free the result with rig_free_result, not with frame_free.
bool rig_run(rig *r, const gbuffer *gb, const method *m, const pass_settings *set, unsigned layers, frame_result *out, error *e);
void rig_free_result(frame_result *r);

#endif
