#include "pipeline/frame.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "base/threads.h"
#include "cli/frames.h"
#include "exr/write.h"
#include "gbuffer/conventions.h"
#include "gbuffer/depth_code.h"
#include "pipeline/filter.h"
#include "pipeline/output.h"
#include "pipeline/read_back.h"
#include "pipeline/relight.h"
#include "pipeline/settings.h"
#include "pipeline/stopwatch.h"
#include "pipeline/views.h"
#include "plugin/colour.h"

static void lap(frame_result *r, stage s, stopwatch *since) { stopwatch_add(since, &r->wall_ms[s], &r->cpu_ms[s]); }

void job_init(job *j, const options *o, log_t *log)
{
    *j = (job){.o = o, .log = log, .threads = o->threads > 0 ? o->threads : threads_default()};
    if (!o->hosted) gpu_set_up();
    if (!colour_config(o->ocio))
        log_info(log, "colour: no OpenColorIO config, so beauty, albedo and environment count as linear");
}

static bool open_device(job *j, error *e)
{
    const gpu_request request = {
        .device = j->o->device, .hardware = j->o->require_gpu, .debug = j->o->gpu_debug, .hosted = j->o->hosted};
    if (!gpu_open_as(&j->g, request, j->log, e)) return false;
    j->g.threads = j->threads;
    return true;
}

bool job_open(job *j, const options *o, log_t *log, error *e)
{
    job_init(j, o, log);
    return open_device(j, e);
}

bool job_stopped(const job *j) { return j->stop && *j->stop; }

void job_forget_light(job *j)
{
    gpu_image_free(&j->env_image);
    gpu_image_free(&j->sunless.map);
    trace_scene_close(&j->trace);
    if (j->env_loaded) environment_free(&j->env);
    j->env_loaded = false;
    j->sunless = (pass_sunless){0};
    j->trace = (trace_scene){0};
}

void job_close(job *j)
{
    job_forget_light(j);
    gpu_close(&j->g);
}

static resolve_options resolve_options_of(const options *o)
{
    resolve_options r = {.view_layer = o->view_layer};
    for (int i = 0; i < ROLE_COUNT; i++) r.names[i] = o->role_names[i];
    if (o->depth_kind) r.depth = depth_named(o->depth_kind);
    if (o->albedo_kind) r.albedo = strcmp(o->albedo_kind, "base") == 0 ? ALBEDO_BASE : ALBEDO_DIFFUSE;
    return r;
}

// The channels that will be looked at; with --keep all, every one of them, for they are written again.
static void want_channels(const job *j, exrio_file *file, const resolution *r, const plan *what)
{
    for (int p = 0; !j->o->keep_none && p < file->part_count; p++)
        for (int c = 0; !file->parts[p].deep && !output_keeps_chunks(j->o, file, p, what) && c < file->parts[p].channel_count;
             c++)
            file->parts[p].channels[c].wanted = true;
    for (int i = 0; i < ROLE_COUNT; i++)
        for (int k = 0; k < r->components[i]; k++) {
            channel_ref ref = r->channels[i][k];
            if (ref.part >= 0) file->parts[ref.part].channels[ref.channel].wanted = true;
        }
}

bool frame_read(const job *j, const char *input, frame_result *r, error *e) { return frame_read_files(j, &input, 1, r, e); }

// One view's channels, and what will be made of them.
static bool resolve_view(const job *j, frame_result *r, error *e)
{
    resolve_options ro = resolve_options_of(j->o);
    char layer[128];
    ro.view = r->view;
    ro.view_layer = view_layer_within(j->o, r->view, layer, sizeof layer);
    if (!resolve_channels(r->file, &ro, &r->resolution, j->log, e) ||
        !plan_make(j->o, r->file, &r->resolution, &r->plan, j->log, e) ||
        !output_check_names(j->o, r->file, r->view, &r->plan, e))
        return false;
    want_channels(j, r->file, &r->resolution, &r->plan);
    return !r->plan.from_sh || relight_want(j->o, r->file, r->view, e);
}

// The albedo as linear light; the channels pass through as they are. Beauty and emission are rendered light: linear already.
static bool convert_albedo(const job *j, frame_result *r, error *e)
{
    if (!j->o->albedo_colorspace || !r->gb.albedo) return true;
    size_t n = (size_t)r->gb.width * (size_t)r->gb.height;
    float *rgb = mem_pixels(n, 3 * sizeof *rgb, e), *albedo = r->gb.albedo;
    if (!rgb) return false;
    for (size_t i = 0; i < n; i++) memcpy(rgb + 3 * i, albedo + 4 * i, 3 * sizeof *rgb);
    bool ok = colour_to_scene_linear(j->o->ocio, j->o->albedo_colorspace, rgb, n, e);
    for (size_t i = 0; ok && i < 3 * n; i++) albedo[i / 3 * 4 + i % 3] = isfinite(rgb[i]) && rgb[i] > 0.0f ? rgb[i] : 0.0f;
    free(rgb);
    if (ok) log_info(j->log, "albedo: converted from %s to scene linear", j->o->albedo_colorspace);
    return ok;
}

static pass_space normal_space_of(const options *o)
{
    if (!o->normal_space) return SPACE_UNKNOWN;
    return strcmp(o->normal_space, "world") == 0 ? SPACE_WORLD : SPACE_CAMERA;
}

static bool check_doubt(const job *j, const frame_result *r, error *e)
{
    const char *doubtful = gbuffer_doubt(&r->gb);
    if (!j->o->strict || j->o->explain || !doubtful) return true;
    return err_set(e, ERR_DOUBT, r->file->path, NULL,
                   "it is doubtful what the %s pass means, as the warning says, and --strict forbids to go on; --explain shows "
                   "every reading that was tried",
                   doubtful);
}

static bool build_view(const job *j, frame_result *r, error *e)
{
    gbuffer_options g = {.need = r->plan.need,
                         .camera_file = j->o->camera_file,
                         .fov = j->o->fov,
                         .ortho = j->o->ortho,
                         .threads = j->threads,
                         .normal_space = normal_space_of(j->o),
                         .normal_encoding = j->o->normal_encoding,
                         .depth_near = j->o->depth_range[0],
                         .depth_far = j->o->depth_range[1]};
    if (r->view) log_info(j->log, "view %s:", r->view);
    return gbuffer_build(r->file, &r->resolution, &g, &r->gb, j->log, e) && check_doubt(j, r, e) && convert_albedo(j, r, e) &&
           (!r->plan.from_sh || relight_load(j->o, r->file, r->view, &r->gb, r->relight_sh, e));
}

// The first view is *r itself; the others are appended.
static bool list_views(const job *j, frame_result *r, error *e)
{
    const char *names[VIEWS_MAX];
    int count = views_of(r->file, j->o, names);
    if (count > 0) r->view = names[0];
    for (int i = 1; i < count; i++, r = r->next_view) {
        r->next_view = mem_zero(1, sizeof *r, e);
        if (!r->next_view) return false;
        r->next_view->file = r->file;
        r->next_view->view = names[i];
    }
    return true;
}

static int larger_side(const frame_result *r)
{
    const box2 w = r->file->parts[r->resolution.main_part].data_window;
    return box2_width(w) > box2_height(w) ? box2_width(w) : box2_height(w);
}

// Refuses, before any pixel is read, a frame that the memory cannot hold. The bytes a pixel are the peak measured with 13
// channels and four layers, images of a software renderer included; the rounds of --error keep another 40.
static bool fits_memory(const job *j, const frame_result *r, error *e)
{
    const double bytes = j->o->error > 0.0 ? 270.0 : 230.0, gib = 1024.0 * 1024.0 * 1024.0;
    const box2 w = r->file->parts[r->resolution.main_part].data_window;
    double needed = bytes * box2_width(w) * box2_height(w), available = (double)mem_available();
    if (needed <= available) return true;
    return err_set(
        e, ERR_MEMORY, r->file->path, NULL,
        "%d x %d pixels need about %.1f GiB and this machine has %.1f GiB free; cut the frame into parts (oiiotool --cut) "
        "and filter those",
        box2_width(w), box2_height(w), needed / gib, available / gib);
}

// The same for the device.
static bool fits_device(const job *j, const frame_result *r, error *e)
{
    const box2 w = r->file->parts[r->resolution.main_part].data_window;
    if (j->g.max_size <= 0 || larger_side(r) <= j->g.max_size) return true;
    return err_set(
        e, ERR_GL, r->file->path, NULL,
        "%d x %d pixels are more than this GL device's %d a side; cut the frame into parts (oiiotool --cut) and filter those",
        box2_width(w), box2_height(w), j->g.max_size);
}

// The headers, and what will be made of them.
static bool begin_reading(const job *j, const char *const *inputs, int count, frame_result *r, error *e)
{
    *r = (frame_result){0};
    stopwatch t = stopwatch_start();
    bool ok = exrio_file_open_all(inputs, count, &r->file, e) && list_views(j, r, e);
    for (frame_result *v = r; ok && v; v = v->next_view) ok = resolve_view(j, v, e);
    lap(r, STAGE_READ, &t);
    return ok && fits_memory(j, r, e);
}

static bool finish_reading(const job *j, frame_result *r, error *e)
{
    stopwatch t = stopwatch_start();
    bool ok = exrio_file_load(r->file, j->threads, e);
    lap(r, STAGE_READ, &t);
    for (frame_result *v = r; ok && v; v = v->next_view) ok = build_view(j, v, e);
    lap(r, STAGE_RESOLVE, &t);
    return ok;
}

bool frame_read_files(const job *j, const char *const *inputs, int count, frame_result *r, error *e)
{
    return begin_reading(j, inputs, count, r, e) && fits_device(j, r, e) && finish_reading(j, r, e);
}

typedef struct reading {
    const job *j;
    frame_result *r;
    error e;
    bool ok;
} reading;

static void *read_beside(void *arg)
{
    reading *d = arg;
    d->ok = finish_reading(d->j, d->r, &d->e) && frame_prepare(d->j, d->r, &d->e);
    return NULL;
}

// Any GL 4.5 device takes images of 16384 a side; what is larger waits for the device's own word.
static bool read_and_open(job *j, const char *const *inputs, int count, frame_result *r, error *e)
{
    enum { SURE = 16384 };
    reading d = {.j = j, .r = r};
    pthread_t thread;
    if (!begin_reading(j, inputs, count, r, e)) return false;
    bool beside = larger_side(r) <= SURE && pthread_create(&thread, NULL, read_beside, &d) == 0;
    bool opened = open_device(j, e);
    if (beside) pthread_join(thread, NULL);
    if (opened && !beside) return fits_device(j, r, e) && finish_reading(j, r, e);
    if (opened && !d.ok) *e = d.e;
    return opened && d.ok;
}

// What the rooms below have not said themselves: channels, camera and measurements are theirs.
static void describe(const job *j, const frame_result *r)
{
    log_info(j->log, "surfaces: %zu of %zu pixels", r->gb.valid, (size_t)r->gb.width * (size_t)r->gb.height);
    log_info(j->log, "radius: %g scene units%s; thickness %g", r->set.radius, j->o->radius_unit == RADIUS_AUTO ? " (auto)" : "",
             r->set.thickness);
}

// The environment is prepared with the first frame, because its default up axis is the renderer's.
static bool prepare_light(job *j, const frame_result *r, error *e)
{
    double primaries[8];
    if (!r->plan.light || j->env_loaded) return true;
    env_options eo = {.path = j->o->env,
                      .up_z = settings_up_z(j, r),
                      .rotate_degrees = j->o->env_rotate,
                      .scale = j->o->env_scale,
                      .threads = j->threads,
                      .colorspace = j->o->env_colorspace,
                      .primaries = exrio_attr_chromaticities(r->file, r->resolution.main_part, primaries) ? primaries : NULL,
                      .ocio = j->o->ocio};
    if (!environment_load(&eo, &j->env, j->log, e)) return false;
    j->env_loaded = true;
    if (!j->o->env) log_warn(j->log, "white", "no --env: radiance is that of a white environment of radiance 1");
    return pass_upload_environment(&j->g, &j->env, &j->env_image, e);
}

static bool check_world(const job *j, const frame_result *r, error *e)
{
    bool camera_frame = strcmp(j->o->env_frame, "camera") == 0;
    if (!j->o->env || !r->plan.light || camera_frame || r->gb.camera.has_rotation || r->gb.valid == 0) return true;
    return err_set(e, ERR_INPUT, r->file->path, NULL,
                   "--env needs world directions, and this frame's camera rotation is unknown; use --env-frame camera, --camera "
                   "FILE or, if the normals are in world space, --normal-space world");
}

// The frame's own spheres. Only a world camera can place them.
static bool load_proxies(const job *j, frame_result *r, error *e)
{
    char path[4096];
    if (!j->o->proxies) return true;
    if (!r->gb.camera.has_world && r->gb.valid > 0)
        return err_set(e, ERR_INPUT, r->file->path, NULL,
                       "--proxies are in world space, and this frame's camera is not known there; give it with --camera FILE");
    bool many = false;
    if (!proxies_are_framed(j->o, &many, e)) return false;
    if (many && !pattern_path(j->o->proxies, r->frame, path, sizeof path))
        return err_set(e, ERR_USAGE, j->o->proxies, NULL, "--proxies: frame %d has no file name by this pattern", r->frame);
    return proxies_load(many ? path : j->o->proxies, &r->proxies, e);
}

static bool prepare_view(const job *j, frame_result *r, double radius, error *e)
{
    if (r->gb.valid == 0) log_warn(j->log, "empty", "%s: no pixel has a surface; the layers are neutral", r->file->path);
    r->set = settings_of(j, r, radius);
    describe(j, r);
    return frame_check_scale(r, e) && check_world(j, r, e) && load_proxies(j, r, e) && filter_prepare(j, r, e);
}

bool frame_prepare(const job *j, frame_result *r, error *e)
{
    if (r->prepared) return true;
    stopwatch t = stopwatch_start();
    double radius = settings_radius(j, &r->gb);
    bool ok = true;
    for (frame_result *v = r; ok && v; v = v->next_view) {
        v->frame = r->frame;
        ok = prepare_view(j, v, radius, e);
    }
    lap(r, STAGE_RESOLVE, &t);
    return ok;
}

bool frame_begin(job *j, frame_result *r, error *e)
{
    for (frame_result *v = r; v; v = v->next_view)
        if (!prepare_light(j, v, e) || !filter_begin(j, v, e)) return false;
    return true;
}

bool frame_is_under_way(const frame_result *r)
{
    for (; r; r = r->next_view)
        if (r->band_count > 0) return true;
    return false;
}

bool frame_wait(job *j, frame_result *r, error *e)
{
    stopwatch t = stopwatch_start();
    for (frame_result *v = r; v; v = v->next_view)
        if (!read_back_wait(j, v, e)) return false;
    lap(r, STAGE_READ_BACK, &t);
    return true;
}

bool frame_convert(const job *j, frame_result *r, error *e)
{
    for (frame_result *v = r; v; v = v->next_view)
        if (!read_back_convert(j, v, e)) return false;
    return true;
}

bool frame_filter(job *j, frame_result *r, error *e)
{
    if (!frame_prepare(j, r, e)) return false;
    for (frame_result *v = r; v; v = v->next_view)
        if (!prepare_light(j, v, e) || !filter_frame(j, v, e)) return false;
    return true;
}

bool frame_write(const job *j, frame_result *r, const char *output, error *e)
{
    stopwatch t = stopwatch_start();
    if (!record_check(&r->record, e) || !output_write(j, r, output, e)) return false;
    lap(r, STAGE_WRITE, &t);
    if (r->clamped)
        log_warn(j->log, "clamped", "%zu samples were beyond what half can hold and were clamped; --float keeps them",
                 r->clamped);
    return true;
}

bool frame_run(job *j, const char *input, const char *output, frame_result *r, error *e)
{
    return frame_run_files(j, &input, 1, output, NULL, r, e);
}

bool frame_run_files(job *j, const char *const *inputs, int count, const char *output, const frame_record *record,
                     frame_result *r, error *e)
{
    *r = (frame_result){0};
    if (!(j->g.context ? frame_read_files(j, inputs, count, r, e) : read_and_open(j, inputs, count, r, e))) return false;
    if (record) r->record = *record;
    progress_step(j->progress);
    if (job_stopped(j) || !frame_filter(j, r, e)) return false;
    progress_step(j->progress);
    if (!frame_write(j, r, output, e)) return false;
    progress_step(j->progress);
    progress_finish(j->progress, 0);
    return true;
}

bool frame_measure_radius(const job *j, const char *const *inputs, int count, double *radius, error *e)
{
    frame_result r;
    bool ok = frame_read_files(j, inputs, count, &r, e);
    if (ok) *radius = gbuffer_auto_radius(&r.gb);
    frame_free(&r);
    return ok;
}

static void free_view(frame_result *r)
{
    for (int i = 0; i < LAYER_COUNT; i++) {
        free(r->layers[i]);
        for (int k = 0; k < LAYER_CHANNELS; k++) free(r->samples[i][k]);
    }
    read_back_drop(r);
    gbuffer_free(&r->half);
    for (int k = 0; k < SH_IMAGES; k++) free(r->relight_sh[k]);
    proxies_free(&r->proxies);
    gbuffer_free(&r->gb);
}

void frame_free(frame_result *r)
{
    for (frame_result *v = r->next_view, *next; v; v = next) {
        next = v->next_view;
        free_view(v);
        free(v);
    }
    free_view(r);
    exrio_file_close(r->file);
    *r = (frame_result){0};
}
