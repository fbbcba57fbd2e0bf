#include "pipeline/batch.h"

#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/mem.h"
#include "cli/frames.h"
#include "exr/write.h"
#include "pipeline/inputs.h"
#include "pipeline/preview.h"
#include "pipeline/report.h"
#include "pipeline/resume.h"
#include "pipeline/sequence_report.h"
#include "pipeline/settings.h"

enum { PATH = 4096, NEIGHBOURS = 256 };

typedef enum state { EMPTY, WAS_READ, FILTERED } state;

// A frame in flight. It belongs to the thread whose turn its state says it is.
typedef struct slot {
    state state;
    int frame;
    bool skipped; // nothing to do, by --missing skip or --skip-existing
    const char *why;
    int steps; // of its progress
    input_paths inputs;
    char output[PATH];
    frame_result result;
    error error;
    double started; // wall time in ms
} slot;

typedef struct batch {
    job *j;
    progress progress;
    frame_list frames;
    slot slots[BATCH_MOST_IN_FLIGHT];
    int in_flight; // of them
    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool give_up; // a frame failed, and nobody asked to keep going
    int done, failed, skipped;
    frame_list failures;
    sequence_report report;
} batch;

static bool stopping(const batch *b) { return job_stopped(b->j) || b->give_up; }

static slot *slot_of(batch *b, int index) { return &b->slots[index % b->in_flight]; }

// Waits for a slot's turn.
static slot *take(batch *b, int index, state wanted)
{
    slot *s = slot_of(b, index);
    pthread_mutex_lock(&b->lock);
    while (s->state != wanted) pthread_cond_wait(&b->changed, &b->lock);
    pthread_mutex_unlock(&b->lock);
    return s;
}

static void pass_on(batch *b, slot *s, state next)
{
    pthread_mutex_lock(&b->lock);
    s->state = next;
    pthread_cond_broadcast(&b->changed);
    pthread_mutex_unlock(&b->lock);
}

static bool locked_stopping(batch *b)
{
    pthread_mutex_lock(&b->lock);
    bool s = stopping(b);
    pthread_mutex_unlock(&b->lock);
    return s;
}

static bool is_read(batch *b, const slot *s)
{
    pthread_mutex_lock(&b->lock);
    bool is = s->state == WAS_READ;
    pthread_mutex_unlock(&b->lock);
    return is;
}

static void step(batch *b, slot *s)
{
    s->steps++;
    progress_step(&b->progress);
}

static void skip(slot *s, const char *why)
{
    s->skipped = true;
    s->why = why;
}

static bool prepare(const batch *b, slot *s)
{
    s->result.frame = s->frame;
    return frame_prepare(b->j, &s->result, &s->error);
}

static void read_slot(batch *b, slot *s, int frame)
{
    const options *o = b->j->o;
    s->frame = frame;
    s->skipped = false;
    s->why = NULL;
    s->steps = 0;
    s->error = (error){0};
    s->result = (frame_result){0};
    s->started = clock_wall_ms();
    if (!inputs_of_frame(o, frame, &s->inputs) || !pattern_path(o->output, frame, s->output, sizeof s->output)) {
        err_set(&s->error, ERR_USAGE, NULL, NULL, "the path of frame %d is too long", frame);
        return;
    }
    frame_record record;
    if (!record_make(b->j, frame, &record, &s->error)) return;
    const char *why = resume_skips(b->j, frame, s->inputs.list, s->inputs.count, s->output, &record);
    if (why)
        skip(s, why);
    else if (frame_read_files(b->j, s->inputs.list, s->inputs.count, &s->result, &s->error) && prepare(b, s))
        step(b, s);
    s->result.record = record;
}

static void count_busy(batch *b, sequence_thread who, stopwatch *since)
{
    double cpu = 0.0; // the process's: it says nothing of one thread
    stopwatch_add(since, &b->report.busy_ms[who], &cpu);
}

static void read_one(batch *b, int i)
{
    slot *s = take(b, i, EMPTY);
    stopwatch t = stopwatch_start();
    if (!locked_stopping(b))
        read_slot(b, s, b->frames.frames[i]);
    else
        skip(s, NULL);
    count_busy(b, SEQUENCE_READER, &t);
    pass_on(b, s, WAS_READ);
}

static void *reader(void *arg)
{
    batch *b = arg;
    for (int i = 0; i < b->frames.count; i++) read_one(b, i);
    return NULL;
}

static double seconds_since(double started) { return 1e-3 * (clock_wall_ms() - started); }

static void note_failure(batch *b, const slot *s)
{
    char text[ERROR_TEXT];
    err_format(&s->error, text, sizeof text);
    log_error(b->j->log, "frame %d: %s", s->frame, text);
    b->failures.frames[b->failures.count++] = s->frame;
    sequence_report_add(
        &b->report, &(sequence_frame){s->frame, s->inputs.list[0], s->output, NULL, &s->error, NULL, seconds_since(s->started)});
    pthread_mutex_lock(&b->lock);
    b->failed++;
    if (!b->j->o->keep_going) b->give_up = true;
    pthread_mutex_unlock(&b->lock);
}

static void summary(batch *b, const slot *s, int index)
{
    double seconds = seconds_since(s->started);
    sequence_report_add(&b->report, &(sequence_frame){s->frame, s->inputs.list[0], s->output, s->why, NULL, &s->result, seconds});
    if (s->skipped)
        progress_line(&b->progress, "frame %d (%d of %d): skipped, %s", s->frame, index + 1, b->frames.count, s->why);
    else
        progress_line(&b->progress, "frame %d (%d of %d): %s, %.2f s", s->frame, index + 1, b->frames.count, s->output, seconds);
}

static bool write_extras(const batch *b, const slot *s, error *e)
{
    const options *o = b->j->o;
    char path[PATH];
    bool look = o->preview && s->frame % o->preview_every == 0;
    if (look && (!pattern_path(o->preview, s->frame, path, sizeof path) || !preview_write(o, &s->result, path, e))) return false;
    return !o->report || !pattern_is(o->report) ||
           (pattern_path(o->report, s->frame, path, sizeof path) && report_write(b->j, &s->result, s->output, path, e));
}

static void write_slot(batch *b, slot *s, int index)
{
    if (s->skipped && !s->why) return; // dropped by a stop
    if (!s->skipped && s->error.code == ERR_NONE && frame_convert(b->j, &s->result, &s->error) &&
        frame_write(b->j, &s->result, s->output, &s->error) && write_extras(b, s, &s->error))
        step(b, s);
    progress_finish(&b->progress, PROGRESS_STEPS - s->steps);
    if (s->error.code != ERR_NONE) {
        note_failure(b, s);
    } else {
        summary(b, s, index);
        if (s->skipped)
            b->skipped++;
        else
            b->done++;
    }
    frame_free(&s->result);
}

static void write_one(batch *b, int i)
{
    slot *s = take(b, i, FILTERED);
    stopwatch t = stopwatch_start();
    write_slot(b, s, i);
    count_busy(b, SEQUENCE_WRITER, &t);
    pass_on(b, s, EMPTY);
}

static void *writer(void *arg)
{
    batch *b = arg;
    for (int i = 0; i < b->frames.count; i++) write_one(b, i);
    return NULL;
}

// The GL thread's share of a frame: its layers are on their way when it returns.
static void begin_slot(batch *b, slot *s)
{
    if (s->skipped || s->error.code != ERR_NONE) return;
    stopwatch t = stopwatch_start();
    if (!locked_stopping(b) && frame_begin(b->j, &s->result, &s->error)) {
        step(b, s);
    } else if (s->error.code == ERR_NONE) {
        frame_free(&s->result);
        skip(s, NULL);
    }
    count_busy(b, SEQUENCE_GPU, &t);
}

// Hands a frame on, once its layers have arrived.
static void end_slot(batch *b, slot *s)
{
    stopwatch t = stopwatch_start();
    if (!s->skipped && s->error.code == ERR_NONE) frame_wait(b->j, &s->result, &s->error);
    count_busy(b, SEQUENCE_GPU, &t);
    pass_on(b, s, FILTERED);
}

// The layers of a frame travel while the next one's passes run, if that has been read.
static void filter_all(batch *b, bool read_here, bool write_here)
{
    slot *under_way = NULL;
    for (int i = 0; i < b->frames.count; i++) {
        if (read_here) read_one(b, i);
        slot *next = slot_of(b, i);
        if (under_way && !is_read(b, next)) {
            end_slot(b, under_way);
            under_way = NULL;
        }
        slot *s = take(b, i, WAS_READ);
        begin_slot(b, s);
        if (under_way) end_slot(b, under_way);
        under_way = !write_here && frame_is_under_way(&s->result) ? s : NULL;
        if (!under_way) end_slot(b, s);
        if (write_here) write_one(b, i);
    }
    if (under_way) end_slot(b, under_way);
}

static bool list_frames(const options *o, frame_list *out, error *e)
{
    if (o->input_count > 0 && !pattern_is(o->inputs[0]))
        return err_set(e, ERR_USAGE, o->inputs[0], NULL,
                       "--frames needs a place for the frame in the input's name: ####, %%04d or $F4");
    if (!pattern_is(o->output))
        return err_set(e, ERR_USAGE, o->output, NULL,
                       "a sequence needs a place for the frame in the output's name: ####, %%04d or $F4");
    if (o->preview && !pattern_is(o->preview))
        return err_set(e, ERR_USAGE, o->preview, NULL,
                       "a sequence needs a place for the frame in the preview's name: ####, %%04d or $F4");
    if (o->frames) return frames_parse(o->frames, out, e);
    if (!pattern_scan(o->inputs[0], out, e)) return false;
    if (out->count == 0) return err_set(e, ERR_INPUT, o->inputs[0], NULL, "no file fits this pattern");
    return true;
}

static bool measure_shot(job *j, int frame, error *e)
{
    input_paths *in = mem_zero(1, sizeof *in, e);
    bool ok = in && inputs_of_frame(j->o, frame, in) && frame_measure_shot(j, in->list, in->count, &j->shot, e);
    if (ok && j->o->radius_unit == RADIUS_AUTO)
        log_info(j->log, "radius: %g scene units for the whole sequence, from %s", j->shot.radius, in->list[0]);
    if (ok && plan_asks_outside(j->o))
        log_info(j->log, "outside: %g open for the whole sequence, from %s", openness_mean(&j->shot.outside), in->list[0]);
    j->is_shot = ok;
    free(in);
    return ok || err_set(e, ERR_USAGE, j->o->inputs[0], NULL, "the path of frame %d is too long", frame);
}

// The lowest-numbered existing frame serves; with --keep-going the next one that can be read. Every task of a farm sees the same
// files, and so finds the same; what the system refuses here it may allow elsewhere, so that stops the run.
static bool measure_lowest(job *j, const frame_list *existing, error *e)
{
    char why[1600];
    error first = {0};
    for (int i = 0; i < existing->count && !job_stopped(j); i++) {
        error here = {0};
        if (measure_shot(j, existing->frames[i], &here)) {
            if (i > 0)
                log_warn(j->log, "radius-from",
                         "the automatic radius and --outside auto are from frame %d, because frame %d cannot be used: %s",
                         existing->frames[i], existing->frames[0], why);
            return true;
        }
        if (i == 0) first = here;
        if (i == 0) err_format(&here, why, sizeof why);
        if (here.refused) first = here;
        if (here.code != ERR_INPUT || here.refused || !j->o->keep_going) break;
    }
    if (first.code != ERR_INPUT)
        *e = first;
    else
        err_set(e, first.code, first.file, first.channel,
                "%s. The automatic radius and --outside auto of the sequence are measured on this frame; --radius-from names "
                "another%s",
                first.message, j->o->keep_going || first.refused ? "" : ", --keep-going takes the next one that can be read");
    return false;
}

// The same automatic radius and outside for every frame and every farm task, whatever --frames says.
static bool fix_shot(job *j, error *e)
{
    frame_list existing = {0};
    if (j->o->radius_unit != RADIUS_AUTO && !plan_asks_outside(j->o)) return true;
    if (j->o->radius_from != INT_MIN) return measure_shot(j, j->o->radius_from, e);
    if (!pattern_scan(j->o->inputs[0], &existing, e)) return false;
    if (existing.count == 0) return err_set(e, ERR_INPUT, j->o->inputs[0], NULL, "no file fits this pattern");
    bool ok = measure_lowest(j, &existing, e);
    frames_free(&existing);
    return ok;
}

static bool holds(const frame_list *l, int frame)
{
    for (int i = 0; i < l->count; i++)
        if (l->frames[i] == frame) return true;
    return false;
}

// The device of a frame of the shot that this run does not make again: the first such among the first NEIGHBOURS outputs.
static void compare_device(const batch *b)
{
    frame_list existing;
    char path[PATH];
    error ignored = {0};
    if (!pattern_scan(b->j->o->output, &existing, &ignored)) return;
    for (int i = 0; i < existing.count && i < NEIGHBOURS; i++) {
        if (holds(&b->frames, existing.frames[i]) || !pattern_path(b->j->o->output, existing.frames[i], path, sizeof path))
            continue;
        resume_check_device(b->j, path);
        break;
    }
    frames_free(&existing);
}

// What is said once all frames have had their turn.
static bool conclude(const batch *b, error *e)
{
    char list[512];
    int count = b->frames.count, finished = b->done + b->skipped;
    if (job_stopped(b->j))
        log_warn(b->j->log, "stopped",
                 "stopped: %d of %d frames are finished; the same command with --skip-existing does the rest", finished, count);
    if (!b->failed) return true;
    frames_format(&b->failures, list, sizeof list);
    return err_set(e, ERR_FRAMES, NULL, NULL, "%d of %d frames failed: %s", b->failed, count, list);
}

bool batch_run(job *j, error *e)
{
    pthread_t threads[2];
    if (!job_open_device(j, e)) return false;
    batch *b = mem_zero(1, sizeof *b, e);
    if (!b) return false;
    b->j = j;
    j->no_pass_times = j->o->report && !pattern_is(j->o->report);
    b->in_flight = j->g.mapped ? BATCH_MOST_IN_FLIGHT : BATCH_IN_FLIGHT;
    pthread_mutex_init(&b->lock, NULL);
    pthread_cond_init(&b->changed, NULL);
    bool ok = list_frames(j->o, &b->frames, e) &&
              (!j->files || run_files_check(j->files, b->frames.frames, b->frames.count, e)) && fix_shot(j, e);
    b->failures.frames = ok ? mem_zero((size_t)b->frames.count, sizeof *b->failures.frames, e) : NULL;
    ok = ok && b->failures.frames;
    if (ok) compare_device(b);
    if (ok && j->o->report && !pattern_is(j->o->report)) sequence_report_begin(&b->report);
    if (ok) progress_begin(&b->progress, j->o->progress, b->frames.count, j->log);
    bool reading = ok && pthread_create(&threads[0], NULL, reader, b) == 0;
    bool writing = reading && pthread_create(&threads[1], NULL, writer, b) == 0;
    if (ok) {
        // Without a thread of their own, reading or writing are done here, a frame at a time.
        filter_all(b, !reading, !writing);
        if (reading) pthread_join(threads[0], NULL);
        if (writing) pthread_join(threads[1], NULL);
        progress_end(&b->progress);
        if (b->report.frames) ok = sequence_report_write(&b->report, j, &b->failures, j->o->report, e);
        ok = conclude(b, e) && ok;
    }
    frames_free(&b->failures);
    frames_free(&b->frames);
    sequence_report_free(&b->report);
    pthread_cond_destroy(&b->changed);
    pthread_mutex_destroy(&b->lock);
    free(b);
    return ok;
}
