#include "pipeline/filter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "gbuffer/half.h"
#include "pipeline/read_back.h"
#include "pipeline/stopwatch.h"

// Whether the method's own loop makes the bounce.
static bool bounces_itself(const pass_settings *set, const plan *p)
{
    if (!p->bounce || p->estimator != p->method->bounce) return false;
    return p->estimator->march == BOUNCE_WITH_METHOD || (p->estimator->march == BOUNCE_WITH_PICTURE && !set->relight);
}

// What the method itself makes, filtered: linear quantities all.
static bool run_method(pass_context *c, const plan *p, error *e)
{
    if (!p->method->run(c, e)) return false;
    if (!p->blur) return true;
    if (c->half_difference.id && !c->denoised && !pass_denoise(c, e)) return false;
    gpu_image *plain = c->denoised ? NULL : &c->occlusion;
    if ((plain || c->visibility.id || c->radiance.id) && !pass_blur(c, c->set.blur, plain, &c->visibility, &c->radiance, e))
        return false;
    return !c->bent.id || pass_blur(c, c->set.blur, NULL, NULL, &c->bent, e);
}

static bool finish_light(pass_context *c, const plan *p, error *e)
{
    if (!pass_proxies(c, e)) return false;
    if (p->tone && !pass_tone(c, &c->occlusion, e)) return false;
    if (p->tone && c->visibility.id && !pass_tone(c, &c->visibility, e)) return false;
    return !p->irradiance || pass_irradiance(c, e);
}

static bool run_bounce(pass_context *c, const plan *p, error *e)
{
    if (!p->bounce) return true;
    if (!p->estimator->run(c, e)) return false;
    // A method that filters itself does not filter the bounce.
    return c->set.blur == 0 || p->estimator->exact || pass_blur(c, c->set.blur, NULL, NULL, &c->indirect, e);
}

// The times of the small frame's passes belong to the frame.
static void take_times(pass_context *c, const pass_context *small)
{
    for (int i = 0; i < small->timing_count && c->timing_count < PASS_MAX_TIMINGS; i++)
        c->timings[c->timing_count++] = small->timings[i];
    c->planes = small->planes;
}

static bool halve(const job *j, frame_result *r, error *e)
{
    gbuffer whole = r->gb; // borrows its arrays
    if (r->uncovered) whole.coverage = NULL;
    // What the bounce gathers; nothing else at half size looks at colours.
    if (!r->plan.bounce) whole.albedo = NULL;
    if (!r->plan.bounce || r->set.relight) whole.beauty = NULL;
    return gbuffer_halve(&whole, j->threads, &r->half, e);
}

static bool run_half(pass_context *c, const gbuffer *half, const plan *p, error *e)
{
    pass_settings set = c->set;
    set.blur = (set.blur + 1) / 2; // as wide on the surface as at full size
    pass_context small = pass_like(c, half, &set);
    if (!pass_begin(&small, e)) return false;
    bool ok = run_method(&small, p, e);
    // All layers go up together, unless the bounce needs what is done to them at either size.
    bool early =
        p->bounce && c->set.relight && (p->tone || p->irradiance || (c->proxies && c->proxies->count > 0) || small.suns_apart);
    ok = ok && (!early || pass_upsample(c, &small, ~0u, e));
    if (ok && p->bounce) ok = (!early || (pass_suns(&small, e) && finish_light(&small, p, e))) && run_bounce(&small, p, e);
    ok = ok && (early ? pass_upsample(c, &small, IMAGE_BIT(IMAGE_INDIRECT), e) : pass_upsample(c, &small, ~0u, e));
    take_times(c, &small);
    pass_end(&small);
    return ok && pass_suns(c, e) && finish_light(c, p, e);
}

static bool run_passes(pass_context *c, const gbuffer *half, const plan *p, error *e)
{
    if (c->set.half ? !run_half(c, half, p, e)
                    : !(run_method(c, p, e) && pass_suns(c, e) && finish_light(c, p, e) && run_bounce(c, p, e)))
        return false;
    // A beauty's light on unseen spheres is unknown: they send none.
    if (p->bounce && c->set.relight && !pass_proxies_bounce(c, e)) return false;
    if (p->edges && c->coverage.id && !pass_edges(c, e)) return false;
    if (p->specular && !pass_specular(c, e)) return false;
    if (p->depthmask && !pass_depthmask(c, e)) return false;
    return !p->composite || pass_composite(c, e);
}

static void take_adaptive(const job *j, frame_result *r, const adaptive_sampling *rounds)
{
    r->rounds = rounds->count, r->tiles_above = rounds->above, r->mean_samples = rounds->mean_samples;
    if (r->rounds == 0) return;
    log_info(j->log, "--error %g: %.0f samples a pixel in the mean, %d rounds", r->set.error, r->mean_samples, r->rounds);
    if (r->tiles_above > 0)
        log_warn(j->log, "error",
                 "%d of %d tiles of a frame have an estimated standard error above %g after %d samples; --samples allows more; "
                 "the report says so of each frame",
                 r->tiles_above, rounds->tiles.occupied_count, r->set.error, rounds->most_samples);
}

// Without coverage the passes take a pixel for covered where it has a surface.
static bool needs_coverage(const gbuffer *gb)
{
    size_t pixels = (size_t)gb->width * (size_t)gb->height;
    for (size_t i = 0; gb->coverage && i < pixels; i++)
        if (gb->coverage[i] != (gb->depth[i] > 0.0f ? 1.0f : 0.0f)) return true;
    return false;
}

bool filter_prepare(const job *j, frame_result *r, error *e)
{
    if (!r->prepared) r->uncovered = !needs_coverage(&r->gb);
    r->prepared = true;
    return !r->set.half || r->half.depth || halve(j, r, e);
}

static void take_counts(frame_result *r, const pass_context *c)
{
    memcpy(r->timings, c->timings, sizeof r->timings);
    r->timing_count = c->timing_count;
    memcpy(r->uploads, c->uploads, sizeof r->uploads);
    r->upload_count = c->upload_count;
    r->planes = c->planes;
    r->tile_size = c->tiles.size, r->tiles = c->tiles.columns * c->tiles.rows, r->tiles_occupied = c->tiles.occupied_count;
}

bool filter_begin(job *j, frame_result *r, error *e)
{
    if (!filter_prepare(j, r, e)) return false;
    stopwatch t = stopwatch_start();
    const gpu_counts before = j->g.counts;
    const double wall = r->wall_ms[STAGE_CONVERT], cpu = r->cpu_ms[STAGE_CONVERT];
    const plan *p = &r->plan;
    gbuffer gb = r->gb; // borrows its arrays
    if (r->uncovered) gb.coverage = NULL;
    pass_context c = {
        .g = &j->g,
        .log = j->log,
        .timing = j->o->report && !j->no_pass_times,
        .threads = j->threads,
        .stop = j->stop,
        .set = r->set,
        .want_diffuse = p->layers & 1u << LAYER_DIFFUSE,
        .want_bent = p->want_bent,
        .want_error = p->want_error,
        .want_indirect = bounces_itself(&r->set, p),
        .want_radiance = p->want_radiance,
        .want_visibility = p->want_visibility && method_makes(p->method, MAKES_LIGHT),
        .gb = &gb,
        .env = j->env_loaded ? &j->env : NULL,
        .environment = j->env_image,
        .proxies = &r->proxies,
        .sunless = &j->sunless,
        .trace = &j->trace,
    };
    for (int k = 0; k < SH_IMAGES; k++) c.relight_sh[k] = r->relight_sh[k];
    if (!pass_begin(&c, e)) return false;
    bool ok = run_passes(&c, &r->half, p, e) && gpu_finish(&j->g, "the passes", e);
    stopwatch_add(&t, &r->wall_ms[STAGE_PASSES], &r->cpu_ms[STAGE_PASSES]);
    ok = ok && !job_stopped(j) && read_back_begin(j, &c, r, e);
    stopwatch_add(&t, &r->wall_ms[STAGE_READ_BACK], &r->cpu_ms[STAGE_READ_BACK]);
    // What was converted meanwhile has its own time.
    r->wall_ms[STAGE_READ_BACK] -= r->wall_ms[STAGE_CONVERT] - wall;
    r->cpu_ms[STAGE_READ_BACK] -= r->cpu_ms[STAGE_CONVERT] - cpu;
    if (ok) take_adaptive(j, r, &c.adaptive);
    take_counts(r, &c);
    r->gl = gpu_counts_since(&j->g, &before);
    pass_end(&c);
    gbuffer_free(&r->half);
    return ok;
}

bool filter_frame(job *j, frame_result *r, error *e) { return filter_begin(j, r, e) && read_back_finish(j, r, e); }
