// One frame: read, resolve, plan, filter, write.
#ifndef SSDO_PIPELINE_FRAME_H
#define SSDO_PIPELINE_FRAME_H

#include "gbuffer/gbuffer.h"
#include "gbuffer/half.h"
#include "passes/pass.h"
#include "pipeline/job.h"
#include "pipeline/plan.h"
#include "pipeline/record.h"
#include "pipeline/steps.h"

typedef enum stage { STAGE_READ, STAGE_RESOLVE, STAGE_PASSES, STAGE_READ_BACK, STAGE_CONVERT, STAGE_WRITE, STAGE_COUNT } stage;

// What one frame did, for -v and --report. A stereo file has one for each view, in a list; each view has its own camera, and all
// have the first one's radius.
typedef struct frame_result {
    exrio_file *file; // the input, open
    resolution resolution;
    gbuffer gb;
    plan plan;
    pass_settings set;
    step_list steps;                                  // that filter_begin ran
    double wall_ms[STAGE_COUNT], cpu_ms[STAGE_COUNT]; // CPU of the whole process: with what runs beside the stage
    pass_timing timings[PASS_MAX_TIMINGS];
    int timing_count;
    pass_upload uploads[PASS_MAX_UPLOADS];
    int upload_count;
    int frame;           // of a sequence; for --proxies
    frame_record record; // the caller's to set between reading and writing
    proxy_set proxies;   // --proxies
    plane_set planes;    // that stood in for what the camera does not see; none where the method has no use for them
    int tile_size, tiles, tiles_occupied; // tiles without a surface are not dispatched (but for the composite of a background)
    int rounds, tiles_above;              // of --error; 0 rounds: the number of samples was given
    double mean_samples;                  // a pixel, of those rounds
    gpu_counts gl;                        // what the frame asked of GL
    size_t clamped;                       // samples of ours that a half could not hold
    // By channel, width * height of types[layer], as they are written, and the same as floats before rounding, interleaved. NULL
    // where a layer was not made, or its floats not kept.
    void *samples[LAYER_COUNT][LAYER_CHANNELS];
    sample_type types[LAYER_COUNT];
    float *layers[LAYER_COUNT];
    struct layer_band *bands; // of the layers, on their way from the device (read_back.h); owned
    int band_count;
    float *relight_sh[SH_IMAGES];   // --from-sh: what the input brought along, else NULL
    bool prepared;                  // by filter_prepare
    bool uncovered;                 // the coverage says nothing that the depth does not
    gbuffer half;                   // the frame at half its size, until the passes have run
    pixel_list lone;                // its pixels that `half` does not show, as long as that
    bool second_part;               // our layers went into a part of their own
    const char *view;               // the stereo view this is, the file's string; NULL without views
    struct frame_result *next_view; // owned; shares the file
} frame_result;

// The three stages of a frame, to be called in this order on one result; after a failure only frame_free. When the job is stopped
// before the passes have ended, filtering returns false without an error. Reading and writing may
// run on other threads than filtering, which belongs to the device's thread and opens the device if nobody has; of one job no
// stage runs twice at a time.
bool frame_read(const job *j, const char *input, frame_result *result, error *e); // starts by zeroing the result
// The same for a frame whose passes are in several files.
bool frame_read_files(const job *j, const char *const *inputs, int count, frame_result *result, error *e);
bool frame_filter(job *j, frame_result *result, error *e);

// Filtering in four steps, for who does other frames beside it. frame_prepare may follow reading on its thread, once
// result->frame is set; frame_begin and frame_wait belong to the device's thread, and between them another frame may begin;
// frame_convert may precede writing on its thread.
bool frame_prepare(const job *j, frame_result *result, error *e);
bool frame_begin(job *j, frame_result *result, error *e); // the passes; the layers are on their way
bool frame_wait(job *j, frame_result *result, error *e);  // they have arrived
bool frame_convert(const job *j, frame_result *result, error *e);
// Whether there is anything for frame_wait to wait for.
bool frame_is_under_way(const frame_result *result);

bool frame_write(const job *j, frame_result *result, const char *output, error *e);

// Reading and filtering, as the program and the library do it. Where the device is not open yet, it is opened while the file is
// being read. record: NULL for none.
bool frame_make(job *j, const char *const *inputs, int count, const frame_record *record, frame_result *result, error *e);
// The same, and writing.
bool frame_run(job *j, const char *input, const char *output, frame_result *result, error *e);
bool frame_run_files(job *j, const char *const *inputs, int count, const char *output, const frame_record *record,
                     frame_result *result, error *e);
void frame_free(frame_result *result);

// The depth in the middle of the surfaces, 1 where there are none: where a length in pixels and one in the scene are compared.
double frame_median_depth(const gbuffer *gb);

// Lengths are squared in single precision and compared with the smallest that is told from nothing: pictures are computed alike
// where a pixel is at least 1e-14 scene units wide at the median depth and a tenth of the surfaces is nearer than 1e10. ERR_INPUT
// for what is beyond.
bool frame_check_scale(const frame_result *r, error *e);

// What a sequence must have the same everywhere, measured on one frame of it.
bool frame_measure_shot(const job *j, const char *const *inputs, int count, shot_facts *shot, error *e);

#endif
