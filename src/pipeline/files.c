#include "pipeline/files.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/digest.h"
#include "base/mem.h"
#include "cli/frames.h"
#include "exr/file.h"
#include "gbuffer/mesh.h"
#include "pipeline/batch.h"
#include "plugin/colour.h"

// --- the table ---

bool proxies_are_framed(const options *o) { return o->proxies && pattern_is(o->proxies) && access(o->proxies, R_OK) != 0; }

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
    if (!o->mesh || !mesh_list_libraries(o->mesh, &f->owned, &f->owned_count, &ignored))
        return ignored.code != ERR_MEMORY || err_set(e, ERR_MEMORY, o->mesh, NULL, "%s", ignored.message);
    for (int i = 0; i < f->owned_count; i++)
        if (!add(f, (run_file){.what = "a material file of --mesh", .path = f->owned[i], .decides = true, .once = true}, e))
            return false;
    return true;
}

bool run_files_list(const options *o, run_files *out, error *e)
{
    bool many = batch_is(o), converts = o->env_colorspace || o->albedo_colorspace;
    const run_file others[] = {
        {.what = "--env", .path = o->env, .decides = true, .once = true},
        {.what = "--camera", .path = o->camera_file, .decides = true},
        {.what = "--proxies", .path = o->proxies, .decides = true, .framed = proxies_are_framed(o)},
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
    *out = (run_files){0};
    bool ok = true;
    for (int i = 0; ok && i < o->input_count; i++) {
        const run_file input = {
            .what = "the input", .path = o->inputs[i], .framed = many && pattern_is(o->inputs[i]), .decides = true};
        ok = add(out, input, e);
    }
    for (size_t i = 0; ok && i < sizeof others / sizeof *others; i++) ok = add(out, others[i], e);
    ok = ok && add_materials(o, out, e);
    if (!ok) run_files_free(out);
    return ok;
}

void run_files_read(run_files *files, bool exact)
{
    for (int i = 0; i < files->count; i++) {
        run_file *f = &files->list[i];
        if (!f->once) continue;
        f->content = content_read(f->path, exrio_head_bytes(f->path), exact);
        f->known = true;
    }
}

void run_files_free(run_files *files)
{
    for (int i = 0; i < files->owned_count; i++) free(files->owned[i]);
    free(files->owned);
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

static identity identify(const char *path)
{
    identity id = {0};
    struct stat s;
    char folder[FILE_PATH] = ".";
    if (stat(path, &s) == 0) return (identity){.device = s.st_dev, .inode = s.st_ino};
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    if (slash) snprintf(folder, sizeof folder, "%.*s", (int)(slash - path) + 1, path);
    if (stat(folder, &s) == 0)
        id = (identity){.device = s.st_dev, .inode = s.st_ino};
    else
        name = path;
    id.name = digest_bytes(name, strlen(name));
    return id;
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

static size_t identify_all(const run_files *files, const int *frames, int frame_count, identity *out)
{
    char path[FILE_PATH];
    size_t n = 0;
    for (int f = 0; f < files->count; f++) {
        int count = files->list[f].framed ? frame_count : frame_count > 0;
        for (int i = 0; i < count; i++) {
            if (!run_file_path(&files->list[f], files->list[f].framed ? frames[i] : 0, path, sizeof path)) continue;
            out[n] = identify(path);
            out[n].file = f, out[n].frame = frames[i];
            n++;
        }
    }
    return n;
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
    size_t n = identify_all(files, frames, frame_count, all);
    qsort(all, n, sizeof *all, by_identity);
    for (size_t first = 0, target = 0, i = 0; i < n; i++) {
        if (compare(&all[first], &all[i]) != 0) first = target = i;
        if (is_target(files, &all[i])) target = i;
        if (i == first || !is_target(files, &all[target]) || (worst && worst->frame <= all[target].frame)) continue;
        worst = &all[target];
        as = &all[target == i ? first : i];
    }
    bool ok = !worst || refuse(files, as, worst, e);
    free(all);
    return ok;
}
