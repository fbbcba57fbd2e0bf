// What one frame did and made. Every step of a frame reads it and adds to it.
#ifndef SSDO_PIPELINE_RESULT_H
#define SSDO_PIPELINE_RESULT_H

#include "base/clock.h"
#include "gbuffer/gbuffer.h"
#include "gbuffer/half_size.h"
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
    gbuffer half_size;              // the frame at half its size, until the passes have run
    gbuffer lit;                    // the frame at a small size, `beauty` its own light before albedo: for outside_fit.h
    bool lit_direct;                // that light is direct light only
    double unexplained;             // of it, by the outside that was fitted to it; 0: none was
    pixel_list lone;                // pixels of the frame that `half_size` does not show, as long as that
    bool second_part;               // our layers went into a part of their own
    const char *view;               // the stereo view this is, the file's string; NULL without views
    struct frame_result *next_view; // owned; shares the file
} frame_result;

// Adds to a stage's times what has passed since.
void result_lap(frame_result *r, stage s, stopwatch *since);

#endif
