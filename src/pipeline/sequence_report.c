#include "pipeline/sequence_report.h"

#include <stdlib.h>

#include "pipeline/json.h"
#include "pipeline/report.h"

void sequence_report_begin(sequence_report *s)
{
    *s = (sequence_report){.frames = json_object_new_array(), .since = stopwatch_start()};
}

void sequence_report_free(sequence_report *s)
{
    json_object_put(s->frames);
    *s = (sequence_report){0};
}

static void add_result(sequence_report *s, json_object *o, const frame_result *r)
{
    double pixels = (double)r->gb.width * r->gb.height;
    json_put_number(o, "radius", r->set.radius);
    json_put_number(o, "valid_share", pixels > 0 ? (double)r->gb.valid / pixels : 0.0);
    json_put_number(o, "off_frame_share", report_off_frame_share(r));
    json_put(o, "clamped_samples", json_object_new_int64((int64_t)r->clamped));
    if (r->set.target_error > 0.0) json_put(o, "rounds", report_rounds(r));
    s->clamped += r->clamped;
    for (int i = 0; i < STAGE_COUNT; i++) {
        s->wall_ms[i] += r->wall_ms[i];
        s->cpu_ms[i] += r->cpu_ms[i];
    }
}

void sequence_report_add(sequence_report *s, const sequence_frame *f)
{
    if (!s->frames) return;
    char text[ERROR_TEXT];
    json_object *o = json_object_new_object();
    json_put(o, "frame", json_object_new_int(f->frame));
    json_put_text(o, "status", f->failure ? "failed" : f->why ? "skipped" : "done");
    if (f->failure) err_format(f->failure, text, sizeof text);
    if (f->failure || f->why) json_put_text(o, "why", f->failure ? text : f->why);
    json_put_text(o, "input", f->input);
    json_put_text(o, "output", f->output);
    json_put_number(o, "seconds", f->seconds);
    if (f->failure)
        s->failed++;
    else if (f->why)
        s->skipped++;
    else
        s->done++;
    if (!f->failure && !f->why) add_result(s, o, f->r);
    json_object_array_add(s->frames, o);
}

// The frames of the shot that were looked at for what a frame does not show, once any was.
static void put_surround(json_object *o, const job *j)
{
    char text[256];
    if (!j->files || j->files->shot.count == 0 || !j->views_loaded) return;
    frames_format(&j->files->shot, text, sizeof text);
    json_put_text(o, "surround_frames", text);
}

// What bounds the sequence: the thread that is busy nearly all the time, or, where `cores` is near the machine's, the CPU.
static json_object *busy_of(const sequence_report *s)
{
    static const char *const names[SEQUENCE_THREADS] = {"read", "gpu", "write"};
    double wall = 0.0, cpu = 0.0;
    stopwatch t = s->since;
    stopwatch_add(&t, &wall, &cpu);
    json_object *o = json_object_new_object();
    for (int i = 0; i < SEQUENCE_THREADS; i++) json_put_number(o, names[i], wall > 0.0 ? s->busy_ms[i] / wall : 0.0);
    json_put_number(o, "cores", wall > 0.0 ? cpu / wall : 0.0);
    json_put_number(o, "wall_ms", wall);
    return o;
}

bool sequence_report_write(sequence_report *s, const job *j, const frame_list *failures, const char *path, error *e)
{
    char failed[512], *args = options_record(j->o, e);
    if (!args) return false;
    json_object *o = json_object_new_object(), *times = json_object_new_array(), *warnings = json_object_new_array();
    frames_format(failures, failed, sizeof failed);
    json_put_text(o, "version", SSDO_VERSION);
    json_put_text(o, "device", j->g.renderer);
    if (j->g.software) json_put_text(o, "why_software", j->g.why_software);
    json_put_text(o, "args", args);
    free(args);
    if (j->is_shot && j->o->radius_unit == RADIUS_AUTO) json_put_number(o, "radius", j->shot.radius);
    put_surround(o, j);
    json_put(o, "done", json_object_new_int(s->done));
    json_put(o, "skipped", json_object_new_int(s->skipped));
    json_put(o, "failed", json_object_new_int(s->failed));
    json_put_text(o, "failed_frames", failed);
    json_put(o, "stopped", json_object_new_boolean(job_stopped(j)));
    for (int i = 0; i < STAGE_COUNT; i++)
        json_object_array_add(times, json_time(report_stage_names[i], s->wall_ms[i], s->cpu_ms[i]));
    json_put(o, "times", times);
    json_put(o, "busy", busy_of(s));
    json_put(o, "clamped_samples", json_object_new_int64((int64_t)s->clamped));
    log_each_warning(j->log, json_add_text, warnings);
    json_put(o, "warnings", warnings);
    json_put(o, "frames", s->frames);
    s->frames = NULL;
    return json_save(o, path, e);
}
