// Progress of a run, for a person at a terminal or for a farm's supervisor.
//
// A run of `frames` frames has PROGRESS_STEPS equal steps a frame (read, filtered, written). Forms:
//   bar     [#####.....]  42 %  5 of 12 frames  0:35 left     one line on standard error, drawn over itself
//   plain   42 %                                              a line on standard output, 5 % apart at least
//   alf     ALF_PROGRESS 42%                                  Tractor, Alfred: each percent once
//   openjd  openjd_progress: 42, openjd_status: ...           the same for Open Job Description; a failure is openjd_fail: ...
//   none
// auto is the bar where standard error is a terminal, else plain for a sequence and none for a single frame; nothing with -q.
// Thread-safe; shares the log's lock, so that messages, frame lines and the bar never mix.
#ifndef SSDO_CLI_PROGRESS_H
#define SSDO_CLI_PROGRESS_H

#include <stddef.h>

#include "base/log.h"
#include "cli/options.h"

enum { PROGRESS_STEPS = 3 };

typedef struct progress {
    progress_form form; // resolved: never PROGRESS_AUTO
    log_t *log;
    int frames;
    int finished;      // frames
    int done, skipped; // steps; the skipped ones cost nothing and tell nothing about the time the others take
    int shown;         // last percent printed, -1 before the first
    double started;    // seconds of the monotonic clock
} progress;

// `frames` must be at least 1. Prints 0 % in the forms that machines read.
void progress_begin(progress *p, progress_form form, int frames, log_t *log);

// One step of a frame is done. NULL is allowed, here and below.
void progress_step(progress *p);
// A frame is finished, failed or skipped; `left` of its steps were not done.
void progress_finish(progress *p, int left);
// One line about a frame, on standard output ("openjd_status: " before it in that form); nothing when the log is quiet, except in
// the form that was made for machines.
void progress_line(progress *p, const char *format, ...) __attribute__((format(printf, 2, 3)));
// Takes the bar away.
void progress_end(progress *p);

// The last word about a run that failed, for the supervisor; nothing in the other forms.
void progress_fail(progress_form form, const char *text);

// Seconds that `left` steps will take when `worked` steps took `elapsed`; < 0 when nothing is known yet.
double progress_eta(double elapsed, int worked, int left);
// The bar without its line end: as many columns as fit into `size`.
void progress_bar_text(const progress *p, double elapsed, char *text, size_t size);

#endif
