#include "pipeline/frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pipeline/filter.h"
#include "pipeline/further_views.h"
#include "pipeline/output.h"
#include "pipeline/outside_fit.h"
#include "pipeline/read_back.h"
#include "pipeline/settings.h"

// The environment is prepared with the first frame, because its default up axis is the renderer's.
static bool load_light(job *j, const frame_result *r, const char *path, double rotate, double scale, job_light *light, error *e)
{
    double primaries[8];
    if (!r->plan.light || light->loaded) return true;
    env_options eo = {.path = path,
                      .up_z = settings_up_z(j, r),
                      .rotate_degrees = rotate,
                      .scale = scale,
                      .threads = j->threads,
                      .colorspace = j->o->env_colorspace,
                      .primaries = exrio_attr_chromaticities(r->file, r->resolution.main_part, primaries) ? primaries : NULL,
                      .ocio = j->o->ocio};
    if (!environment_load(&eo, &light->env, j->log, e)) return false;
    light->loaded = true;
    if (!path) log_warn(j->log, "white", "no --env: radiance is that of a white environment of radiance 1");
    return pass_upload_environment(&j->g, &light->env, &light->image, e);
}

// The light that the fit of the outside takes for the picture's own.
static bool prepare_beauty_light(job *j, const frame_result *r, job_light **out, error *e)
{
    const options *o = j->o;
    bool same = !o->beauty_env || (o->env && strcmp(o->env, o->beauty_env) == 0 && o->env_rotate == o->beauty_env_rotate &&
                                   o->env_scale == o->beauty_env_scale);
    *out = same ? &j->light : &j->beauty_light;
    return same || load_light(j, r, o->beauty_env, o->beauty_env_rotate, o->beauty_env_scale, *out, e);
}

static bool prepare_light(job *j, frame_result *r, error *e)
{
    const options *o = j->o;
    job_light *lit;
    if (!load_light(j, r, o->env, o->env_rotate, o->env_scale, &j->light, e)) return false;
    if (!r->plan.need_to_fit || j->is_shot) return true;
    return prepare_beauty_light(j, r, &lit, e) && outside_fit(j, r, lit, o->beauty_env, &r->set.outside, e);
}

// Of all views: what the first one's light tells of the outside holds for the others.
static bool prepare_lights(job *j, frame_result *r, error *e)
{
    for (frame_result *v = r; v; v = v->next_view) {
        if (v != r) v->plan.need_to_fit = 0, v->set.outside = r->set.outside;
        if (!further_views_load(j, v, e) || !prepare_light(j, v, e)) return false;
    }
    return true;
}

bool frame_begin(job *j, frame_result *r, error *e)
{
    if (!job_open_device(j, e)) return false;
    if (!prepare_lights(j, r, e)) return false;
    for (frame_result *v = r; v; v = v->next_view)
        if (!filter_begin(j, v, e)) return false;
    return true;
}

bool frame_is_under_way(const frame_result *r)
{
    for (; r; r = r->next_view)
        if (r->band_count > 0) return true;
    return false;
}

bool frame_wait(job *j, frame_result *r, error *e)
{
    stopwatch t = stopwatch_start();
    for (frame_result *v = r; v; v = v->next_view)
        if (!read_back_wait(j, v, e)) return false;
    result_lap(r, STAGE_READ_BACK, &t);
    return true;
}

bool frame_convert(const job *j, frame_result *r, error *e)
{
    for (frame_result *v = r; v; v = v->next_view)
        if (!read_back_convert(j, v, e)) return false;
    return true;
}

bool frame_filter(job *j, frame_result *r, error *e)
{
    if (!job_open_device(j, e) || !frame_prepare(j, r, e)) return false;
    if (!prepare_lights(j, r, e)) return false;
    for (frame_result *v = r; v; v = v->next_view)
        if (!filter_frame(j, v, e)) return false;
    return true;
}

bool frame_write(const job *j, frame_result *r, const char *output, error *e)
{
    stopwatch t = stopwatch_start();
    if (!record_check(&r->record, e) || !output_write(j, r, output, e)) return false;
    result_lap(r, STAGE_WRITE, &t);
    if (r->clamped)
        log_warn(j->log, "clamped", "%zu samples were beyond what half can hold and were clamped; --float keeps them",
                 r->clamped);
    return true;
}

bool frame_run(job *j, const char *input, const char *output, frame_result *r, error *e)
{
    return frame_run_files(j, &input, 1, output, NULL, r, e);
}

bool frame_make(job *j, const char *const *inputs, int count, const frame_record *record, frame_result *r, error *e)
{
    *r = (frame_result){0};
    if (!read_and_open(j, inputs, count, r, e)) return false;
    if (record) r->record = *record;
    progress_step(j->progress);
    if (job_stopped(j) || !frame_filter(j, r, e)) return false;
    progress_step(j->progress);
    return true;
}

bool frame_run_files(job *j, const char *const *inputs, int count, const char *output, const frame_record *record,
                     frame_result *r, error *e)
{
    if (!frame_make(j, inputs, count, record, r, e) || !frame_write(j, r, output, e)) return false;
    progress_step(j->progress);
    progress_finish(j->progress, 0);
    return true;
}

bool frame_measure_shot(job *j, const char *const *inputs, int count, shot_facts *shot, error *e)
{
    frame_result r;
    bool ok = frame_read_files(j, inputs, count, &r, e);
    if (ok) {
        *shot = settings_measure_shot(j, &r);
        r.set = settings_of(j, &r, *shot);
        ok = !r.plan.need_to_fit || (frame_check_world(j, &r, e) && prepare_lights(j, &r, e));
        shot->outside = r.set.outside;
    }
    frame_free(&r);
    return ok;
}

static void free_view(frame_result *r)
{
    for (int i = 0; i < LAYER_COUNT; i++) {
        free(r->layers[i]);
        for (int k = 0; k < LAYER_CHANNELS; k++) free(r->samples[i][k]);
    }
    read_back_drop(r);
    gbuffer_free(&r->half_size);
    gbuffer_free(&r->lit);
    pixel_list_free(&r->lone);
    for (int k = 0; k < SH_IMAGES; k++) free(r->relight_sh[k]);
    proxies_free(&r->proxies);
    gbuffer_free(&r->gb);
}

void frame_free(frame_result *r)
{
    for (frame_result *v = r->next_view, *next; v; v = next) {
        next = v->next_view;
        free_view(v);
        free(v);
    }
    free_view(r);
    exrio_file_close(r->file);
    *r = (frame_result){0};
}
