// --report of a sequence: one JSON file about all its frames (schema in the man page).
#ifndef SSDO_PIPELINE_SEQUENCE_REPORT_H
#define SSDO_PIPELINE_SEQUENCE_REPORT_H

#include "base/clock.h"
#include "cli/frames.h"
#include "pipeline/result.h"

// Who works on a sequence, each on a frame of its own.
typedef enum sequence_thread { SEQUENCE_READER, SEQUENCE_GPU, SEQUENCE_WRITER, SEQUENCE_THREADS } sequence_thread;

typedef struct sequence_report {
    struct json_object *frames; // owned; NULL: nobody asked for a report
    int done, skipped, failed;
    size_t clamped;
    double wall_ms[STAGE_COUNT], cpu_ms[STAGE_COUNT]; // sums over the frames that were done
    stopwatch since;
    double busy_ms[SEQUENCE_THREADS]; // wall time that each was at work, written by it alone
} sequence_report;

// One frame's outcome. why: the reason it was skipped, or NULL; failure: NULL or what went wrong; r: of a frame that was done.
typedef struct sequence_frame {
    int frame;
    const char *input, *output, *why;
    const error *failure;
    const frame_result *r;
    double seconds; // from its first byte read to its last written
} sequence_frame;

void sequence_report_begin(sequence_report *s);
void sequence_report_add(sequence_report *s, const sequence_frame *f);
// failures: the frames that failed. Spends the report.
bool sequence_report_write(sequence_report *s, const job *j, const frame_list *failures, const char *path, error *e);
void sequence_report_free(sequence_report *s);

#endif
