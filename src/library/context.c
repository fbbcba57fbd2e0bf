#include "library/objects.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/threads.h"
#include "exr/library.h"
#include "library/memory_file.h"
#include "library/settings.h"
#include "library/struct_size.h"

static void pass_message(void *of, log_level level, const char *text)
{
    const ssdo_context *c = of;
    if (c->setup.message) c->setup.message(c->setup.user, level == LOG_INFO ? SSDO_INFORMATION : SSDO_WARNING, text);
}

static bool begin(ssdo_context *c, const ssdo_setup *setup)
{
    error e = {0};
    if (!exrio_library_check(&e) || (setup && !struct_take(&c->setup, sizeof c->setup, setup, "ssdo_setup", &e))) return false;
    return settings_parse(c, &c->o, &e);
}

ssdo_context *ssdo_create(const ssdo_setup *setup)
{
    ssdo_context *c = mem_zero(1, sizeof *c, NULL);
    if (!c) return NULL;
    pthread_mutex_init(&c->call, NULL);
    worker_init(&c->worker);
    log_init(&c->log, LOG_WARN);
    if (!begin(c, setup)) {
        ssdo_destroy(c);
        return NULL;
    }
    if (c->setup.level == SSDO_INFORMATION) c->log.level = LOG_INFO;
    c->log.take = pass_message;
    c->log.context = c;
    return c;
}

static void close_device(void *of)
{
    ssdo_context *c = of;
    if (c->opened) job_close(&c->job);
    c->opened = false;
}

void ssdo_destroy(ssdo_context *c)
{
    if (!c) return;
    if (c->worker.started) worker_run(&c->worker, close_device, c);
    worker_end(&c->worker);
    settings_free(c);
    log_free(&c->log);
    pthread_mutex_destroy(&c->call);
    free(c);
}

// A call begins without an error and ends with its status.
static void begin_call(ssdo_context *c)
{
    pthread_mutex_lock(&c->call);
    c->e = (error){0};
    c->message[0] = '\0';
}

static ssdo_status end_call(ssdo_context *c, bool ok)
{
    ssdo_status status = ok ? SSDO_OK : c->e.code ? (ssdo_status)c->e.code : SSDO_STOPPED;
    if (status == SSDO_STOPPED)
        strcpy(c->message, "stopped");
    else if (!ok)
        err_format(&c->e, c->message, sizeof c->message);
    pthread_mutex_unlock(&c->call);
    return status;
}

ssdo_status ssdo_set(ssdo_context *c, const char *name, const char *value)
{
    begin_call(c);
    return end_call(c, settings_make(c, name, value, &c->e));
}

// What a frame is made of; the device is opened by the first.
typedef struct filtering {
    ssdo_context *c;
    const ssdo_input *input;
    ssdo_frame *frame;
    bool ok;
} filtering;

static bool same_device(const options *a, const options *b)
{
    return a->device == b->device && a->require_gpu == b->require_gpu && a->gpu_debug == b->gpu_debug && a->threads == b->threads;
}

// The job for a frame of these options; the frame itself opens the device, if it is not open.
static void open_for(ssdo_context *c, const options *o)
{
    if (c->opened && !same_device(&c->opened_for, o)) close_device(c);
    if (c->opened) {
        job_forget_light(&c->job); // which may be another's, or turned as another renderer has it
        c->job.o = o;
        return;
    }
    job_open(&c->job, o, &c->log);
    c->job.stop = &c->stop;
    c->opened_for = *o;
    c->opened = true;
}

static bool filter_paths(ssdo_context *c, const char *const *paths, int count, ssdo_frame *f)
{
    return frame_make(&c->job, paths, count, NULL, &f->result, &c->e);
}

static bool filter_memory(ssdo_context *c, const ssdo_input *in, ssdo_frame *f)
{
    char path[64];
    f->memory = memory_file_make(in, c->job.threads, &c->e);
    if (f->memory < 0) return false;
    snprintf(path, sizeof path, "/proc/self/fd/%d", f->memory);
    bool ok = filter_paths(c, &(const char *){path}, 1, f);
    if (strcmp(c->e.file, path) == 0) strcpy(c->e.file, "the G-buffer in memory");
    return ok;
}

static void run_filter(void *of)
{
    filtering *d = of;
    ssdo_context *c = d->c;
    ssdo_frame *f = d->frame;
    ssdo_input in;
    open_for(c, &f->o);
    d->ok = struct_take(&in, sizeof in, d->input, "ssdo_input", &c->e) &&
            (in.file_count > 0 && in.files ? filter_paths(c, in.files, in.file_count, f) : filter_memory(c, &in, f));
    strcpy(f->device, c->job.g.device);
    c->job.o = &c->o; // the frame may be freed before the next one
    if (!d->ok) ssdo_free_frame(f);
}

ssdo_status ssdo_filter(ssdo_context *c, const ssdo_input *input, ssdo_frame **frame)
{
    begin_call(c);
    *frame = NULL;
    c->stop = 0;
    ssdo_frame *f = mem_zero(1, sizeof *f, &c->e);
    filtering d = {.c = c, .input = input, .frame = f};
    if (f) f->maker = c, f->o = c->o, f->memory = -1;
    if (f && !worker_run(&c->worker, run_filter, &d)) {
        ssdo_free_frame(f);
        err_set(&c->e, ERR_MEMORY, NULL, NULL, "no thread can be started");
    }
    if (d.ok) *frame = f;
    return end_call(c, d.ok);
}

void ssdo_stop(ssdo_context *c) { c->stop = 1; }

const char *ssdo_message(const ssdo_context *c) { return c->message; }

ssdo_status ssdo_write(ssdo_context *c, ssdo_frame *f, const char *path)
{
    begin_call(c);
    if (f->maker != c)
        return end_call(
            c, err_set(&c->e, ERR_USAGE, NULL, NULL, "the frame is another context's; write it by the one that filtered it"));
    job j = {.o = &f->o, .log = &c->log, .threads = f->o.threads > 0 ? f->o.threads : threads_default()};
    strcpy(j.g.device, f->device);
    return end_call(c, frame_write(&j, &f->result, path, &c->e));
}

const char *ssdo_version(void) { return SSDO_VERSION; }
