// argv to job.

#include <errno.h>
#include <locale.h>
#include <stdio.h>
#include <string.h>

#include "base/knobs.h"
#include "base/mem.h"
#include "base/outfile.h"
#include "base/text.h"
#include "cli/names.h"
#include "cli/options.h"
#include "cli/signals.h"
#include "exr/library.h"
#include "pipeline/batch.h"
#include "pipeline/complete.h"
#include "pipeline/explain.h"
#include "pipeline/files.h"
#include "pipeline/frame.h"
#include "pipeline/inputs.h"
#include "pipeline/preview.h"
#include "pipeline/report.h"
#include "pipeline/resume.h"

static int fail(const options *o, const error *e)
{
    char text[ERROR_TEXT];
    err_format(e, text, sizeof text);
    text_one_line(text);
    fprintf(stderr, "ssdo-filter: %s\n", text);
    progress_fail(o->progress, text);
    return (int)e->code;
}

static void list_devices(void)
{
    gpu_device list[32];
    int n = gpu_list_devices(list, 32);
    bool hardware = false;
    for (int i = 0; i < n; i++) {
        printf("%d  %s\n", i, list[i].description);
        hardware |= list[i].usable && !list[i].software;
    }
    const char *why = hardware ? gpu_missing_device() : gpu_missing_hardware();
    if (why) printf("note: %s\n", why);
    if (n == 0) puts("no EGL devices; the surfaceless platform may still work");
}

static bool run_frame(job *j, error *e)
{
    const options *o = j->o;
    frame_result r = {0};
    progress p;
    progress_begin(&p, o->progress, 1, j->log);
    j->progress = &p;
    frame_record record;
    // What was made before is compared with the device; otherwise the frame is read while the device opens.
    bool ok = record_make(j, 0, &record, e) && (!o->skip_existing || job_open_device(j, e));
    const char *why = ok ? resume_skips(j, 0, o->inputs, o->input_count, o->output, &record) : NULL;
    if (why) {
        progress_line(&p, "%s: skipped, %s", o->output, why);
        progress_finish(&p, PROGRESS_STEPS);
    } else {
        ok = ok && frame_run_files(j, o->inputs, o->input_count, o->output, &record, &r, e) &&
             (!o->preview || preview_write(o, &r, o->preview, e)) && (!o->report || report_write(j, &r, o->output, o->report, e));
    }
    frame_free(&r);
    progress_end(&p);
    j->progress = NULL;
    return ok;
}

// What would be found wrong only when the work is done.
static bool check_targets(const options *o, error *e)
{
    return outfile_check_folder(o->output, e) && (!o->preview || outfile_check_folder(o->preview, e)) &&
           (!o->report || outfile_check_folder(o->report, e)) && preview_check(o, e);
}

// Nothing is opened before it is sure that nothing will be lost; a sequence's frames are listed and compared by the batch.
static bool run_on(const options *o, run_files *files, const volatile int *stop_signal, log_t *log, error *e)
{
    job j;
    if (!inputs_are_framed(o) && !run_files_check(files, (const int[]){0}, 1, e)) return false;
    if (!run_files_read(files, o, e)) return false;
    job_open(&j, o, log);
    j.stop = stop_signal;
    j.no_floats = !o->preview;
    j.files = files;
    bool ok = check_targets(o, e) && (inputs_are_framed(o) ? batch_run(&j, e) : run_frame(&j, e));
    job_close(&j);
    return ok;
}

// For tests and for work on the shaders: nobody should have one set unknowingly.
static void warn_of_knobs(log_t *log)
{
    for (const knob *k = knobs; k->name; k++)
        if (k->pixels && knob_value(k->name))
            log_warn(log, k->name,
                     "the environment variable %s is set (%s): pixels may differ from those without it; the record names it",
                     k->name, knob_value(k->name));
}

static bool run(const options *o, const volatile int *stop_signal, log_t *log, error *e)
{
    warn_of_knobs(log);
    run_files files;
    names_warn(o, log);
    bool ok = run_files_list(o, &files, e) && run_on(o, &files, stop_signal, log, e);
    run_files_free(&files);
    return ok;
}

// What is asked for is text on standard output, not a frame. *ok: it could be told.
static bool tell(const options *o, bool *ok, error *e)
{
    if (o->help)
        help_write(stdout);
    else if (o->version)
        puts("ssdo-filter " SSDO_VERSION);
    else if (o->completion)
        complete_write(stdout, o->completion);
    else if (o->list_devices)
        list_devices();
    else if (o->explain)
        *ok = exrio_library_check(e) && explain_write(o, stdout, e);
    else
        return false;
    return true;
}

// A text that did not arrive was not told.
static bool finish_output(error *e)
{
    if (fflush(stdout) == 0 && !ferror(stdout)) return true;
    return err_set(e, ERR_OUTPUT, NULL, NULL, "cannot write to standard output: %s", strerror(errno));
}

int main(int argc, char **argv)
{
    error e = {0};
    options o;
    mem_set_up();
    setlocale(LC_NUMERIC, "C"); // whatever LC_ALL says
    const volatile int *stop_signal = signals_catch();
    options_defaults(&o);
    if (!options_parse(argc, argv, &o, &e)) return fail(&o, &e);
    if (!names_are_literal(&o, &o.literal, &e)) return fail(&o, &e);
    bool ok = true, told = tell(&o, &ok, &e);
    if (told) return finish_output(&e) && ok ? 0 : fail(&o, &e);
    log_t log;
    log_init(&log, o.quiet ? LOG_QUIET : o.verbose ? LOG_INFO : LOG_WARN);
    ok = exrio_library_check(&e) && run(&o, stop_signal, &log, &e);
    log_free(&log);
    if (*stop_signal) return 128 + *stop_signal;
    return ok ? 0 : fail(&o, &e);
}
