#include "pipeline/frame.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/mem.h"
#include "base/threads.h"
#include "cli/frames.h"
#include "exr/write.h"
#include "gbuffer/conventions.h"
#include "gbuffer/depth_code.h"
#include "pipeline/filter.h"
#include "pipeline/output.h"
#include "pipeline/stored.h"
#include "pipeline/views.h"
#include "plugin/colour.h"

typedef struct stopwatch {
    double wall, cpu;
} stopwatch;

static stopwatch read_clocks(void)
{
    struct timespec w, c;
    clock_gettime(CLOCK_MONOTONIC, &w);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &c);
    return (stopwatch){(double)w.tv_sec * 1e3 + (double)w.tv_nsec * 1e-6, (double)c.tv_sec * 1e3 + (double)c.tv_nsec * 1e-6};
}

static void lap(frame_result *r, stage s, stopwatch *since)
{
    stopwatch t = read_clocks();
    r->wall_ms[s] += t.wall - since->wall;
    r->cpu_ms[s] += t.cpu - since->cpu;
    *since = t;
}

void job_init(job *j, const options *o, log_t *log)
{
    *j = (job){.o = o, .log = log, .threads = o->threads > 0 ? o->threads : threads_default()};
    gpu_set_up();
}

bool job_open(job *j, const options *o, log_t *log, error *e)
{
    job_init(j, o, log);
    if (!colour_config(o->ocio))
        log_info(log, "colour: no OpenColorIO config, so beauty, albedo and environment count as linear");
    return gpu_open(&j->g, o->device, log, e);
}

bool job_stopped(const job *j) { return j->stop && *j->stop; }

void job_close(job *j)
{
    gpu_image_free(&j->env_image);
    gpu_image_free(&j->sunless.map);
    trace_scene_close(&j->trace);
    if (j->env_loaded) environment_free(&j->env);
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
static void want_channels(const job *j, exr_file *file, const resolution *r, const plan *what)
{
    for (int p = 0; !j->o->keep_none && p < file->part_count; p++)
        for (int c = 0; !output_keeps_chunks(j->o, file, p, what) && c < file->parts[p].channel_count; c++)
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
    return !r->plan.from_sh || stored_sh_want(j->o, r->file, r->view, e);
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
    return gbuffer_build(r->file, &r->resolution, &g, &r->gb, j->log, e) && convert_albedo(j, r, e) &&
           (!r->plan.from_sh || stored_sh_load(j->o, r->file, r->view, &r->gb, r->stored_sh, e));
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
    stopwatch t = read_clocks();
    bool ok = exr_file_open_all(inputs, count, &r->file, e) && list_views(j, r, e);
    for (frame_result *v = r; ok && v; v = v->next_view) ok = resolve_view(j, v, e);
    lap(r, STAGE_READ, &t);
    return ok && fits_memory(j, r, e);
}

static bool finish_reading(const job *j, frame_result *r, error *e)
{
    stopwatch t = read_clocks();
    bool ok = exr_file_load(r->file, j->threads, e);
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
    d->ok = finish_reading(d->j, d->r, &d->e);
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
    bool opened = gpu_open(&j->g, j->o->device, j->log, e);
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
    for (int i = 0; i < r->plan.step_count; i++)
        log_info(j->log, "pass %s: %s (%s)", r->plan.steps[i].pass, r->plan.steps[i].runs ? "runs" : "does not run",
                 r->plan.steps[i].why);
}

static bool env_up_z(const job *j, const frame_result *r) { return j->o->env_up ? j->o->env_up == 'z' : r->resolution.up_is_z; }

// The environment is prepared with the first frame, because its default up axis is the renderer's.
static bool prepare_light(job *j, const frame_result *r, error *e)
{
    double primaries[8];
    if (!r->plan.light || j->env_loaded) return true;
    env_options eo = {.path = j->o->env,
                      .up_z = env_up_z(j, r),
                      .rotate_degrees = j->o->env_rotate,
                      .scale = j->o->env_scale,
                      .threads = j->threads,
                      .colorspace = j->o->env_colorspace,
                      .primaries = exr_attr_chromaticities(r->file, r->resolution.main_part, primaries) ? primaries : NULL,
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

static double radius_of(const job *j, const gbuffer *gb)
{
    const options *o = j->o;
    if (o->radius_unit == RADIUS_WORLD) return o->radius;
    if (o->radius_unit == RADIUS_AUTO) return j->shot_radius > 0.0 ? j->shot_radius : gbuffer_auto_radius(gb);
    // Pixels are turned into one world distance at the frame's median depth, so that the radius is the same on all surfaces.
    double per_unit = gb->camera.fx;
    return gb->camera.kind == CAMERA_ORTHOGRAPHIC ? o->radius / per_unit : o->radius * frame_median_depth(gb) / per_unit;
}

static int by_value(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// Of at most a few thousand evenly spaced surfaces: enough for a scale.
double frame_median_depth(const gbuffer *gb)
{
    enum { MOST = 4096 };
    float depths[MOST];
    int n = 0;
    size_t count = (size_t)gb->width * (size_t)gb->height, stride = gb->valid / MOST + 1, seen = 0;
    for (size_t i = 0; i < count && n < MOST; i++)
        if (gb->depth[i] > 0.0f && seen++ % stride == 0) depths[n++] = gb->depth[i];
    if (n == 0) return 1.0;
    qsort(depths, (size_t)n, sizeof *depths, by_value);
    return depths[n / 2];
}

// The world the environment is fixed to: the scene's, or one that moves with the camera, its up axis up in the picture and the
// camera looking along +y (z up) or -z (y up).
static mat3 world_from_camera(const job *j, const frame_result *r)
{
    static const mat3 up_z = {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}}, up_y = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    if (strcmp(j->o->env_frame, "camera") == 0) return env_up_z(j, r) ? up_z : up_y;
    return r->gb.camera.has_rotation ? r->gb.camera.world_from_camera : m3_identity();
}

// composite.comp: 1 the beauty, 2 the environment, 0 nothing.
static int background_of(bool beauty, bool sky) { return beauty ? 1 : sky ? 2 : 0; }

// A quarter of the method's own samples for a draft (and of the pixels, settings_of), four times as many for high quality.
static int samples_at(const method *m, int quality)
{
    return quality < 0 ? m->samples / 4 : quality > 0 ? m->samples * 4 : m->samples;
}

static pass_settings settings_of(const job *j, const frame_result *r, double radius)
{
    const options *o = j->o;
    const method *m = r->plan.method;
    double share = o->thickness < 0.0 ? m->thickness : o->thickness;
    bool beauty = r->resolution.components[ROLE_BEAUTY] > 0, alpha = r->resolution.components[ROLE_ALPHA] > 0;
    return (pass_settings){
        .radius = radius,
        .thickness = share * radius,
        .thickness_fixed = o->thickness >= 0.0,
        .planes = !o->no_planes,
        .half =
            (o->half < 0 ? o->quality < 0 : o->half) && !r->plan.from_sh && o->error <= 0.0, // stored layers are whole already
        .samples = o->samples > 0 && o->error <= 0.0 ? o->samples : samples_at(m, o->error > 0.0 ? 0 : o->quality),
        .error = o->error,
        .most_samples = o->samples > 0 ? o->samples : ROUNDS_MOST_SAMPLES,
        .angle_bias = o->angle_bias,
        .sh_bands = o->sh_bands,
        .sh_sigma = o->sh_sigma,
        .blur = o->blur < 0 ? m->blur : o->blur,
        .scale = o->scale,
        .contrast = o->contrast,
        .env_level = o->env_lod,
        .bounce_strength = o->bounce_strength,
        .vpl_count = o->vpl_count,
        .world_from_camera = world_from_camera(j, r),
        .mesh = o->mesh,
        .trace = o->trace,
        .mesh_axes = o->mesh_axes,
        .amount = o->amount,
        .depthmask_strength = o->depthmask_strength,
        .multiply_all = strcmp(o->multiply, "all") == 0,
        .visibility_mode = r->plan.visibility_mode,
        .base_albedo = r->resolution.albedo == ALBEDO_BASE,
        .averaged_albedo = convention_named(r->resolution.convention)->normals_averaged,
        // With an alpha the picture is premultiplied, and the environment is not part of it.
        .background = background_of(beauty, o->env && !alpha),
        .relight = r->plan.relight,
        .bounce_in_composite = r->plan.bounce_in_composite,
    };
}

// The frame's own spheres. Only a world camera can place them.
static bool load_proxies(const job *j, frame_result *r, error *e)
{
    char path[4096];
    if (!j->o->proxies) return true;
    if (!r->gb.camera.has_world && r->gb.valid > 0)
        return err_set(e, ERR_INPUT, r->file->path, NULL,
                       "--proxies are in world space, and this frame's camera is not known there; give it with --camera FILE");
    bool many = proxies_are_framed(j->o);
    if (many && !pattern_path(j->o->proxies, r->frame, path, sizeof path))
        return err_set(e, ERR_USAGE, j->o->proxies, NULL, "--proxies: frame %d has no file name by this pattern", r->frame);
    return proxies_load(many ? path : j->o->proxies, &r->proxies, e);
}

static bool filter_view(job *j, frame_result *r, double radius, error *e)
{
    if (r->gb.valid == 0) log_warn(j->log, "empty", "%s: no pixel has a surface; the layers are neutral", r->file->path);
    r->set = settings_of(j, r, radius);
    describe(j, r);
    return check_world(j, r, e) && load_proxies(j, r, e) && prepare_light(j, r, e) && filter_frame(j, r, e);
}

bool frame_filter(job *j, frame_result *r, error *e)
{
    double radius = radius_of(j, &r->gb);
    for (frame_result *v = r; v; v = v->next_view) {
        v->frame = r->frame;
        if (!filter_view(j, v, radius, e)) return false;
    }
    return true;
}

bool frame_write(const job *j, frame_result *r, const char *output, error *e)
{
    stopwatch t = read_clocks();
    if (!output_write(j, r, output, e)) return false;
    lap(r, STAGE_WRITE, &t);
    if (r->clamped)
        log_warn(j->log, "clamped", "%zu samples were beyond what half can hold and were clamped; --float keeps them",
                 r->clamped);
    return true;
}

bool frame_run(job *j, const char *input, const char *output, frame_result *r, error *e)
{
    return frame_run_files(j, &input, 1, output, r, e);
}

bool frame_run_files(job *j, const char *const *inputs, int count, const char *output, frame_result *r, error *e)
{
    *r = (frame_result){0};
    if (!(j->g.context ? frame_read_files(j, inputs, count, r, e) : read_and_open(j, inputs, count, r, e))) return false;
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
    for (int k = 0; k < SH_IMAGES; k++) free(r->stored_sh[k]);
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
    exr_file_close(r->file);
    *r = (frame_result){0};
}
