#include "cli/progress.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/text.h"

enum { BAR_WIDTH = 30, PLAIN_STEP = 5 };

static double seconds(void) { return 1e-3 * clock_wall_ms(); }

static progress_form resolve_form(progress_form form, int frames, const log_t *log)
{
    if (form != PROGRESS_AUTO) return form;
    if (log->level == LOG_QUIET) return PROGRESS_NONE;
    if (isatty(STDERR_FILENO)) return PROGRESS_BAR;
    return frames > 1 ? PROGRESS_PLAIN : PROGRESS_NONE;
}

static int percent_of(const progress *p) { return (int)(100LL * p->done / ((long long)p->frames * PROGRESS_STEPS)); }

double progress_eta(double elapsed, int worked, int left) { return worked > 0 ? elapsed * left / worked : -1.0; }

void progress_bar_text(const progress *p, double elapsed, char *text, size_t size)
{
    int percent = percent_of(p), all = p->frames * PROGRESS_STEPS;
    char bar[BAR_WIDTH + 1], left[32] = "";
    for (int i = 0; i < BAR_WIDTH; i++) bar[i] = i * 100 < percent * BAR_WIDTH ? '#' : '.';
    bar[BAR_WIDTH] = '\0';
    double eta = progress_eta(elapsed, p->done - p->skipped, all - p->done);
    long s = lrint(eta < 0.0 ? 0.0 : fmin(eta, 1e7));
    if (eta >= 0.0 && s >= 3600)
        snprintf(left, sizeof left, "  %ld:%02ld:%02ld left", s / 3600, s / 60 % 60, s % 60);
    else if (eta >= 0.0)
        snprintf(left, sizeof left, "  %ld:%02ld left", s / 60, s % 60);
    snprintf(text, size, "[%s] %3d %%  %d of %d frame%s%s", bar, percent, p->finished, p->frames, p->frames == 1 ? "" : "s",
             left);
}

// The caller holds the log's lock.
static void show(progress *p)
{
    char text[160];
    int percent = percent_of(p);
    if (p->form == PROGRESS_BAR) {
        progress_bar_text(p, seconds() - p->started, text, sizeof text);
        fprintf(stderr, "%s%s", LOG_WIPE, text);
        p->log->bar = true;
    }
    int step = p->form == PROGRESS_PLAIN && percent < 100 ? PLAIN_STEP : 1;
    if (p->shown >= 0 && percent < p->shown + step) return;
    p->shown = percent;
    if (p->form == PROGRESS_PLAIN) printf("%d %%\n", percent);
    if (p->form == PROGRESS_ALF) printf("ALF_PROGRESS %d%%\n", percent);
    if (p->form == PROGRESS_OPENJD) printf("openjd_progress: %d\n", percent);
    fflush(stdout);
}

void progress_begin(progress *p, progress_form form, int frames, log_t *log)
{
    *p = (progress){.form = resolve_form(form, frames, log), .log = log, .frames = frames, .shown = -1, .started = seconds()};
    pthread_mutex_lock(&log->lock);
    show(p);
    pthread_mutex_unlock(&log->lock);
}

static void advance(progress *p, int worked, int left, int frames)
{
    if (!p || p->form == PROGRESS_NONE) return;
    pthread_mutex_lock(&p->log->lock);
    p->done += worked + left;
    p->skipped += left;
    p->finished += frames;
    show(p);
    pthread_mutex_unlock(&p->log->lock);
}

void progress_step(progress *p) { advance(p, 1, 0, 0); }
void progress_finish(progress *p, int left) { advance(p, 0, left, 1); }

void progress_line(progress *p, const char *format, ...)
{
    if (!p || (p->log->level == LOG_QUIET && p->form != PROGRESS_OPENJD)) return;
    char text[4400];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    text_one_line(text);
    pthread_mutex_lock(&p->log->lock);
    log_wipe(p->log);
    printf("%s%s\n", p->form == PROGRESS_OPENJD ? "openjd_status: " : "", text);
    fflush(stdout);
    pthread_mutex_unlock(&p->log->lock);
}

void progress_end(progress *p)
{
    if (!p || !p->log) return;
    pthread_mutex_lock(&p->log->lock);
    log_wipe(p->log);
    pthread_mutex_unlock(&p->log->lock);
}

void progress_fail(progress_form form, const char *text)
{
    if (form != PROGRESS_OPENJD) return;
    printf("openjd_fail: %s\n", text);
    fflush(stdout);
}
