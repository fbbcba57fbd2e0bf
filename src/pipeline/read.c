#include "pipeline/read.h"
#include "pipeline/outside_fit.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/threads.h"
#include "pipeline/output_names.h"
#include "pipeline/prepare.h"
#include "pipeline/relight.h"
#include "pipeline/views.h"
#include "plugin/colour.h"

static resolve_options resolve_options_of(const options *o)
{
    resolve_options r = {.view_layer = o->view_layer, .depth = o->depth_kind, .albedo = o->albedo_kind};
    for (int i = 0; i < ROLE_COUNT; i++) r.names[i] = o->role_names[i];
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
    if (j->is_shot) r->plan.need_to_fit = 0; // the shot's outside is known
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

static bool check_doubt(const job *j, const frame_result *r, error *e)
{
    const char *doubtful = gbuffer_doubt(&r->gb);
    if (!j->o->strict || j->o->explain || !doubtful) return true;
    return err_set(e, ERR_DOUBT, r->file->path, NULL,
                   "it is doubtful what the %s pass means, as the warning says, and --strict forbids to go on; --explain shows "
                   "every reading that was tried",
                   doubtful);
}

static gbuffer_options gbuffer_options_of(const job *j, unsigned need)
{
    return (gbuffer_options){.need = need,
                             .camera_file = j->o->camera_file,
                             .fov = j->o->fov,
                             .ortho = j->o->ortho,
                             .threads = j->threads,
                             .normal_space = j->o->normal_space,
                             .encoding_told = j->o->normal_encoding != NORMAL_AUTO,
                             .normal_encoding = j->o->normal_encoding,
                             .depth_near = j->o->depth_range[0],
                             .depth_far = j->o->depth_range[1]};
}

static bool build_view(const job *j, frame_result *r, error *e)
{
    const gbuffer_options g = gbuffer_options_of(j, r->plan.need | r->plan.need_to_fit);
    if (r->view) log_info(j->log, "view %s:", r->view);
    return gbuffer_build(r->file, &r->resolution, &g, &r->gb, j->log, e) && check_doubt(j, r, e) && convert_albedo(j, r, e) &&
           (!r->plan.from_sh || relight_load(j->o, r->file, r->view, &r->gb, r->relight_sh, e)) && outside_fit_gather(j, r, e);
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
// channels and four layers, images of a software renderer included; the rounds of --error keep another 20, and the picture's own
// light for the outside's fit 50.
static bool fits_memory(const job *j, const frame_result *r, error *e)
{
    const double bytes = r->plan.need_to_fit ? 340.0 : j->o->error > 0.0 ? 310.0 : 290.0, gib = 1024.0 * 1024.0 * 1024.0;
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
    result_lap(r, STAGE_READ, &t);
    return ok && fits_memory(j, r, e);
}

static bool finish_reading(const job *j, frame_result *r, error *e)
{
    stopwatch t = stopwatch_start();
    bool ok = exrio_file_load(r->file, j->threads, e);
    result_lap(r, STAGE_READ, &t);
    for (frame_result *v = r; ok && v; v = v->next_view) ok = build_view(j, v, e);
    result_lap(r, STAGE_RESOLVE, &t);
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
bool read_and_open(job *j, const char *const *inputs, int count, frame_result *r, error *e)
{
    enum { SURE = 16384 };
    reading d = {.j = j, .r = r};
    pthread_t thread;
    if (j->g.context) return frame_read_files(j, inputs, count, r, e);
    if (!begin_reading(j, inputs, count, r, e)) return false;
    bool beside =
        larger_side(r) <= SURE && threads_start_beside_loading(NULL) && pthread_create(&thread, NULL, read_beside, &d) == 0;
    bool opened = job_open_device(j, e);
    if (beside) pthread_join(thread, NULL);
    if (opened && !beside) return fits_device(j, r, e) && finish_reading(j, r, e);
    if (opened && !d.ok) *e = d.e;
    return opened && d.ok;
}

static bool load_world_view(const job *j, exrio_file *file, const resolve_options *ro, const gbuffer_options *g, size_t most,
                            world_view *out, error *e)
{
    resolution r;
    bool ok = resolve_channels(file, ro, &r, j->log, e);
    for (int i = 0; ok && i < ROLE_COUNT; i++)
        for (int k = 0; k < r.components[i]; k++)
            if ((i == ROLE_POSITION || i == ROLE_NORMAL || i == ROLE_DEPTH || (i == ROLE_ALBEDO && j->o->env)) &&
                r.channels[i][k].part >= 0)
                file->parts[r.channels[i][k].part].channels[r.channels[i][k].channel].wanted = true;
    return ok && exrio_file_load(file, j->threads, e) && world_view_read(file, &r, g, most, out, j->log, e);
}

bool read_world_view(const job *j, const char *path, size_t most, world_view *out, error *e)
{
    const gbuffer_options g = {.threads = j->threads};
    exrio_file *file = NULL;
    bool ok = exrio_file_open(path, &file, e) && load_world_view(j, file, &(resolve_options){0}, &g, most, out, e);
    exrio_file_close(file);
    return ok;
}

bool read_shot_view(const job *j, const char *const *paths, int count, size_t most, world_view *out, error *e)
{
    const gbuffer_options g = gbuffer_options_of(j, 0);
    resolve_options ro = resolve_options_of(j->o);
    const char *names[VIEWS_MAX];
    char layer[128];
    exrio_file *file = NULL;
    bool ok = exrio_file_open_all(paths, count, &file, e);
    if (ok) {
        ro.view = views_of(file, j->o, names) > 0 ? names[0] : NULL;
        ro.view_layer = view_layer_within(j->o, ro.view, layer, sizeof layer);
        ok = load_world_view(j, file, &ro, &g, most, out, e);
    }
    exrio_file_close(file);
    return ok;
}
