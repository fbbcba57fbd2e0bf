// --report of a sequence: one JSON file about all its frames (schema in the man page).
#ifndef SSDO_PIPELINE_SHOT_H
#define SSDO_PIPELINE_SHOT_H

#include "cli/frames.h"
#include "pipeline/frame.h"
#include "pipeline/stopwatch.h"

// Who works on a sequence, each on a frame of its own.
typedef enum shot_thread { SHOT_READER, SHOT_GPU, SHOT_WRITER, SHOT_THREADS } shot_thread;

typedef struct shot_report {
    struct json_object *frames; // owned; NULL: nobody asked for a report
    int done, skipped, failed;
    size_t clamped;
    double wall_ms[STAGE_COUNT], cpu_ms[STAGE_COUNT]; // sums over the frames that were done
    stopwatch since;
    double busy_ms[SHOT_THREADS]; // wall time that each was at work, written by it alone
} shot_report;

// One frame's outcome. why: the reason it was skipped, or NULL; failure: NULL or what went wrong; r: of a frame that was done.
typedef struct shot_frame {
    int frame;
    const char *input, *output, *why;
    const error *failure;
    const frame_result *r;
    double seconds; // from its first byte read to its last written
} shot_frame;

void shot_begin(shot_report *s);
void shot_add(shot_report *s, const shot_frame *f);
// failures: the frames that failed. Spends the report.
bool shot_write(shot_report *s, const job *j, const frame_list *failures, const char *path, error *e);
void shot_free(shot_report *s);

#endif
