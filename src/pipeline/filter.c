#include "pipeline/filter.h"
#include "base/clock.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "gbuffer/half_size.h"
#include "pipeline/read_back.h"

// The times of the small frame's passes belong to the frame.
static void take_times(pass_context *c, const pass_context *small)
{
    pass_take_timings(c, small);
    if (!c->planes.found) c->planes = small->planes;
}

static bool halve(const job *j, frame_result *r, error *e)
{
    gbuffer whole = r->gb; // borrows its arrays
    image_set given = steps_given_small(&r->plan, &r->set, steps_given(&whole));
    if (r->uncovered) whole.coverage = NULL;
    if (!(given & IMAGE_BIT(IMAGE_ALBEDO))) whole.albedo = NULL;
    if (!(given & IMAGE_BIT(IMAGE_BEAUTY))) whole.beauty = NULL;
    return gbuffer_halve(&whole, j->threads, &r->half_size, e) &&
           (r->set.size != SIZE_LIGHT || gbuffer_lone(&whole, &r->half_size, j->threads, &r->lone, e));
}

// ---- the list of steps, run

// The frame, and while steps run on it the one of half its size.
typedef struct runner {
    pass_context *whole, small;
    const gbuffer *half_size;
    bool open; // small is
    bool marches_for_light;
} runner;

static bool open_small(runner *r, error *e)
{
    pass_settings set = r->whole->set;
    // As wide on the surface as at full size; of a method that marches for light, half as wide again, for it takes fewer samples.
    set.blur = r->marches_for_light ? (3 * set.blur + 3) / 4 : (set.blur + 1) / 2;
    r->small = pass_like(r->whole, r->half_size, &set);
    if (set.size == SIZE_LIGHT) r->small.whole = r->whole, r->small.whole_side = 2;
    r->open = pass_begin(&r->small, e);
    return r->open;
}

static void close_small(runner *r)
{
    if (!r->open) return;
    take_times(r->whole, &r->small);
    pass_end(&r->small);
    r->open = false;
}

static bool are_there(const pass_context *c, image_set images, const char *pass, const char *what, error *e)
{
    for (int i = 0; i < IMAGE_COUNT; i++)
        if (images & IMAGE_BIT(i) && !c->image[i].id)
            return err_set(e, ERR_GL, NULL, NULL, "the pass '%s' %s the picture '%s', which is not there", pass, what,
                           image_table[i].name);
    return true;
}

static bool run_step(runner *r, const plan_step *s, error *e)
{
    if (s->size != STEP_WHOLE && !r->open && !open_small(r, e)) return false;
    bool at_half = s->size == STEP_SMALL || s->size == STEP_AMID || s->size == STEP_DOWN;
    bool reads_half = s->size == STEP_SMALL || s->size == STEP_UP;
    pass_context *c = at_half ? &r->small : r->whole;
    const pass_context *from = reads_half ? &r->small : r->whole;
    return are_there(from, s->reads, s->pass, "reads", e) &&
           (s->size == STEP_UP     ? pass_upsample(c, from, s->writes, e)
            : s->size == STEP_DOWN ? pass_downsample(c, from, s->writes, e)
                                   : s->run(c, s, e)) &&
           are_there(c, s->writes, s->pass, "did not make", e);
}

static bool small_is_needed(const step_list *l, int after)
{
    for (int i = after + 1; i < l->count; i++)
        if (l->steps[i].runs && l->steps[i].size != STEP_WHOLE) return true;
    return false;
}

static bool run_steps(pass_context *c, const gbuffer *half_size, const step_list *l, bool marches_for_light, error *e)
{
    runner r = {.whole = c, .half_size = half_size, .marches_for_light = marches_for_light};
    bool ok = true;
    for (int i = 0; ok && i < l->count; i++) {
        if (!l->steps[i].runs) continue;
        ok = run_step(&r, &l->steps[i], e);
        if (!small_is_needed(l, i)) close_small(&r);
    }
    close_small(&r);
    return ok;
}

static void take_adaptive(const job *j, frame_result *r, const adaptive_sampling *rounds)
{
    r->rounds = rounds->count, r->tiles_above = rounds->above, r->mean_samples = rounds->mean_samples;
    if (r->rounds == 0) return;
    log_info(j->log, "--error %g: %.0f samples a pixel in the mean, %d rounds", r->set.target_error, r->mean_samples, r->rounds);
    if (r->tiles_above > 0)
        log_warn(j->log, "error",
                 "%d of %d tiles of a frame have an estimated standard error above %g after %d samples; --samples allows more; "
                 "the report says so of each frame",
                 r->tiles_above, rounds->tiles.occupied_count, r->set.target_error, rounds->most_samples);
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
    return !steps_use_small(&r->plan, &r->set) || r->half_size.depth || halve(j, r, e);
}

void filter_list(const frame_result *r, bool suns, step_list *out)
{
    image_set given = steps_given(&r->gb);
    bool uncovered = r->prepared ? r->uncovered : !needs_coverage(&r->gb);
    if (uncovered) given &= ~IMAGE_BIT(IMAGE_COVERAGE);
    bool lone = !r->prepared || r->lone.count > 0;
    steps_make(&(step_facts){&r->plan, &r->set, given, r->proxies.count > 0, suns, r->gb.mixed_count > 0, lone}, out);
}

static bool list_steps(const job *j, pass_context *c, frame_result *r, error *e)
{
    bool split = steps_split_suns(&r->plan);
    if (split && !pass_split_suns(c, e)) return false;
    filter_list(r, split && c->sunless->map.id != 0, &r->steps);
    for (int i = 0; i < r->steps.count; i++) {
        const plan_step *s = &r->steps.steps[i];
        log_info(j->log, "pass %s: %s (%s)", s->pass, s->runs ? "runs" : "does not run", s->why);
    }
    return true;
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

bool filter_estimate(job *j, const gbuffer *gb, job_light *light, const plan *p, const pass_settings *set,
                     const plane_set *planes, bool views, float *radiance, float *indirect, error *e)
{
    pass_context c = {.g = &j->g,
                      .log = NULL,
                      .threads = j->threads,
                      .stop = j->stop,
                      .set = *set,
                      .gb = gb,
                      .env = &light->env,
                      .environment = light->image,
                      .views = j->views,
                      .view_count = views ? j->view_count : 0,
                      .further = &j->further,
                      .surround = &light->surround,
                      .sunless = &light->sunless,
                      .planes = *planes,
                      .trace = &j->trace};
    if (!pass_begin(&c, e)) return false;
    step_list list;
    bool ok = !steps_split_suns(p) || pass_split_suns(&c, e);
    if (ok) {
        steps_make(&(step_facts){p, set, steps_given(gb), false, c.sunless->map.id != 0, gb->mixed_count > 0, false}, &list);
        ok = run_steps(&c, gb, &list, p->method->run_light != NULL, e) && gpu_finish(&j->g, "the passes", e);
    }
    size_t n = (size_t)gb->width * (size_t)gb->height;
    float *rgba = ok ? mem_pixels(4 * n, sizeof *rgba, e) : NULL;
    ok = rgba;
    float *const out[] = {radiance, indirect};
    for (int l = 0; ok && l < 2; l++) {
        if (!out[l]) continue;
        gpu_image_download(&j->g, &c.image[l ? IMAGE_INDIRECT : IMAGE_RADIANCE], rgba);
        for (size_t i = 0; i < 3 * n; i++) out[l][i] = rgba[i / 3 * 4 + i % 3];
    }
    free(rgba);
    pass_end(&c);
    return ok;
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
        .gb = &gb,
        .lone = &r->lone,
        .env = j->light.loaded ? &j->light.env : NULL,
        .environment = j->light.image,
        .views = j->views,
        .view_count = j->view_count,
        .further = &j->further,
        .proxies = &r->proxies,
        .surround = &j->light.surround,
        .sunless = &j->light.sunless,
        .planes = r->planes,
        .trace = &j->trace,
    };
    for (int k = 0; k < SH_IMAGES; k++) c.relight_sh[k] = r->relight_sh[k];
    if (!pass_begin(&c, e)) return false;
    bool ok = list_steps(j, &c, r, e) && run_steps(&c, &r->half_size, &r->steps, p->method->run_light != NULL, e) &&
              gpu_finish(&j->g, "the passes", e);
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
    gbuffer_free(&r->half_size);
    pixel_list_free(&r->lone);
    return ok;
}

bool filter_frame(job *j, frame_result *r, error *e) { return filter_begin(j, r, e) && read_back_finish(j, r, e); }
