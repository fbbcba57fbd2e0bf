#include "pipeline/verify.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "exr/compare.h"
#include "pipeline/output_names.h"
#include "pipeline/views.h"

enum { AT_A_TIME = 8 }; // channels in memory, of each file

typedef struct verification {
    const job *j;
    const frame_result *r;
    exrio_file *in, *out;
    const char *output;
    int channels;
    error *e;
} verification;

static bool fail(const verification *v, const char *what, const char *name)
{
    return err_set(
        v->e, ERR_OUTPUT, v->output, NULL,
        "--verify: the %s '%s' is not in the written file as the input has it, so the file was not kept; write it again, "
        "and check the disk and the memory",
        what, name);
}

static exrio_channel *find_channel(exrio_part *part, const char *name)
{
    for (int c = 0; c < part->channel_count; c++)
        if (strcmp(part->channels[c].name, name) == 0) return &part->channels[c];
    return NULL;
}

// Where a channel of the part must be: in the part of its name, else in its view's, else in any.
static exrio_part *part_with(const verification *v, const exrio_part *in, const char *channel)
{
    for (int rule = 0; rule < 3; rule++)
        for (int p = 0; p < v->out->part_count; p++) {
            exrio_part *out = &v->out->parts[p];
            bool fits = rule == 0 ? strcmp(out->name, in->name) == 0 : rule == 1 ? strcmp(out->view, in->view) == 0 : true;
            if (fits && out->deep == in->deep && find_channel(out, channel)) return out;
        }
    return NULL;
}

static void drop(exrio_channel *c)
{
    if (!c) return;
    free(c->data);
    c->data = NULL, c->wanted = false;
}

static bool load(const verification *v, exrio_file *file)
{
    error read = {0};
    if (exrio_file_load(file, v->j->threads, &read)) return true;
    if (read.code == ERR_MEMORY || file == v->in) return err_set(v->e, read.code, read.file, read.channel, "%s", read.message);
    return err_set(v->e, ERR_OUTPUT, v->output, read.channel, "--verify: the written file %s; it was not kept", read.message);
}

static bool same_samples(const exrio_part *in, const exrio_channel *a, const exrio_part *out, const exrio_channel *b)
{
    size_t n = (size_t)box2_width(in->data_window) * (size_t)box2_height(in->data_window);
    return a->type == b->type && box2_equal(in->data_window, out->data_window) && a->data && b->data &&
           memcmp(a->data, b->data, n * sample_size(a->type)) == 0;
}

// Some channels of a part, from `first` on.
static bool check_some(verification *v, int part, int first, int *next)
{
    exrio_part *in = &v->in->parts[part];
    exrio_channel *pairs[AT_A_TIME][2];
    exrio_part *parts[AT_A_TIME];
    int n = 0, c = first;
    bool ok = true;
    for (; ok && c < in->channel_count && n < AT_A_TIME; c++) {
        exrio_channel *a = &in->channels[c];
        if (output_replaces(v->j, v->r, part, a->name)) continue;
        parts[n] = part_with(v, in, a->name);
        if (!parts[n]) return fail(v, "channel", a->name);
        pairs[n][0] = a, pairs[n][1] = find_channel(parts[n], a->name);
        pairs[n][0]->wanted = pairs[n][1]->wanted = true;
        n++;
    }
    *next = c;
    ok = load(v, v->in) && load(v, v->out);
    for (int i = 0; ok && i < n; i++, v->channels++)
        if (!same_samples(in, pairs[i][0], parts[i], pairs[i][1])) ok = fail(v, "channel", pairs[i][0]->name);
    for (int i = 0; i < n; i++) drop(pairs[i][0]), drop(pairs[i][1]);
    return ok;
}

static bool check_deep(verification *v, int part)
{
    const exrio_part *in = &v->in->parts[part];
    if (in->tiled) return true; // left out, with a word
    int own = part;
    const exrio_file *from = exrio_part_file(v->in, &own);
    for (int p = 0; p < v->out->part_count; p++)
        if (v->out->parts[p].deep && strcmp(v->out->parts[p].name, in->name) == 0)
            return exrio_deep_same(from, own, v->out, p) || fail(v, "deep part", in->name);
    return fail(v, "deep part", in->name);
}

static bool check_channels(verification *v)
{
    bool ok = true;
    for (int p = 0; ok && !v->j->o->keep_none && p < v->in->part_count; p++) {
        if (v->in->parts[p].deep) {
            ok = check_deep(v, p);
            continue;
        }
        for (int c = 0; ok && c < v->in->parts[p].channel_count;) ok = check_some(v, p, c, &c);
    }
    return ok;
}

// The part of the output that has what the input's part had, by the first of its channels that passes through; -1 for none.
static int home_of(const verification *v, int part)
{
    const exrio_part *in = &v->in->parts[part];
    for (int c = 0; !v->j->o->keep_none && c < in->channel_count; c++)
        if (!output_replaces(v->j, v->r, part, in->channels[c].name)) {
            const exrio_part *out = part_with(v, in, in->channels[c].name);
            return out ? (int)(out - v->out->parts) : -1;
        }
    for (int p = 0; v->j->o->keep_none && p < v->out->part_count; p++)
        if (!in->deep && (strcmp(v->out->parts[p].view, in->view) == 0 || v->out->part_count == 1)) return p;
    return -1;
}

static bool is_main(const verification *v, int part)
{
    for (const frame_result *r = v->r; r; r = r->next_view)
        if (r->resolution.main_part == part) return true;
    return false;
}

// The parts that went into one of the output's, the one with the position or depth first: its attributes count.
static bool check_attributes(verification *v)
{
    exrio_source *sources = mem_zero((size_t)v->in->part_count, sizeof *sources, v->e);
    bool ok = sources != NULL;
    for (int home = 0; ok && home < v->out->part_count; home++) {
        int count = 0;
        for (int rank = 0; rank < 2; rank++)
            for (int p = 0; p < v->in->part_count; p++) {
                if (is_main(v, p) == (rank == 1) || home_of(v, p) != home) continue;
                int own = p;
                const exrio_file *from = exrio_part_file(v->in, &own);
                sources[count++] = (exrio_source){from, own};
            }
        const char *name = exrio_attributes_differ(sources, count, v->out, home);
        if (name) ok = fail(v, "attribute", name);
    }
    free(sources);
    return ok;
}

static bool open_both(verification *v, const char *written)
{
    const exrio_file *file = v->r->file;
    int count = file->member_count ? file->member_count : 1;
    const char **paths = mem_zero((size_t)count, sizeof *paths, v->e);
    if (!paths) return false;
    for (int i = 0; i < count; i++) paths[i] = file->member_count ? file->members[i]->path : file->path;
    error read = {0};
    bool ok = exrio_file_open_all(paths, count, &v->in, v->e);
    if (ok && !exrio_file_open(written, &v->out, &read))
        ok = err_set(v->e, read.code == ERR_MEMORY ? ERR_MEMORY : ERR_OUTPUT, v->output, NULL,
                     "--verify: the written file %s; it was not kept", read.message);
    if (ok && v->in->part_count != file->part_count)
        ok = err_set(v->e, ERR_INPUT, file->path, NULL, "--verify: the input changed meanwhile; filter it again");
    free(paths);
    return ok;
}

bool verify_written(const job *j, const frame_result *r, const char *written, const char *output, error *e)
{
    verification v = {.j = j, .r = r, .output = output, .e = e};
    bool ok = open_both(&v, written) && check_channels(&v) && check_attributes(&v);
    if (ok) log_info(j->log, "--verify: %d channels and all attributes are the input's, bit by bit", v.channels);
    exrio_file_close(v.in);
    exrio_file_close(v.out);
    return ok;
}
