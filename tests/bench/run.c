#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "base/mem.h"
#include "bench.h"
#include "light/sh.h"
#include "passes/trace.h"

bool bench_runs(const bench_row *row, const bench_scene *b)
{
    if (row->kind != ROW_METHOD) return true;
    return (row->m->source != SEES_MESH || b->mesh[0]) && (!row->middle || b->middle);
}

pass_settings bench_settings(const bench_row *row, const bench_scene *b)
{
    options o;
    options_defaults(&o);
    double radius = row->radius > 0.0 ? row->radius : b->radius;
    pass_settings set = rig_settings(row->m, radius);
    set.angle_bias = o.angle_bias;
    set.sh_sigma = row->sh_sigma > 0.0 ? row->sh_sigma : o.sh_sigma;
    set.thickness = (row->thickness < 0.0 ? row->m->thickness : row->thickness) * radius;
    set.samples = row->samples;
    set.seed = row->seed;
    set.blur = row->blur;
    set.planes = !row->no_planes;
    set.size = row->half ? SIZE_HALF : SIZE_FULL;
    if (row->lights > 0) set.vpl_count = row->lights;
    set.sh_bands = row->sh_bands;
    set.scale = row->scale;
    set.contrast = row->contrast;
    set.mesh = b->mesh;
    set.mesh_axes = -1;
    set.trace = row->trace;
    return set;
}

static const char *bounce_of(const bench_row *row)
{
    return row->bounce ? row->bounce : row->m->bounce ? row->m->bounce->name : NULL;
}

unsigned bench_layers(const bench_row *row)
{
    if (row->kind != ROW_METHOD) return 0;
    if (row->samples > BENCH_LONG) return 1u << LAYER_OCCLUSION;
    return 1u << LAYER_OCCLUSION | 1u << LAYER_RADIANCE | (bounce_of(row) ? 1u << LAYER_INDIRECT : 0u) | row->extra;
}

// `share` of the scene's pixels were in the frame.
static void take_time(const frame_result *f, const char *without, double share, bench_time *t)
{
    if (!t) return;
    *t = (bench_time){f->cpu_ms[STAGE_PASSES], f->wall_ms[STAGE_PASSES]};
    for (int i = 0; i < f->timing_count; i++)
        if (strcmp(f->timings[i].name, "upload") == 0 || strcmp(f->timings[i].name, without) == 0)
            t->cpu -= f->timings[i].cpu_ms, t->wall -= f->timings[i].wall_ms;
    t->cpu /= share, t->wall /= share;
}

// Reads the mesh, builds what traces it and compiles, which a batch does once: runs of one sample that nobody times.
static bool open_mesh(rig *r, const bench_scene *b, const bench_row *row, pass_settings set, error *e)
{
    const trace_scene *s = &r->job.trace;
    const unsigned layers[] = {bench_layers(row), 1u << LAYER_OCCLUSION};
    if (s->path && strcmp(s->path, b->mesh) == 0 && (s->cpu != NULL) == (row->trace != TRACE_GPU)) return true;
    trace_scene_close(&r->job.trace);
    set.samples = 1;
    for (int i = 0; i < 2; i++) {
        frame_result ignored;
        if (!rig_run(r, &b->gb, row->m, &set, layers[i], &ignored, e)) return false;
        rig_free_result(&ignored);
    }
    return true;
}

// What a file of an earlier run would bring along, as half.
static bool store_sh(rig *r, const bench_scene *b, const bench_row *row, const pass_settings *set, error *e)
{
    frame_result f;
    size_t n = (size_t)b->gb.width * (size_t)b->gb.height;
    if (!rig_run(r, &b->gb, row->m, set, 7u << LAYER_SH_0, &f, e)) return false;
    for (int k = 0; k < 3 && e->code == ERR_NONE; k++) {
        r->relight_sh[k] = mem_pixels(4 * n, sizeof(float), e);
        for (size_t i = 0; r->relight_sh[k] && i < 4 * n; i++)
            r->relight_sh[k][i] = i % 4 < 3 ? half_to_float(float_to_half(f.layers[LAYER_SH_0 + k][i / 4 * 3 + i % 4])) : 0.0f;
    }
    rig_free_result(&f);
    return e->code == ERR_NONE;
}

static void forget_sh(rig *r)
{
    for (int k = 0; k < SH_IMAGES; k++) free(r->relight_sh[k]), r->relight_sh[k] = NULL;
}

// The rig's environment is the scene's for the time of a run; the scene keeps owning it.
bool bench_run(rig *r, const bench_scene *b, const bench_row *row, unsigned layers, frame_result *out, bench_time *direct,
               bench_time *all, error *e)
{
    pass_settings set = bench_settings(row, b);
    double share = row->middle ? (double)b->middle->gb.width / b->gb.width : 1.0;
    r->proxies = row->proxies ? b->proxies : (proxy_set){0};
    if (row->middle) b = b->middle;
    r->job.light.env = b->env;
    r->job.light.image = b->env_image;
    r->job.light.loaded = true;
    r->job.light.sunless = *b->sunless;
    r->options.bounce = row->bounce; // without, the method's own
    r->options.report = "timed";     // a report makes the passes wait and take their times
    bool ok = (row->m->source != SEES_MESH || open_mesh(r, b, row, set, e)) && (!row->relit || store_sh(r, b, row, &set, e)) &&
              rig_run(r, &b->gb, row->m, &set, layers, out, e);
    forget_sh(r);
    r->job.light.loaded = false;
    r->job.light.image = (gpu_image){0};
    out->proxies = (proxy_set){0}; // the scene's
    *b->sunless = r->job.light.sunless;
    r->job.light.sunless = (pass_sunless){0};
    if (!ok) return false;
    take_time(out, "irradiance", share, direct);
    take_time(out, "", share, all);
    return true;
}

// ---- pictures of rows that are no method

static float *filled(const sample *s, int channels, error *e)
{
    return mem_zero((size_t)s->width * (size_t)s->height * (size_t)channels, sizeof(float), e);
}

static float *constant(const sample *s, int channels, float *const truth[2], bool one, error *e)
{
    size_t n = (size_t)s->width * (size_t)s->height;
    float *x = filled(s, channels, e);
    for (int k = 0; x && k < channels; k++) {
        double sum = 0.0, count = 0.0;
        for (size_t i = 0; i < n; i++)
            if (sample_is_surface(s, (int)i)) {
                size_t j = i * (size_t)channels + (size_t)k;
                sum += 0.5 * ((double)truth[0][j] + (double)truth[1][j]), count += 1.0;
            }
        for (size_t i = 0; i < n; i++) x[i * (size_t)channels + (size_t)k] = one ? 1.0f : (float)(sum / count);
    }
    return x;
}

// What a compositor gets by multiplying an irradiance map, looked up with the normal, by an occlusion.
static float *irradiance(const bench_scene *b, bool occluded, error *e)
{
    const sample *s = &b->s;
    size_t n = (size_t)s->width * (size_t)s->height;
    float *x = filled(s, 3, e);
    const camera *c = &b->gb.camera;
    mat3 m = m3_mul(b->env.map_from_world, c->has_world ? c->world_from_camera : m3_identity());
    for (size_t i = 0; x && i < n; i++) {
        const float *v = b->gb.normal + 4 * i;
        vec3 l = sh_irradiance_over_pi(b->env.sh, m3_apply(m, v3((double)v[0], (double)v[1], (double)v[2])));
        double k = occluded ? 0.5 * ((double)s->ao[0][i] + (double)s->ao[1][i]) : 1.0;
        x[3 * i] = (float)(k * fmax(0.0, l.x)), x[3 * i + 1] = (float)(k * fmax(0.0, l.y));
        x[3 * i + 2] = (float)(k * fmax(0.0, l.z));
    }
    return x;
}

static bool measure_oracle(const bench_scene *b, const bench_row *row, bench_cell *cell, error *e)
{
    const sample *s = &b->s;
    float *ao = NULL, *direct = NULL, *indirect = NULL;
    if (row->kind == ROW_OPEN) ao = constant(s, 1, s->ao, true, e);
    if (row->kind == ROW_CONSTANT) {
        ao = constant(s, 1, s->ao, false, e);
        direct = constant(s, 3, s->direct, false, e);
        indirect = constant(s, 3, s->indirect, false, e);
    }
    if (row->kind == ROW_IRRADIANCE || row->kind == ROW_TRUE_AO) direct = irradiance(b, row->kind == ROW_TRUE_AO, e);
    if (e->code == ERR_NONE) {
        cell->has_occlusion = ao, cell->has_radiance = direct, cell->has_indirect = indirect;
        if (ao) cell->occlusion = sample_score(s, ao, s->ao[0], s->ao[1], 1);
        if (direct) cell->radiance = sample_score(s, direct, s->direct[0], s->direct[1], 3);
        if (indirect) cell->indirect = sample_score(s, indirect, s->indirect[0], s->indirect[1], 3);
    }
    free(ao);
    free(direct);
    free(indirect);
    return e->code == ERR_NONE;
}

static const float *at(const bench_scene *b, const float *values, int channels, pixel p)
{
    return values + channels * (p.y * b->gb.width + p.x);
}

// Relative root mean square difference of light from what is expected: pixel i of `count`, `stride` numbers apart.
static double light_error(const bench_scene *b, const float *light, const double *expected, int count, int stride, bool vpl)
{
    double square = 0.0, mean = 0.0;
    for (int i = 0; i < count; i++) {
        const float *x = at(b, light, 3, vpl ? bench_vpl_pixel(b, i) : b->pixels[i]);
        for (int k = 0; k < 3; k++) {
            double wanted = expected[i * stride + k], d = (double)x[k] - wanted;
            square += d * d / (3.0 * count), mean += wanted / (3.0 * count);
        }
    }
    return sqrt(square) / mean;
}

static bool compare(const bench_scene *b, const bench_row *row, const frame_result *f, const char *cache, bench_cell *cell,
                    error *e)
{
    if (row->middle) return true; // the references' pixels are the whole picture's
    double *expected = bench_reference(b, row, cache, e), square = 0.0, sum = 0.0;
    for (int i = 0; expected && i < b->pixel_count; i++) {
        double d = (double)*at(b, f->layers[LAYER_OCCLUSION], 1, b->pixels[i]) - expected[4 * i];
        square += d * d, sum += d;
    }
    cell->has_a = expected;
    cell->a_rmse = sqrt(square / b->pixel_count);
    cell->a_bias = sum / b->pixel_count;
    cell->has_a_radiance = expected && cell->has_radiance && method_references_light(row->m);
    if (cell->has_a_radiance)
        cell->a_radiance = light_error(b, f->layers[LAYER_RADIANCE], expected + 1, b->pixel_count, 4, false);
    free(expected);
    cell->has_a_indirect = cell->has_indirect && row->lights > 0;
    if (cell->has_a_indirect && e->code == ERR_NONE) {
        expected = bench_reference_vpl(b, f->layers[LAYER_RADIANCE], cache, e);
        if (expected) cell->a_indirect = light_error(b, f->layers[LAYER_INDIRECT], expected, BENCH_VPL_PIXELS, 3, true);
        free(expected);
    }
    return e->code == ERR_NONE;
}

bool bench_measure(rig *r, const bench_scene *b, const bench_row *row, const char *cache, bench_cell *cell, error *e)
{
    if (row->kind != ROW_METHOD) return measure_oracle(b, row, cell, e);
    frame_result f;
    const sample *s = row->middle ? &b->middle->s : &b->s;
    unsigned layers = bench_layers(row);
    if (!bench_run(r, b, row, layers, &f, &cell->direct[0], &cell->all[0], e)) return false;
    cell->has_occlusion = true;
    cell->has_radiance = layers & 1u << LAYER_RADIANCE;
    cell->has_indirect = layers & 1u << LAYER_INDIRECT;
    cell->occlusion = sample_score(s, f.layers[LAYER_OCCLUSION], s->ao[0], s->ao[1], 1);
    if (cell->has_radiance) cell->radiance = sample_score(s, f.layers[LAYER_RADIANCE], s->direct[0], s->direct[1], 3);
    if (cell->has_indirect) cell->indirect = sample_score(s, f.layers[LAYER_INDIRECT], s->indirect[0], s->indirect[1], 3);
    bool ok = compare(b, row, &f, cache, cell, e);
    rig_free_result(&f);
    return ok;
}
