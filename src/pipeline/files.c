#include "pipeline/files.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/digest.h"
#include "base/infile.h"
#include "base/mem.h"
#include "base/outfile.h"
#include "cli/frames.h"
#include "exr/file.h"
#include "gbuffer/mesh.h"
#include "pipeline/inputs.h"
#include "plugin/colour.h"

// --- the table ---

bool proxies_are_framed(const options *o, bool *framed, error *e)
{
    bool there = true;
    if (o->proxies && pattern_is(o->proxies) &&
        !infile_exists(o->proxies, (infile_kind){"the proxies file", ERR_USAGE}, &there, e))
        return false;
    *framed = !there;
    return true;
}

static bool add(run_files *f, run_file file, error *e)
{
    if (!file.path) return true;
    run_file *grown = mem_grow(f->list, (size_t)f->count + 1, sizeof *grown, e);
    if (!grown) return false;
    f->list = grown;
    if (!file.every) file.every = 1;
    f->list[f->count++] = file;
    return true;
}

static bool add_materials(const options *o, run_files *f, error *e)
{
    error ignored = {0};
    if (!o->mesh || !mesh_list_libraries(o->mesh, &f->owned, &f->owned_count, &ignored)) {
        if (ignored.refused || ignored.code == ERR_MEMORY) *e = ignored;
        return !ignored.refused && ignored.code != ERR_MEMORY;
    }
    for (int i = 0; i < f->owned_count; i++)
        if (!add(f, (run_file){.what = "a material file of --mesh", .path = f->owned[i], .decides = true, .once = true}, e))
            return false;
    return true;
}

// The frames of the shot that serve all others.
static bool add_shot(const options *o, run_files *f, error *e)
{
    char path[FILE_PATH];
    if (o->surround != SURROUND_SHOT) return true;
    if (!shot_frames(o, &f->shot, e)) return false;
    for (int i = 0; i < f->shot.count; i++)
        for (int k = 0; k < o->input_count; k++) {
            if (!pattern_is(o->inputs[k])) continue;
            if (!pattern_path(o->inputs[k], f->shot.frames[i], path, sizeof path)) continue; // reading the frame says so
            char **grown = mem_grow(f->owned, (size_t)f->owned_count + 1, sizeof *grown, e);
            if (!grown) return false;
            f->owned = grown;
            if (!(grown[f->owned_count] = strdup(path))) return err_set(e, ERR_MEMORY, NULL, NULL, "out of memory");
            const char *mine = grown[f->owned_count++];
            if (!add(f, (run_file){.what = "--surround shot", .path = mine, .decides = true, .once = true}, e)) return false;
        }
    return true;
}

bool run_files_list(const options *o, run_files *out, error *e)
{
    bool framed = false, many = inputs_are_framed(o), converts = o->env_colorspace || o->albedo_colorspace;
    *out = (run_files){0};
    if (!proxies_are_framed(o, &framed, e)) return false;
    const run_file others[] = {
        {.what = "--env", .path = o->env, .decides = true, .once = true},
        {.what = "--beauty-env", .path = o->beauty_env, .decides = true, .once = true},
        {.what = "--camera", .path = o->camera_file, .decides = true},
        {.what = "--proxies", .path = o->proxies, .decides = true, .framed = framed},
        {.what = "--mesh", .path = o->mesh, .decides = true, .once = true},
        {.what = "the OpenColorIO config",
         .path = colour_config(o->ocio),
         .kind = FILE_COLOURS,
         .decides = converts,
         .once = true},
        {.what = "the output", .path = o->output, .kind = FILE_OUTPUT, .framed = many},
        {.what = "the preview", .path = o->preview, .kind = FILE_PREVIEW, .framed = many, .every = many ? o->preview_every : 1},
        {.what = "the report", .path = o->report, .kind = FILE_REPORT, .framed = many && o->report && pattern_is(o->report)},
    };
    bool ok = true;
    for (int i = 0; ok && i < o->input_count; i++) {
        const run_file input = {
            .what = "the input", .path = o->inputs[i], .framed = many && pattern_is(o->inputs[i]), .decides = true};
        ok = add(out, input, e);
    }
    for (size_t i = 0; ok && i < sizeof others / sizeof *others; i++) ok = add(out, others[i], e);
    for (int i = 0; ok && i < o->also.count; i++)
        ok = add(out, (run_file){.what = "--also", .path = o->also.path[i], .decides = true, .once = true}, e);
    ok = ok && add_materials(o, out, e) && add_shot(o, out, e);
    if (!ok) run_files_free(out);
    return ok;
}

// The tables that a config names decide as well as its own text.
static void add_conversions(run_file *f, const options *o, error *e)
{
    struct {
        bool wanted;
        const char *from;
    } conversions[] = {
        {o->env_colorspace, o->env_colorspace}, {o->albedo_colorspace, o->albedo_colorspace}, {o->preview != NULL, NULL}};
    char text[3 * COLOUR_IDENTITY] = "";
    for (size_t i = 0; i < sizeof conversions / sizeof *conversions; i++)
        if (conversions[i].wanted &&
            !colour_identity(o->ocio, conversions[i].from, o->display, o->view, text + i * COLOUR_IDENTITY, e))
            return;
    digest all[2] = {f->content.sampled, digest_bytes(text, sizeof text)};
    f->content.sampled = digest_bytes(all, sizeof all);
    all[0] = f->content.exact;
    f->content.exact = digest_bytes(all, sizeof all);
}

bool run_files_read(run_files *files, const options *o, error *e)
{
    for (int i = 0; i < files->count; i++) {
        run_file *f = &files->list[i];
        if (!f->once) continue;
        f->known = true;
        bool read = content_read(f->path, exrio_head_bytes, o->skip_exact, &f->content, &f->refusal);
        if (read && f->kind == FILE_COLOURS) add_conversions(f, o, &f->refusal);
        if (f->refusal.code == ERR_MEMORY) {
            *e = f->refusal;
            return false;
        }
    }
    return true;
}

void run_files_free(run_files *files)
{
    for (int i = 0; i < files->owned_count; i++) free(files->owned[i]);
    free(files->owned);
    frames_free(&files->shot);
    free(files->list);
    *files = (run_files){0};
}

bool run_file_path(const run_file *file, int frame, char *path, size_t size)
{
    if (frame % file->every != 0) return false;
    if (file->framed) return pattern_path(file->path, frame, path, size);
    return (size_t)snprintf(path, size, "%s", file->path) < size;
}

// --- which are the same ---

// An existing file is its device and inode; one that is still to be made is its folder and its name there.
typedef struct identity {
    uint64_t device, inode;
    digest name; // zero for a file that exists
    int file, frame;
} identity;

// An answer that the system does not give is no licence to write.
static bool look(const char *path, struct stat *s, bool *there, error_code code, error *e)
{
    *there = stat(path, s) == 0;
    return *there || errno == ENOENT || errno == ENOTDIR || err_set_system(e, code, errno, path, "cannot be looked at");
}

// Of a file that is still to be made.
static bool identify_new(const char *target, identity *id, error_code code, error *e)
{
    struct stat s;
    bool there;
    char folder[FILE_PATH] = ".";
    const char *slash = strrchr(target, '/'), *name = slash ? slash + 1 : target;
    if (slash) snprintf(folder, sizeof folder, "%.*s", (int)(slash - target) + 1, target);
    if (!look(folder, &s, &there, code, e)) return false;
    if (there)
        *id = (identity){.device = s.st_dev, .inode = s.st_ino};
    else
        name = target;
    id->name = digest_bytes(name, strlen(name));
    return true;
}

static bool identify(const char *path, identity *id, error_code code, error *e)
{
    struct stat s;
    bool there;
    if (!look(path, &s, &there, code, e)) return false;
    if (there) {
        *id = (identity){.device = s.st_dev, .inode = s.st_ino};
        return true;
    }
    char *target = outfile_target(path, e); // a link may point at what will be made under another name
    bool ok = target && identify_new(target, id, code, e);
    free(target);
    return ok;
}

static int compare(const identity *x, const identity *y)
{
    if (x->device != y->device) return x->device < y->device ? -1 : 1;
    if (x->inode != y->inode) return x->inode < y->inode ? -1 : 1;
    return memcmp(&x->name, &y->name, sizeof x->name);
}

// Of equal files the order of the table stands.
static int by_identity(const void *a, const void *b)
{
    const identity *x = a, *y = b;
    int order = compare(x, y);
    if (order) return order;
    if (x->file != y->file) return x->file < y->file ? -1 : 1;
    return (x->frame > y->frame) - (x->frame < y->frame);
}

static bool identify_all(const run_files *files, const int *frames, int frame_count, identity *out, size_t *n, error *e)
{
    char path[FILE_PATH];
    for (int f = 0; f < files->count; f++) {
        const run_file *file = &files->list[f];
        int count = file->framed ? frame_count : frame_count > 0;
        for (int i = 0; i < count; i++) {
            identity *id = &out[*n];
            if (!run_file_path(file, file->framed ? frames[i] : 0, path, sizeof path)) continue;
            if (!identify(path, id, file->kind >= FILE_OUTPUT ? ERR_OUTPUT : ERR_INPUT, e)) return false;
            id->file = f, id->frame = frames[i];
            ++*n;
        }
    }
    return true;
}

static bool is_target(const run_files *files, const identity *id) { return files->list[id->file].kind >= FILE_OUTPUT; }

static bool refuse(const run_files *files, const identity *same, const identity *target, error *e)
{
    const run_file *written = &files->list[target->file], *other = &files->list[same->file];
    char path[FILE_PATH] = "", frame[32] = "";
    run_file_path(written, written->framed ? target->frame : 0, path, sizeof path);
    if (written->framed) snprintf(frame, sizeof frame, " of frame %d", target->frame);
    return err_set(e, ERR_USAGE, path, NULL, "%s%s and %s are the same file; name another, so that nothing is lost",
                   written->what, frame, other->what);
}

bool run_files_check(const run_files *files, const int *frames, int frame_count, error *e)
{
    const identity *worst = NULL, *as = NULL; // of the lowest frame, so that the message does not change from run to run
    identity *all = mem_zero((size_t)files->count * (size_t)frame_count + 1, sizeof *all, e);
    if (!all) return false;
    size_t n = 0;
    bool ok = identify_all(files, frames, frame_count, all, &n, e);
    qsort(all, n, sizeof *all, by_identity);
    for (size_t first = 0, target = 0, i = 0; i < n; i++) {
        if (compare(&all[first], &all[i]) != 0) first = target = i;
        if (is_target(files, &all[i])) target = i;
        if (i == first || !is_target(files, &all[target]) || (worst && worst->frame <= all[target].frame)) continue;
        worst = &all[target];
        as = &all[target == i ? first : i];
    }
    ok = ok && (!worst || refuse(files, as, worst, e));
    free(all);
    return ok;
}
