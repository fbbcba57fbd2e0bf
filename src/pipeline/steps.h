// The passes of one frame, in their order: one list, which is run, reported, explained and tested.
//
// It is made of the plan once the camera is known, the coverage has been looked at and the environment is there. Each step says
// which pictures it reads and writes; filter.c runs the list and refuses a step whose pictures are not there.
#ifndef SSDO_PIPELINE_STEPS_H
#define SSDO_PIPELINE_STEPS_H

#include "passes/pass.h"
#include "pipeline/plan.h"

typedef enum step_size {
    STEP_WHOLE,
    STEP_SMALL, // on the frame of half the size
    STEP_AMID,  // on the smaller frame, but its marches look at the whole one
    STEP_UP,    // from the smaller frame to the whole one
    STEP_DOWN,  // from the whole one to the smaller
} step_size;

typedef struct plan_step {
    const char *pass; // as reports name it
    bool runs;
    bool fitted;     // of a blur: as light of a smaller frame is filtered
    const char *why; // it runs, or not
    step_size size;
    image_set reads, writes; // of the smaller frame: what STEP_SMALL and STEP_UP read, what STEP_SMALL, _AMID, _DOWN write
    bool (*run)(pass_context *c, const struct plan_step *s, error *e);
    bool (*call)(pass_context *c, error *e); // what run_pass calls; NULL for others
} plan_step;

enum { STEPS_MOST = 40 };
typedef struct step_list {
    plan_step steps[STEPS_MOST];
    int count;
} step_list;

// What the steps depend on beside the plan.
typedef struct step_facts {
    const plan *plan;
    const pass_settings *set;
    image_set given; // by the G-buffer
    bool proxies;    // there are spheres
    bool suns;       // the environment has suns, which have been taken out of it
    bool mixed;      // in some pixels a neighbour's surface covers a part
    bool lone;       // some pixels have a surface that the frame of half the size does not show
} step_facts;

// The steps that run, in order, and after them the passes that do not.
void steps_make(const step_facts *f, step_list *out);

// The pictures that a G-buffer brings, and those of them that the passes at half the size look at.
image_set steps_given(const gbuffer *gb);
image_set steps_given_small(const plan *p, const pass_settings *set, image_set given);

// Whether some run on the frame of half the size.
bool steps_use_small(const plan *p, const pass_settings *set);
// Whether the method's light leaves the environment's suns to pass_suns.
bool steps_split_suns(const plan *p);
// Whether the method's own march makes the bounce too.
bool steps_bounce_within(const step_facts *f);

#endif
