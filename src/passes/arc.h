// What the passes of the `arc` family share.
#ifndef SSDO_PASSES_ARC_H
#define SSDO_PASSES_ARC_H

#include "passes/params.h"
#include "passes/pass.h"
#include "passes/variants.h"

// Slices and steps a side for a number of samples = slices x 2 x steps.
void arc_grid(int samples, int *slices, int *steps);
// Whether the occlusion comes with its half-difference, by which pass_denoise knows its noise.
bool arc_has_half_difference(const pass_settings *set);
arc_params arc_params_of(const pass_context *c);
// For marches without a radius: light comes from any distance.
arc_params arc_unlimited_params_of(const pass_context *c);

// What all marches read, once a frame: the planes and their image, the packed surfaces, further G-buffers.
bool arc_make_inputs(pass_context *c, error *e);
// What marches for light read beside it: the rims of openings, the surround.
bool arc_make_outside(pass_context *c, error *e);

// The words `what` and, if the frame has planes that may stand in, PLANES.
variant arc_variant(const pass_context *c, const char *what);

// The same for an occlusion that `blocked` names, and FURTHER if further G-buffers serve it.
variant arc_occlusion_variant(const pass_context *c, const char *blocked);

// What the march of an occlusion makes beside it, each wanted or not; `blocked` says what blocks its sectors.
#define ARC_OCCLUSION(blocked) blocked " [BENT] [HALF_DIFFERENCE] | " blocked " HALF_DIFFERENCE ROUND"
// Makes the occlusion, and bent if it is wanted, by a march that `blocked` names, in rounds if an error is asked for.
bool arc_run_occlusion(pass_context *c, const char *blocked, error *e);

// The parameters for another grid than that of c->set.samples.
void arc_set_grid(arc_params *p, int slices, int steps);
arc_params arc_params_of_grid(const pass_context *c, int slices, int steps);

typedef struct arc_light {
    bool sky, bounce, visibility; // visibility goes with sky only
    const pixel_list *lone;       // borrowed; NULL: of all pixels, else of these alone
} arc_light;

// Makes light, the bounce or both at once. Both need the light that surfaces send: without `exitant` settings, the first light.
bool arc_run_light(pass_context *c, const arc_light *what, error *e);
// Fills IMAGE_FIRST_LIGHT of the frame that the marches of `c` see, if it is not there.
bool arc_first_light(pass_context *c, error *e);

// ---- rounds: --error

// After round k a tile has had ROUND_SLICES << k slices.
enum { ROUND_SLICES = 2, ROUND_STEPS = 16, ROUNDS_MAX = 12 };
int arc_round_slices(int round); // in all, after it
int arc_round_steps(int round);  // a side, of what it adds

// Occlusion, in rounds that double the slices of a tile until its estimated standard error (denoise.comp, root mean square over
// the tile's surfaces) is below c->set.target_error or a further round would take more than c->set.most_samples. `what` names
// what blocks. Fills the occlusion, denoised, c->adaptive and, if wanted, the error.
bool arc_run_adaptive(pass_context *c, const char *what, error *e);
// pass_run of a call of an arc shader with these parameters (the call's own are ignored), after rounds with as many slices as
// each tile came to.
bool arc_run_as_adaptive(pass_context *c, const pass_call *call, const arc_params *params, error *e);

// Whether directions that leave the frame may be closed (shaders/include/outside.glsl).
bool arc_closes_outside(const pass_context *c);
bool arc_has_surround(const pass_context *c);

#endif
