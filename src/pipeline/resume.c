#include "pipeline/resume.h"

#include <string.h>
#include <unistd.h>

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

bool resume_is_done(const job *j, const char *output)
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
