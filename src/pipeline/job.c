#include "pipeline/job.h"

#include "base/threads.h"
#include "passes/surround_image.h"
#include "plugin/colour.h"

void job_open(job *j, const options *o, log_t *log)
{
    *j = (job){.o = o, .log = log, .threads = o->threads > 0 ? o->threads : threads_default()};
    if (!o->hosted) gpu_set_up();
    if (!colour_config(o->ocio))
        log_info(log, "colour: no OpenColorIO config, so beauty, albedo and environment count as linear");
}

bool job_open_device(job *j, error *e)
{
    const gpu_request request = {
        .device = j->o->device, .hardware = j->o->require_gpu, .debug = j->o->gpu_debug, .hosted = j->o->hosted};
    if (j->g.context) return true;
    if (!gpu_open_as(&j->g, request, j->log, e)) return false;
    j->g.threads = j->threads;
    return true;
}

bool job_stopped(const job *j) { return j->stop && *j->stop; }

static void forget(job_light *l)
{
    gpu_image_free(&l->image);
    gpu_image_free(&l->sunless.map);
    surround_image_free(&l->surround);
    if (l->loaded) environment_free(&l->env);
    *l = (job_light){0};
}

void job_forget_light(job *j)
{
    forget(&j->light);
    forget(&j->beauty_light);
    trace_scene_close(&j->trace);
    for (int i = 0; i < j->view_count; i++) world_view_free(&j->views[i]);
    j->view_count = 0;
    j->views_loaded = false;
    gpu_image_free(&j->further);
    j->trace = (trace_scene){0};
}

void job_close(job *j)
{
    job_forget_light(j);
    gpu_close(&j->g);
}
