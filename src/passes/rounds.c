// Sampling until the error is small enough, tile by tile.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "passes/arc.h"

int arc_round_slices(int round) { return ROUND_SLICES << round; }

// A few steps find whether there is anything at all. Where sampling goes on, what 16 steps miss would outlast the noise (rms of
// their bias on the samples .006 to .014, of 32 steps .003).
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
    gpu_tiles whole; // the context's own, put back at the end
    gpu_image sums, moments, result, square;
    gpu_buffer totals;
    float (*read)[2];              // of each tile: sum of the squared errors, surfaces
    unsigned char *active, *grown; // tiles
} work;

// Passes go to the tiles of `mask`.
static void go_to(work *w, unsigned char *mask)
{
    gpu_tiles *t = &w->c->tiles;
    t->occupied = mask;
    t->occupied_count = 0;
    for (int i = 0; i < t->columns * t->rows; i++) t->occupied_count += mask[i];
}

static bool march(work *w, const char *defines, int round, error *e)
{
    pass_context *c = w->c;
    int before = round == 0 ? 0 : arc_round_slices(round - 1);
    arc_params params = arc_params_of_grid(c, arc_round_slices(round) - before, arc_round_steps(round));
    params.before = before;
    char with[96], buf[160];
    snprintf(with, sizeof with, "%sCHANGE 1\nROUND 1\n", defines);
    const pass_binding bindings[] = {{2, &c->occlusion, GL_WRITE_ONLY},
                                     {4, &c->change, GL_WRITE_ONLY},
                                     {5, &w->sums, GL_READ_WRITE},
                                     {6, &c->surface, GL_READ_ONLY},
                                     {7, &c->plane_image, GL_READ_ONLY}};
    return pass_run(c, "arc", arc_with_planes(c, with, buf, sizeof buf), &params, sizeof params, bindings, 5, false, e);
}

// Tiles beside active ones, too: the second direction reads what the first left there.
static void grow(work *w)
{
    const gpu_tiles *t = &w->c->tiles;
    for (int i = 0; i < t->columns * t->rows; i++) {
        bool above = i >= t->columns && w->active[i - t->columns],
             below = i < t->columns * (t->rows - 1) && w->active[i + t->columns];
        w->grown[i] = w->c->rounds.tiles.occupied[i] && (w->active[i] || above || below);
    }
}

static bool denoise(work *w, error *e)
{
    pass_context *c = w->c;
    const pass_denoising d = {&w->moments, &w->result, &w->square};
    grow(w);
    go_to(w, w->grown);
    if (!pass_denoise_across(c, &d, e)) return false;
    go_to(w, w->active);
    return pass_denoise_down(c, &d, e);
}

// Squared errors of the tiles.
static bool measure(work *w, error *e)
{
    pass_context *c = w->c;
    const struct {
        int size, columns;
    } params = {c->tiles.size, c->tiles.columns};
    GLuint program = pass_program(c, "tile_error.comp", NULL, e);
    if (!program) return false;
    glUseProgram(program);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, c->frame_uniforms);
    gpu_uniforms_set(c->params_uniforms, 1, &params, sizeof params);
    gpu_bind_image(0, &c->depth, GL_READ_ONLY);
    gpu_bind_image(2, &w->square, GL_READ_ONLY);
    gpu_bind_buffer(0, &w->totals);
    gpu_dispatch(c->g, (GLuint)c->tiles.columns, (GLuint)c->tiles.rows, 1);
    gpu_buffer_read(c->g, &w->totals, w->read, w->totals.size);
    return true;
}

// Takes the tiles out that have come below the error, and says whether any is left.
static bool settle(work *w, int round)
{
    pass_rounds *r = &w->c->rounds;
    bool left = false;
    r->above = 0;
    for (int i = 0; i < r->tiles.columns * r->tiles.rows; i++) {
        if (!w->active[i]) continue;
        r->last[i] = (unsigned char)round;
        float *t = w->read[i];
        w->active[i] = t[1] > 0.0f && sqrt((double)t[0] / (double)t[1]) >= w->c->set.error;
        left |= w->active[i];
        r->above += w->active[i];
    }
    return left;
}

static bool make_room(work *w, error *e)
{
    pass_context *c = w->c;
    pass_rounds *r = &c->rounds;
    if (!gpu_tiles_make(&r->tiles, c->width, c->height, GPU_TILE, c->gb->depth, c->gb->coverage, e)) return false;
    size_t count = (size_t)r->tiles.columns * (size_t)r->tiles.rows;
    r->last = mem_zero(count, 1, e);
    w->active = mem_zero(count, 1, e);
    w->grown = mem_zero(count, 1, e);
    w->read = mem_zero(count, sizeof *w->read, e);
    if (!r->last || !w->active || !w->grown || !w->read) return false;
    memcpy(w->active, r->tiles.occupied, count);
    c->tiles = r->tiles;
    c->tiles.stop = w->whole.stop;
    return pass_make(c, &c->occlusion, GL_R32F, 1.0f, e) && pass_make(c, &c->change, GL_R32F, 0.0f, e) &&
           pass_make(c, &w->sums, GL_RG32F, 0.0f, e) && pass_make(c, &w->moments, GL_RGBA32F, 0.0f, e) &&
           pass_make(c, &w->result, GL_R32F, 1.0f, e) && pass_make(c, &w->square, GL_R32F, 0.0f, e) &&
           gpu_buffer_make(c->g, &w->totals, NULL, count * sizeof *w->read, "the tiles' errors", e);
}

// The denoised picture of all tiles, and the standard error of each pixel: a mean over its neighbours, for one change is one
// draw.
static bool conclude(work *w, error *e)
{
    pass_context *c = w->c;
    gpu_image t = c->occlusion; // every tile's result is of its last round
    go_to(w, c->rounds.tiles.occupied);
    c->occlusion = w->result, w->result = t;
    c->denoised = true;
    if (!c->want_error) return true;
    int radius = c->set.blur;
    c->set.blur = radius > ERROR_RADIUS ? radius : ERROR_RADIUS;
    const pass_binding bindings[] = {{2, &w->square, GL_READ_ONLY}};
    const gpu_image *targets[] = {&c->error};
    bool ok = pass_blur(c, &w->square, NULL, NULL, e) && pass_make(c, &c->error, GL_R32F, 0.0f, e) &&
              pass_draw(c, "root", NULL, NULL, 0, bindings, 1, targets, 1, false, e);
    c->set.blur = radius;
    return ok;
}

static void count_samples(pass_rounds *r)
{
    double sum = 0.0;
    r->most_samples = r->count > 0 ? samples_after(r->count - 1) : 0;
    for (int i = 0; i < r->tiles.columns * r->tiles.rows; i++)
        if (r->tiles.occupied[i]) sum += samples_after(r->last[i]);
    r->mean_samples = r->tiles.occupied_count ? sum / r->tiles.occupied_count : 0.0;
}

bool arc_run_rounds(pass_context *c, const char *defines, error *e)
{
    work w = {.c = c, .whole = c->tiles};
    int timings = c->timing_count, round = 0;
    pass_timing clock = pass_clock("arc");
    bool ok = make_room(&w, e), left = c->tiles.occupied_count > 0;
    for (; ok && left; round++) {
        go_to(&w, w.active);
        ok = march(&w, defines, round, e) && denoise(&w, e) && measure(&w, e);
        left = ok && settle(&w, round) && round + 1 < ROUNDS_MAX && samples_after(round + 1) <= c->set.most_samples &&
               !(c->tiles.stop && *c->tiles.stop);
    }
    ok = ok && conclude(&w, e);
    c->rounds.count = round;
    if (ok) count_samples(&c->rounds);
    c->tiles = w.whole;
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

bool arc_run_at_rounds(pass_context *c, const char *name, const char *defines, const arc_params *params,
                       const pass_binding *bindings, int binding_count, error *e)
{
    const pass_rounds *r = &c->rounds;
    if (r->count == 0) return pass_run(c, name, defines, params, sizeof *params, bindings, binding_count, false, e);
    size_t count = (size_t)r->tiles.columns * (size_t)r->tiles.rows;
    work w = {.c = c, .whole = c->tiles, .active = mem_zero(count, 1, e)};
    int timings = c->timing_count;
    pass_timing clock = pass_clock(name);
    bool ok = w.active != NULL;
    c->tiles = r->tiles;
    c->tiles.stop = w.whole.stop;
    for (int round = 0; ok && round < r->count; round++) {
        arc_params p = *params;
        arc_set_grid(&p, arc_round_slices(round), arc_round_steps(round));
        for (size_t i = 0; i < count; i++) w.active[i] = r->tiles.occupied[i] && r->last[i] == round;
        go_to(&w, w.active);
        ok = pass_run(c, name, defines, &p, sizeof p, bindings, binding_count, false, e);
    }
    c->tiles = w.whole;
    c->timing_count = timings;
    pass_clock_stop(c, clock);
    free(w.active);
    return ok;
}
