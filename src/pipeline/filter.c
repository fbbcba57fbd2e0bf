#include "pipeline/filter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/mem.h"
#include "gbuffer/half.h"

// The bounce that --bounce names, else the method's own.
static bool (*bounce_of(const plan *p))(pass_context *, error *)
{
    const char *name = p->bounce_name ? p->bounce_name : p->method->bounce;
    if (name && strcmp(name, "vpl") == 0) return pass_vpl;
    if (name && strcmp(name, "raytrace") == 0) return pass_raytrace_bounce;
    return name && strcmp(name, "arc") == 0 ? pass_arc_bounce : pass_ssdo_bounce;
}

// What the method itself makes, filtered: linear quantities all.
static bool run_method(pass_context *c, const plan *p, error *e)
{
    if (!p->method->run(c, e)) return false;
    if (!p->blur) return true;
    return pass_blur(c, &c->occlusion, &c->visibility, &c->radiance, e) && (!c->bent.id || pass_blur(c, NULL, NULL, &c->bent, e));
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
    gbuffer gb;
    pass_context small;
    if (!gbuffer_halve(c->gb, c->threads, &gb, e)) return false;
    pass_settings set = c->set;
    set.blur = (set.blur + 1) / 2; // as wide on the surface as at full size
    bool ok = pass_begin(&small, c->g, &gb, c->env, &set, c->timing, c->log, e);
    if (!ok) goto out;
    small.environment = c->environment;
    small.sunless = c->sunless;
    small.trace = c->trace;
    small.want_indirect = c->want_indirect;
    small.proxies = c->proxies;
    small.threads = c->threads;
    small.want_radiance = c->want_radiance;
    small.want_visibility = c->want_visibility;
    small.want_bent = c->want_bent;
    // All layers go up together, unless the bounce needs what is done to them at either size.
    bool early = p->bounce && (p->look || p->irradiance || (c->proxies && c->proxies->count > 0));
    ok = run_method(&small, p, e) && (!early || pass_upsample(c, &small, e));
    if (ok && p->bounce) ok = (!early || finish_light(&small, p, e)) && run_bounce(&small, p, e);
    ok = ok && (early ? pass_upsample_indirect(c, &small, e) : pass_upsample(c, &small, e));
    take_times(c, &small);
    pass_end(&small);
out:
    gbuffer_free(&gb);
    return ok && finish_light(c, p, e);
}

static bool run_passes(pass_context *c, const plan *p, error *e)
{
    if (c->set.half ? !run_half(c, p, e) : !(run_method(c, p, e) && finish_light(c, p, e) && run_bounce(c, p, e))) return false;
    // A beauty's light on unseen spheres is unknown: they send none.
    if (p->bounce && c->set.relight && !pass_proxies_bounce(c, e)) return false;
    if (p->edges && c->coverage.id && !pass_edges(c, e)) return false;
    if (p->specular && !pass_specular(c, e)) return false;
    if (p->depthmask && !pass_depthmask(c, e)) return false;
    return !p->composite || pass_composite(c, e);
}

// A layer never holds NaN or infinity, whatever happened before; occlusion stays in 0..1 and light is not negative.
static inline float sane(float v, bool share, bool light)
{
    if (!(fabsf(v) <= 3e38f)) v = share ? 1.0f : isnan(v) ? 0.0f : copysignf(3e38f, v);
    if (share) return v < 0.0f ? 0.0f : v > 1.0f ? 1.0f : v;
    return light && v < 0.0f ? 0.0f : v;
}

// Leaves the first `channels` of every `stored` components, in place and in one sweep: the picture is larger than any cache.
static void sanitise(layer_id l, float *v, size_t pixels, size_t stored, size_t channels)
{
    bool share = l == LAYER_OCCLUSION || l == LAYER_VISIBILITY,
         light = l == LAYER_RADIANCE || l == LAYER_INDIRECT || l == LAYER_SPECULAR;
    float *to = v;
    for (size_t i = 0; i < pixels; i++, v += stored)
        for (size_t k = 0; k < channels; k++) *to++ = sane(v[k], share, light);
}

// Bent normals: unit length, in the space of the file's normals. Where nothing is open the normal stands in.
static void point_along(const gbuffer *gb, float *v, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++) {
        float *w = v + 3 * i;
        const float *n = gb->normal + 4 * i;
        vec3 d = v3((double)w[0], (double)w[1], (double)w[2]);
        if (v3_length(d) < 1e-4) d = v3((double)n[0], (double)n[1], (double)n[2]);
        d = v3_normalize(m3_apply(gb->normal_from_camera, d));
        w[0] = (float)d.x, w[1] = (float)d.y, w[2] = (float)d.z;
    }
}

// Two pictures of four components, one behind the other, to one of eight.
static bool interleave(float *v, size_t pixels, error *e)
{
    float *t = mem_pixels(8 * pixels, sizeof *t, e);
    if (!t) return false;
    for (size_t i = 0; i < pixels; i++) {
        memcpy(t + 8 * i, v + 4 * i, 4 * sizeof *t);
        memcpy(t + 8 * i + 4, v + 4 * (pixels + i), 4 * sizeof *t);
    }
    memcpy(v, t, 8 * pixels * sizeof *t);
    free(t);
    return true;
}

static bool read_back(const gpu_image *image, layer_id l, frame_result *r, error *e)
{
    size_t pixels = (size_t)r->gb.width * (size_t)r->gb.height, channels = strlen(layer_table[l].channels);
    bool last = l == LAYER_SH_3; // its last three coefficients are in the next image
    size_t stored = image->format == GL_R32F ? 1 : last ? 8 : 4;
    float *v = mem_pixels(pixels * stored, sizeof *v, e);
    if (!v) return false;
    gpu_image_download(image, v);
    if (last) gpu_image_download(image + 1, v + 4 * pixels);
    if (last && !interleave(v, pixels, e)) {
        free(v);
        return false;
    }
    sanitise(l, v, pixels, stored, channels);
    if (l == LAYER_BENT) point_along(&r->gb, v, pixels);
    r->layers[l] = v;
    return true;
}

static bool read_layers(const pass_context *c, frame_result *r, error *e)
{
    const gpu_image *images[LAYER_COUNT] = {
        [LAYER_OCCLUSION] = &c->occlusion,
        [LAYER_RADIANCE] = &c->radiance,
        [LAYER_INDIRECT] = &c->indirect,
        [LAYER_COMPOSITE] = &c->composite,
        [LAYER_VISIBILITY] = c->visibility.id ? &c->visibility : &c->occlusion,
        [LAYER_SPECULAR] = &c->specular,
        [LAYER_DIFFUSE] = &c->diffuse,
        [LAYER_DEPTHMASK] = &c->depthmask,
        [LAYER_BENT] = &c->bent,
        [LAYER_SH_0] = &c->sh[0],
        [LAYER_SH_1] = &c->sh[1],
        [LAYER_SH_2] = &c->sh[2],
        [LAYER_SH_3] = &c->sh[3],
    };
    for (int i = 0; i < LAYER_COUNT; i++)
        if (r->plan.layers & 1u << i && !read_back(images[i], (layer_id)i, r, e)) return false;
    return true;
}

static double milliseconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

// Coverage matters to the composite, and where a pixel has a share of a surface but none recorded, which the edges pass fills.
static bool needs_coverage(const frame_result *r)
{
    size_t pixels = (size_t)r->gb.width * (size_t)r->gb.height;
    if (!r->gb.coverage || r->plan.composite) return r->gb.coverage != NULL;
    for (size_t i = 0; i < pixels; i++)
        if (r->gb.coverage[i] > 0.0f && r->gb.depth[i] == 0.0f) return true;
    return false;
}

bool filter_frame(job *j, frame_result *r, error *e)
{
    pass_context c;
    double wall = milliseconds(CLOCK_MONOTONIC), cpu = milliseconds(CLOCK_PROCESS_CPUTIME_ID);
    const environment *env = j->env_loaded ? &j->env : NULL;
    gbuffer gb = r->gb; // borrows its arrays
    if (!needs_coverage(r)) gb.coverage = NULL;
    if (!pass_begin(&c, &j->g, &gb, env, &r->set, j->o->report != NULL, j->log, e)) return false;
    c.environment = j->env_image;
    c.sunless = &j->sunless;
    c.trace = &j->trace;
    c.want_indirect = r->plan.bounce && bounce_of(&r->plan) == pass_raytrace_bounce;
    c.proxies = &r->proxies;
    c.threads = j->threads;
    c.want_radiance = r->plan.want_radiance;
    c.want_bent = r->plan.want_bent;
    c.want_visibility = r->plan.want_visibility && r->plan.method->fills_radiance;
    for (int k = 0; k < SH_IMAGES; k++) c.stored_sh[k] = r->stored_sh[k];
    c.tiles.stop = j->stop;
    c.want_diffuse = r->plan.layers & 1u << LAYER_DIFFUSE;
    bool ok = run_passes(&c, &r->plan, e) && gpu_finish(&j->g, "the passes", e);
    r->wall_ms[STAGE_PASSES] = milliseconds(CLOCK_MONOTONIC) - wall;
    r->cpu_ms[STAGE_PASSES] = milliseconds(CLOCK_PROCESS_CPUTIME_ID) - cpu;
    ok = ok && !job_stopped(j) && read_layers(&c, r, e) && gpu_finish(&j->g, "the read-back", e);
    r->wall_ms[STAGE_READ_BACK] = milliseconds(CLOCK_MONOTONIC) - wall - r->wall_ms[STAGE_PASSES];
    r->cpu_ms[STAGE_READ_BACK] = milliseconds(CLOCK_PROCESS_CPUTIME_ID) - cpu - r->cpu_ms[STAGE_PASSES];
    memcpy(r->timings, c.timings, sizeof r->timings);
    r->timing_count = c.timing_count;
    memcpy(r->uploads, c.uploads, sizeof r->uploads);
    r->upload_count = c.upload_count;
    r->planes = c.planes;
    r->tile_size = c.tiles.size, r->tiles = c.tiles.columns * c.tiles.rows, r->tiles_occupied = c.tiles.occupied_count;
    pass_end(&c);
    return ok;
}
