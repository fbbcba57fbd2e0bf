#include "pipeline/resume.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/outfile.h"
#include "cli/frames.h"

static bool made_like_this(const job *j, const exr_file *f, int part)
{
    const char *version, *made;
    char args[1024];
    double radius;
    options_record(j->o, args, sizeof args);
    if (!exr_attr_string(f, part, "ssdo/version", &version) || strcmp(version, SSDO_VERSION) != 0) return false;
    if (!exr_attr_string(f, part, "ssdo/args", &made) || strcmp(made, args) != 0) return false;
    return j->shot_radius <= 0.0 || (exr_attr_float(f, part, "ssdo/radius", &radius) && (float)radius == (float)j->shot_radius);
}

static void warn_device(const job *j, const exr_file *f, int part)
{
    const char *device;
    if (exr_attr_string(f, part, "ssdo/device", &device) && strcmp(device, j->g.device) != 0)
        log_warn(
            j->log, "device",
            "%s was made on '%s' and this run is on '%s': only one device gives the same bytes for all frames; --device chooses, "
            "and without --skip-existing frames are made again",
            f->path, device, j->g.device);
}

void resume_check_device(const job *j, const char *output)
{
    exr_file *f = NULL;
    error ignored = {0};
    if (access(output, F_OK) != 0 || !exr_file_open(output, &f, &ignored)) return;
    for (int p = 0; p < f->part_count; p++)
        if (made_like_this(j, f, p)) warn_device(j, f, p);
    exr_file_close(f);
}

// A file that the frame is made of has changed since.
static bool is_newer(const char *path, const struct stat *output)
{
    struct stat s;
    if (!path || stat(path, &s) != 0) return false; // a pattern names no file
    if (s.st_mtim.tv_sec != output->st_mtim.tv_sec) return s.st_mtim.tv_sec > output->st_mtim.tv_sec;
    return s.st_mtim.tv_nsec > output->st_mtim.tv_nsec;
}

static bool is_outdated(const options *o, const char *const *inputs, int count, const char *output)
{
    const char *const others[] = {o->env, o->mesh, o->proxies, o->camera_file};
    struct stat s;
    if (stat(output, &s) != 0) return true;
    for (int i = 0; i < count; i++)
        if (is_newer(inputs[i], &s)) return true;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (is_newer(others[i], &s)) return true;
    return false;
}

static bool exist(const char *const *paths, int count)
{
    for (int i = 0; i < count; i++)
        if (access(paths[i], F_OK) != 0) return false;
    return true;
}

static bool is_done(const job *j, const char *output)
{
    exr_file *f = NULL;
    error ignored = {0};
    if (access(output, F_OK) != 0 || !exr_file_open(output, &f, &ignored)) return false;
    bool ours = false;
    for (int p = 0; p < f->part_count; p++) {
        ours |= made_like_this(j, f, p);
        for (int c = 0; c < f->parts[p].channel_count; c++) f->parts[p].channels[c].wanted = true;
    }
    ours = ours && exr_file_load(f, j->threads, &ignored);
    for (int p = 0; ours && p < f->part_count; p++) warn_device(j, f, p);
    exr_file_close(f);
    return ours;
}

const char *resume_skips(const job *j, const char *const *inputs, int count, const char *output)
{
    const options *o = j->o;
    if (o->missing_skip && !exist(inputs, count)) return "the input is missing";
    if (!o->skip_existing || is_outdated(o, inputs, count, output) || !is_done(j, output)) return NULL;
    outfile_tidy(output);
    return "already done";
}
