#include "pipeline/resume.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/infile.h"
#include "base/outfile.h"
#include "pipeline/extras.h"

static void warn_device(const job *j, const exrio_file *f, int part)
{
    const char *device;
    if (exrio_attr_string(f, part, "ssdo/device", &device) && strcmp(device, j->g.device) != 0)
        log_warn(
            j->log, "device",
            "%s was made on '%s' and this run is on '%s': only one device gives the same bytes for all frames; --device chooses, "
            "and without --skip-existing frames are made again",
            f->path, device, j->g.device);
}

void resume_check_device(const job *j, const char *output)
{
    exrio_file *f = NULL;
    error ignored = {0};
    const char *made;
    if (access(output, F_OK) != 0 || !exrio_file_open(output, &f, &ignored)) return;
    char *args = options_record(j->o, &ignored);
    for (int p = 0; args && p < f->part_count; p++)
        if (exrio_attr_string(f, p, "ssdo/args", &made) && strcmp(made, args) == 0) warn_device(j, f, p);
    free(args);
    exrio_file_close(f);
}

// Of a file that the system refuses to look at, reading tells.
static bool are_missing(const char *const *paths, int count)
{
    bool there = true;
    error ignored = {0};
    for (int i = 0; i < count && there; i++) (void)infile_exists(paths[i], (infile_kind){NULL, ERR_INPUT}, &there, &ignored);
    return !there;
}

// The first part and one of ours say so; what others say is of an earlier run.
static bool is_recorded(const exrio_file *f, const frame_record *record)
{
    digest layout = record_layout_of_file(f);
    bool first = false, ours = false;
    for (int p = 0; p < f->part_count; p++) {
        const char *text;
        bool fits = exrio_attr_string(f, p, RECORD_NAME, &text) && record_fits(record, layout, text);
        first = first || (fits && p == 0);
        ours = ours || (fits && exrio_attr_exists(f, p, "ssdo/version"));
    }
    return first && ours;
}

static bool is_done(const job *j, const frame_record *record, const char *output)
{
    exrio_file *f = NULL;
    error ignored = {0};
    if (access(output, F_OK) != 0 || !exrio_file_open(output, &f, &ignored)) return false;
    for (int p = 0; p < f->part_count; p++)
        for (int c = 0; c < f->parts[p].channel_count; c++) f->parts[p].channels[c].wanted = true;
    bool done = is_recorded(f, record) && exrio_file_load(f, j->threads, &ignored);
    for (int p = 0; done && p < f->part_count; p++) warn_device(j, f, p);
    exrio_file_close(f);
    return done;
}

const char *resume_skips(const job *j, int frame, const char *const *inputs, int count, const char *output,
                         const frame_record *record)
{
    const options *o = j->o;
    if (o->missing_skip && are_missing(inputs, count)) return "the input is missing";
    if (!o->skip_existing || !record->made || !extras_are_done(j, frame, record) || !is_done(j, record, output)) return NULL;
    outfile_tidy(output);
    return "already done";
}
