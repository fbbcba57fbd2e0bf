#include "rig.h"

#include <math.h>
#include <stdlib.h>

bool rig_open(rig *r, const env_options *env, error *e)
{
    *r = (rig){0};
    options_defaults(&r->options);
    log_init(&r->log, LOG_QUIET);
    job_open(&r->job, &r->options, &r->log);
    if (!job_open_device(&r->job, e)) return false;
    if (!env) return true;
    if (!environment_load(env, &r->job.light.env, &r->log, e)) return false;
    r->job.light.loaded = true;
    return pass_upload_environment(&r->job.g, &r->job.light.env, &r->job.light.image, e);
}

void rig_close(rig *r)
{
    job_close(&r->job);
    log_free(&r->log);
}

pass_settings rig_settings(const method *m, double radius)
{
    return (pass_settings){.radius = radius,
                           .thickness = INFINITY,
                           .outside = openness_even(1.0),
                           .samples = m->samples,
                           .scale = 1.0,
                           .contrast = 1.0,
                           .env_level = -1.0,
                           .bounce_strength = 1.0,
                           .vpl_count = 256,
                           .amount = 1.0,
                           .relight = true};
}

static const bounce_kind *estimator_of(const method *m, const char *name)
{
    return name ? bounce_find(name) : m->bounce ? m->bounce : bounce_find("ssdo");
}

bool rig_run(rig *r, const gbuffer *gb, const method *m, const pass_settings *set, unsigned layers, frame_result *out, error *e)
{
    bool bounce = layers & 1u << LAYER_INDIRECT;
    bool light = r->job.light.loaded && (bounce || layers & 1u << LAYER_RADIANCE);
    *out = (frame_result){.gb = *gb, .set = *set, .proxies = r->proxies};
    for (int k = 0; k < SH_IMAGES; k++) out->relight_sh[k] = r->relight_sh[k];
    out->set.world_from_camera = gb->camera.has_world ? gb->camera.world_from_camera : m3_identity();
    out->set.upright_from_camera = out->set.world_from_camera;
    out->set.upright_eye = gb->camera.has_world ? gb->camera.origin : v3(0, 0, 0);
    out->plan = (plan){.method = m,
                       .layers = layers,
                       .want_radiance = light && method_makes(m, MAKES_LIGHT),
                       .want_error = layers & 1u << LAYER_ERROR,
                       .want_bent = layers & 1u << LAYER_BENT,
                       .want_visibility = layers & 1u << LAYER_VISIBILITY,
                       .irradiance = light && !method_makes(m, MAKES_LIGHT),
                       .blur = set->blur > 0 && !method_makes(m, MAKES_SH),
                       .tone = set->contrast != 1.0 || set->scale != 1.0 || !method_makes(m, MAKES_LIGHT),
                       .depthmask = layers & 1u << LAYER_DEPTHMASK,
                       .estimator = estimator_of(m, r->options.bounce),
                       .bounce = bounce};
    return filter_frame(&r->job, out, e);
}

void rig_free_result(frame_result *r)
{
    for (int i = 0; i < LAYER_COUNT; i++) {
        free(r->layers[i]);
        for (int k = 0; k < LAYER_CHANNELS; k++) free(r->samples[i][k]);
    }
    *r = (frame_result){0};
}
