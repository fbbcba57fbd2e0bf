// Sampling until the error is small enough, tile by tile.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "passes/arc.h"

int arc_round_slices(int round) { return ROUND_SLICES << round; }

// The first round takes few steps: enough to find out whether a tile has any noise. Later rounds take more, because what few
// steps miss would be larger than the noise that is left (tests/bench/RESULTS.md, Sampling).
int arc_round_steps(int round) { return round == 0 ? ROUND_STEPS : 2 * ROUND_STEPS; }

static int samples_after(int round)
{
    int samples = ROUNDS_LEAST_SAMPLES; // 2 slices of 2 x ROUND_STEPS
    for (int i = 1; i <= round; i++) samples += arc_round_slices(i - 1) * 2 * arc_round_steps(i);
    return samples;
}

enum { ERROR_RADIUS = 4 }; // of the mean of the errors, pixels

// What the rounds hold while they run.
typedef struct work {
    pass_context *c;
    gpu_tiles tiles; // the rounds' own, with those of the next pass as the occupied ones
    gpu_image sums, moments, result, square;
    gpu_buffer totals;
    float (*read)[2];              // of each tile: sum of the squared errors, surfaces
    unsigned char *active, *grown; // tiles
} work;

// The next pass goes to the tiles of `mask`.
static const gpu_tiles *go_to(work *w, unsigned char *mask)
{
    gpu_tiles *t = &w->tiles;
    t->occupied = mask;
    t->occupied_count = 0;
    for (int i = 0; i < t->columns * t->rows; i++) t->occupied_count += mask[i];
    return t;
}

static bool march(work *w, const char *what, int round, error *e)
{
    pass_context *c = w->c;
    int before = round == 0 ? 0 : arc_round_slices(round - 1);
    arc_params params = arc_params_of_grid(c, arc_round_slices(round) - before, arc_round_steps(round));
    params.before = before;
    variant v = arc_occlusion_variant(c, what);
    variant_add(&v, true, "HALF_DIFFERENCE");
    variant_add(&v, true, "ROUND");
    const pass_call call = {
        .program = "arc_occlusion",
        .variant = v.words,
        .untimed = true,
        .tiles = go_to(w, w->active),
        PASS_PARAMS(params),
        .reads = {{"surface_image", &c->image[IMAGE_SURFACE]},
                  {"planes_image", &c->image[IMAGE_PLANES]},
                  {"further_image", c->further}},
        .writes = {{"occlusion_image", &c->image[IMAGE_OCCLUSION]},
                   {"half_difference_image", &c->image[IMAGE_HALF_DIFFERENCE]},
                   {"sums_image", &w->sums}},
    };
    return pass_run(c, &call, e);
}

// Also marks the tiles beside active ones: the second direction reads what the first direction stores there.
static void grow(work *w)
{
    const gpu_tiles *t = &w->tiles;
    for (int i = 0; i < t->columns * t->rows; i++) {
        bool above = i >= t->columns && w->active[i - t->columns],
             below = i < t->columns * (t->rows - 1) && w->active[i + t->columns];
        w->grown[i] = w->c->adaptive.tiles.occupied[i] && (w->active[i] || above || below);
    }
}

static bool denoise(work *w, error *e)
{
    pass_denoising d = {.moments = &w->moments, .result = &w->result, .square = &w->square};
    grow(w);
    d.tiles = go_to(w, w->grown);
    if (!pass_denoise_across(w->c, &d, e)) return false;
    d.tiles = go_to(w, w->active);
    return pass_denoise_down(w->c, &d, e);
}

// Squared errors of the tiles.
static bool measure(work *w, error *e)
{
    const gpu_tiles *t = &w->tiles;
    const tile_error_params params = {.size = t->size, .columns = t->columns};
    const pass_call call = {
        .program = "tile_error",
        .untimed = true,
        .groups = {t->columns, t->rows},
        PASS_PARAMS(params),
        .reads = {{"error_image", &w->square}},
        .buffers = {{"Tiles", &w->totals}},
    };
    if (!pass_run(w->c, &call, e)) return false;
    gpu_buffer_read(w->c->g, &w->totals, w->read, w->totals.size);
    return true;
}

// Removes the tiles whose error is low enough. Returns whether any tile is left.
static bool settle(work *w, int round)
{
    adaptive_sampling *r = &w->c->adaptive;
    bool left = false;
    r->above = 0;
    for (int i = 0; i < r->tiles.columns * r->tiles.rows; i++) {
        if (!w->active[i]) continue;
        r->last[i] = (unsigned char)round;
        float *t = w->read[i];
        w->active[i] = t[1] > 0.0f && sqrt((double)t[0] / (double)t[1]) >= w->c->set.target_error;
        left |= w->active[i];
        r->above += w->active[i];
    }
    return left;
}

static bool make_images(work *w, error *e)
{
    pass_context *c = w->c;
    adaptive_sampling *r = &c->adaptive;
    if (!gpu_tiles_make(&r->tiles, c->width, c->height, GPU_TILE, c->gb->depth, c->gb->coverage, e)) return false;
    size_t count = (size_t)r->tiles.columns * (size_t)r->tiles.rows;
    r->last = mem_zero(count, 1, e);
    w->active = mem_zero(count, 1, e);
    w->grown = mem_zero(count, 1, e);
    w->read = mem_zero(count, sizeof *w->read, e);
    if (!r->last || !w->active || !w->grown || !w->read) return false;
    memcpy(w->active, r->tiles.occupied, count);
    w->tiles = r->tiles;
    return pass_make_image(c, IMAGE_OCCLUSION, e) && pass_make_image(c, IMAGE_HALF_DIFFERENCE, e) &&
           pass_make(c, &w->sums, GL_RG32F, 0.0f, e) && pass_make(c, &w->moments, GL_RGBA32F, 0.0f, e) &&
           pass_make(c, &w->result, GL_R32F, 1.0f, e) && pass_make(c, &w->square, GL_R32F, 0.0f, e) &&
           gpu_buffer_make(c->g, &w->totals, NULL, count * sizeof *w->read, "the tiles' errors", e);
}

// Stores the denoised picture of all tiles, and the standard error of each pixel. That is a mean over its neighbours, because the
// change of a single pixel is a single random draw.
static bool conclude(work *w, error *e)
{
    pass_context *c = w->c;
    gpu_image t = c->image[IMAGE_OCCLUSION]; // every tile's result is of its last round
    c->image[IMAGE_OCCLUSION] = w->result, w->result = t;
    if (!c->want_error) return true;
    const pass_call call = {
        .program = "root",
        .untimed = true,
        .reads = {{"square_image", &w->square}},
        .writes = {{"root_out", &c->image[IMAGE_ERROR]}},
    };
    int radius = c->set.blur > ERROR_RADIUS ? c->set.blur : ERROR_RADIUS;
    return pass_blur(c, &(pass_blurring){.radius = radius, .scalars = {&w->square}}, e) && pass_make_image(c, IMAGE_ERROR, e) &&
           pass_run(c, &call, e);
}

static void count_samples(adaptive_sampling *r)
{
    double sum = 0.0;
    r->most_samples = r->count > 0 ? samples_after(r->count - 1) : 0;
    for (int i = 0; i < r->tiles.columns * r->tiles.rows; i++)
        if (r->tiles.occupied[i]) sum += samples_after(r->last[i]);
    r->mean_samples = r->tiles.occupied_count ? sum / r->tiles.occupied_count : 0.0;
}

static bool stopped(const pass_context *c) { return c->stop && *c->stop; }

bool arc_run_adaptive(pass_context *c, const char *what, error *e)
{
    work w = {.c = c};
    int timings = c->timing_count, round = 0;
    pass_timing clock = pass_clock(c, "arc");
    bool ok = make_images(&w, e), left = w.tiles.occupied_count > 0;
    for (; ok && left; round++) {
        ok = march(&w, what, round, e) && denoise(&w, e) && measure(&w, e);
        left =
            ok && settle(&w, round) && round + 1 < ROUNDS_MAX && samples_after(round + 1) <= c->set.most_samples && !stopped(c);
    }
    ok = ok && conclude(&w, e);
    c->adaptive.count = round;
    if (ok) count_samples(&c->adaptive);
    c->timing_count = timings;
    pass_clock_stop(c, clock);
    gpu_image *images[] = {&w.sums, &w.moments, &w.result, &w.square};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++) gpu_image_free(images[i]);
    gpu_buffer_free(&w.totals);
    free(w.active);
    free(w.grown);
    free(w.read);
    return ok;
}

bool arc_run_as_adaptive(pass_context *c, const pass_call *call, const arc_params *params, error *e)
{
    const adaptive_sampling *r = &c->adaptive;
    arc_params p = *params;
    pass_call part = *call;
    part.params = &p, part.params_size = sizeof p;
    if (r->count == 0) return pass_run(c, &part, e);
    size_t count = (size_t)r->tiles.columns * (size_t)r->tiles.rows;
    work w = {.c = c, .tiles = r->tiles, .active = mem_zero(count, 1, e)};
    pass_timing clock = pass_clock(c, call->label);
    bool ok = w.active != NULL;
    part.untimed = true;
    for (int round = 0; ok && round < r->count; round++) {
        arc_set_grid(&p, arc_round_slices(round), arc_round_steps(round));
        for (size_t i = 0; i < count; i++) w.active[i] = r->tiles.occupied[i] && r->last[i] == round;
        part.tiles = go_to(&w, w.active);
        ok = pass_run(c, &part, e);
    }
    pass_clock_stop(c, clock);
    free(w.active);
    return ok;
}
