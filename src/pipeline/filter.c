#include "pipeline/filter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/mem.h"
#include "gbuffer/half.h"
#include "pipeline/read_back.h"

// The bounce that --bounce names, else the method's own.
static bool (*bounce_of(const plan *p))(pass_context *, error *)
{
    const char *name = p->bounce_name ? p->bounce_name : p->method->bounce;
    if (name && strcmp(name, "vpl") == 0) return pass_vpl;
    if (name && strcmp(name, "raytrace") == 0) return pass_raytrace_bounce;
    return name && strcmp(name, "arc") == 0 ? pass_arc_bounce : pass_ssdo_bounce;
}

// Whether the method's own loop makes the bounce: arc's, if it is not its own light that bounces.
static bool bounces_itself(const pass_context *c, const plan *p)
{
    if (!p->bounce) return false;
    return bounce_of(p) == pass_raytrace_bounce ||
           (bounce_of(p) == pass_arc_bounce && p->method->run == pass_arc && !c->set.relight);
}

// What the method itself makes, filtered: linear quantities all.
static bool run_method(pass_context *c, const plan *p, error *e)
{
    if (!p->method->run(c, e)) return false;
    if (!p->blur) return true;
    if (c->change.id && !c->denoised && !pass_denoise(c, e)) return false;
    gpu_image *plain = c->denoised ? NULL : &c->occlusion;
    if ((plain || c->visibility.id || c->radiance.id) && !pass_blur(c, plain, &c->visibility, &c->radiance, e)) return false;
    return !c->bent.id || pass_blur(c, NULL, NULL, &c->bent, e);
}

static bool finish_light(pass_context *c, const plan *p, error *e)
{
    if (!pass_proxies(c, e)) return false;
    if (p->look && !pass_look(c, &c->occlusion, e)) return false;
    if (p->look && c->visibility.id && !pass_look(c, &c->visibility, e)) return false;
    return !p->irradiance || pass_irradiance(c, e);
}

static bool run_bounce(pass_context *c, const plan *p, error *e)
{
    if (!p->bounce) return true;
    if (!bounce_of(p)(c, e)) return false;
    // The virtual lights are the same for all pixels: no noise. A method that filters itself does not filter the bounce.
    return c->set.blur == 0 || bounce_of(p) == pass_vpl || pass_blur(c, NULL, NULL, &c->indirect, e);
}

// The times of the small frame's passes belong to the frame.
static void take_times(pass_context *c, const pass_context *small)
{
    for (int i = 0; i < small->timing_count && c->timing_count < PASS_MAX_TIMINGS; i++)
        c->timings[c->timing_count++] = small->timings[i];
    c->planes = small->planes;
}

static bool run_half(pass_context *c, const plan *p, error *e)
{
    gbuffer gb, whole = *c->gb; // borrows its arrays
    pass_context small;
    // What the bounce gathers; nothing else at half size looks at colours.
    if (!p->bounce) whole.albedo = NULL;
    if (!p->bounce || c->set.relight) whole.beauty = NULL;
    if (!gbuffer_halve(&whole, c->threads, &gb, e)) return false;
    pass_settings set = c->set;
    set.blur = (set.blur + 1) / 2; // as wide on the surface as at full size
    bool ok = pass_begin(&small, c->g, &gb, c->env, &set, c->timing, c->log, e);
    if (!ok) goto out;
    small.tiles.stop = c->tiles.stop;
    small.environment = c->environment;
    small.sunless = c->sunless;
    small.trace = c->trace;
    small.want_indirect = c->want_indirect;
    small.proxies = c->proxies;
    small.threads = c->threads;
    small.want_radiance = c->want_radiance;
    small.want_visibility = c->want_visibility;
    small.want_bent = c->want_bent;
    ok = run_method(&small, p, e);
    // All layers go up together, unless the bounce needs what is done to them at either size.
    bool early =
        p->bounce && c->set.relight && (p->look || p->irradiance || (c->proxies && c->proxies->count > 0) || small.suns_apart);
    ok = ok && (!early || pass_upsample(c, &small, e));
    if (ok && p->bounce) ok = (!early || (pass_suns(&small, e) && finish_light(&small, p, e))) && run_bounce(&small, p, e);
    ok = ok && (early ? pass_upsample_indirect(c, &small, e) : pass_upsample(c, &small, e));
    take_times(c, &small);
    pass_end(&small);
    ok = ok && pass_suns(c, e) && finish_light(c, p, e);
out:
    gbuffer_free(&gb);
    return ok;
}

static bool run_passes(pass_context *c, const plan *p, error *e)
{
    if (c->set.half ? !run_half(c, p, e)
                    : !(run_method(c, p, e) && pass_suns(c, e) && finish_light(c, p, e) && run_bounce(c, p, e)))
        return false;
    // A beauty's light on unseen spheres is unknown: they send none.
    if (p->bounce && c->set.relight && !pass_proxies_bounce(c, e)) return false;
    if (p->edges && c->coverage.id && !pass_edges(c, e)) return false;
    if (p->specular && !pass_specular(c, e)) return false;
    if (p->depthmask && !pass_depthmask(c, e)) return false;
    return !p->composite || pass_composite(c, e);
}

static double milliseconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

// Without coverage the passes take a pixel for covered where it has a surface.
static bool needs_coverage(const gbuffer *gb)
{
    size_t pixels = (size_t)gb->width * (size_t)gb->height;
    for (size_t i = 0; gb->coverage && i < pixels; i++)
        if (gb->coverage[i] != (gb->depth[i] > 0.0f ? 1.0f : 0.0f)) return true;
    return false;
}

static void take_rounds(const job *j, frame_result *r, const pass_rounds *rounds)
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

bool filter_frame(job *j, frame_result *r, error *e)
{
    pass_context c;
    double wall = milliseconds(CLOCK_MONOTONIC), cpu = milliseconds(CLOCK_PROCESS_CPUTIME_ID);
    const gpu_counts before = j->g.counts;
    const environment *env = j->env_loaded ? &j->env : NULL;
    gbuffer gb = r->gb; // borrows its arrays
    if (!needs_coverage(&gb)) gb.coverage = NULL;
    if (!pass_begin(&c, &j->g, &gb, env, &r->set, j->o->report != NULL, j->log, e)) return false;
    c.environment = j->env_image;
    c.sunless = &j->sunless;
    c.trace = &j->trace;
    c.want_indirect = bounces_itself(&c, &r->plan);
    c.proxies = &r->proxies;
    c.threads = j->threads;
    c.want_radiance = r->plan.want_radiance;
    c.want_bent = r->plan.want_bent;
    c.want_error = r->plan.want_error;
    c.want_visibility = r->plan.want_visibility && r->plan.method->fills_radiance;
    for (int k = 0; k < SH_IMAGES; k++) c.stored_sh[k] = r->stored_sh[k];
    c.tiles.stop = j->stop;
    c.want_diffuse = r->plan.layers & 1u << LAYER_DIFFUSE;
    bool ok = run_passes(&c, &r->plan, e) && gpu_finish(&j->g, "the passes", e);
    r->wall_ms[STAGE_PASSES] = milliseconds(CLOCK_MONOTONIC) - wall;
    r->cpu_ms[STAGE_PASSES] = milliseconds(CLOCK_PROCESS_CPUTIME_ID) - cpu;
    ok = ok && !job_stopped(j) && read_back(j, &c, r, e) && gpu_finish(&j->g, "the read-back", e);
    r->wall_ms[STAGE_READ_BACK] = milliseconds(CLOCK_MONOTONIC) - wall - r->wall_ms[STAGE_PASSES];
    r->cpu_ms[STAGE_READ_BACK] = milliseconds(CLOCK_PROCESS_CPUTIME_ID) - cpu - r->cpu_ms[STAGE_PASSES];
    memcpy(r->timings, c.timings, sizeof r->timings);
    r->timing_count = c.timing_count;
    memcpy(r->uploads, c.uploads, sizeof r->uploads);
    r->upload_count = c.upload_count;
    r->planes = c.planes;
    if (ok) take_rounds(j, r, &c.rounds);
    r->tile_size = c.tiles.size, r->tiles = c.tiles.columns * c.tiles.rows, r->tiles_occupied = c.tiles.occupied_count;
    r->gl = gpu_counts_since(&j->g, &before);
    pass_end(&c);
    return ok;
}
