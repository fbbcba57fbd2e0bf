// A run: what lives for all its frames.
#ifndef SSDO_PIPELINE_JOB_H
#define SSDO_PIPELINE_JOB_H

#include "base/log.h"
#include "cli/options.h"
#include "cli/progress.h"
#include "gpu/gpu.h"
#include "light/environment.h"
#include "passes/pass.h"
#include "passes/trace.h"
#include "pipeline/files.h"

// What frames have in common. 0 and -1: each frame has its own.
typedef struct shot_facts {
    double radius; // of the occlusion, scene units
    openness outside;
    double roof; // the share of the picture that is a roof; -1: not known
} shot_facts;

// An environment, prepared with the first frame that needs it: its default up axis is that of the frame's renderer.
typedef struct job_light {
    bool loaded;
    environment env;
    gpu_image image;
    pass_sunless sunless;
    pass_surround surround;
} job_light;

// What lives for all frames of a run: options, context, environment.
typedef struct job {
    const options *o;
    log_t *log;
    const run_files *files; // borrowed: all that is read and written. NULL where only a frame is asked for
    int threads;
    gpu g;                         // opened when first needed
    job_light light;               // --env
    job_light beauty_light;        // --beauty-env
    trace_scene trace;             // --mesh
    world_view views[MAX_FURTHER]; // --also, --surround shot
    int view_count;
    bool views_loaded;
    gpu_image further;        // their pictures, as passes/further.h makes them
    const volatile int *stop; // borrowed, may be NULL: once it is not zero, frames are dropped unless they are being written
    progress *progress;       // borrowed, may be NULL
    bool no_floats;           // nobody looks at a frame's `layers`: they are not kept
    bool no_pass_times;       // nobody looks at the passes' own times, for which each would have to be waited for
    bool is_shot;             // the frames are one shot, so that these are known:
    shot_facts shot;
} job;

// Begins a job. stop, files, progress and no_floats are the caller's to set afterwards. Before any thread of ours starts.
void job_open(job *j, const options *o, log_t *log);
// Opens the device, if it is not open yet; the calling thread is its thread from then on. Filtering does this by itself; who
// needs the device earlier calls it.
bool job_open_device(job *j, error *e);
// True if the run was asked to stop.
bool job_stopped(const job *j);
// On the device's thread.
void job_close(job *j);
// Environment and mesh, so that the next frame begins as the first one did. On the device's thread.
void job_forget_light(job *j);

#endif
