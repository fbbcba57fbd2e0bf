#include "pipeline/record.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/content.h"
#include "base/knobs.h"
#include "base/mem.h"
#include "gpu/shaders.h"
#include "pipeline/decides.h"
#include "pipeline/job.h"

// Shaders that stand in for those of the program.
static bool put_shader_folder(digester *d, const char *folder, error *e)
{
    char path[FILE_PATH];
    content c;
    for (const shader_source *s = shader_sources; s->name; s++) {
        snprintf(path, sizeof path, "%s/%s", folder, s->name);
        if (!content_read(path, NULL, false, &c, e)) return false;
        digest_put(d, &c.sampled, sizeof c.sampled);
    }
    return true;
}

static bool put_settings(digester *d, const job *j, error *e)
{
    char shot[64];
    const char *folder = knob_value("SSDO_SHADER_DIR");
    if (!options_digest(j->o, d, e)) return false;
    digest_put_text(d, ssdo_decides);
    if (folder && !put_shader_folder(d, folder, e)) return false;
    snprintf(shot, sizeof shot, "%a", (double)(float)j->shot.radius);
    digest_put_text(d, shot);
    digest_put(d, &j->shot.outside, sizeof j->shot.outside);
    return true;
}

static bool content_in(const run_file *file, int frame, bool exact, content *out, error *e)
{
    char path[FILE_PATH];
    *out = file->content;
    if (file->known && file->refusal.code) *e = file->refusal;
    if (file->known) return !file->refusal.code;
    return !run_file_path(file, frame, path, sizeof path) || content_read(path, exrio_head_bytes, exact, out, e);
}

static bool put_frame(const job *j, int frame, digester *sampled, digester *exact, error *e)
{
    if (!put_settings(sampled, j, e) || !put_settings(exact, j, e)) return false;
    bool all = j->o->skip_exact;
    content c;
    for (int i = 0; i < j->files->count; i++) {
        const run_file *file = &j->files->list[i];
        if (!file->decides) continue;
        if (!content_in(file, frame, all, &c, e)) return false;
        digest_put_text(sampled, file->what);
        digest_put(sampled, &c.sampled, sizeof c.sampled);
        digest_put_text(exact, file->what);
        digest_put(exact, &c.exact, sizeof c.exact);
    }
    return true;
}

// The frame's, and what previews go through.
static bool put_preview(const job *j, const digest *frame, digester *d, error *e)
{
    content c;
    digest_put(d, frame, sizeof *frame);
    digest_put_text(d, j->o->display);
    digest_put_text(d, j->o->view);
    for (int i = 0; i < j->files->count; i++)
        if (j->files->list[i].kind == FILE_COLOURS) {
            if (!content_in(&j->files->list[i], 0, false, &c, e)) return false;
            digest_put(d, &c.sampled, sizeof c.sampled);
        }
    return true;
}

bool record_make(const job *j, int frame, frame_record *out, error *e)
{
    *out = (frame_record){0};
    if (!j->files) return true;
    error why = {0};
    digester *sampled = digest_begin(&why), *exact = digest_begin(&why), *preview = digest_begin(&why);
    if (sampled && exact && preview && put_frame(j, frame, sampled, exact, &why)) {
        out->has_exact = j->o->skip_exact;
        out->sampled = digest_of(sampled);
        out->exact = digest_of(exact);
        out->made = put_preview(j, &out->sampled, preview, &why);
        out->preview = digest_of(preview);
    }
    digest_free(sampled);
    digest_free(exact);
    digest_free(preview);
    if (out->made) return true;
    out->refusal = why;
    if (why.code == ERR_INPUT) return true;
    *e = why;
    return false;
}

bool record_check(const frame_record *r, error *e)
{
    if (!r->refusal.code) return true;
    e->refused = r->refusal.refused;
    return err_set(e, r->refusal.code, r->refusal.file, NULL,
                   "%s; the output's record needs its content, so nothing is written: run the frame again", r->refusal.message);
}

// --- the file's outside ---

static void put_part(digester *d, const char *name, const char *view, box2 data, box2 display, int compression)
{
    digest_put_text(d, name ? name : "");
    digest_put_text(d, view ? view : "");
    digest_put(d, &data, sizeof data);
    digest_put(d, &display, sizeof display);
    digest_put(d, &compression, sizeof compression);
}

// The sum does not depend on the order.
static void add_channel(uint8_t sum[sizeof(digest)], const char *name, sample_type type)
{
    char text[300];
    snprintf(text, sizeof text, "%d %s", (int)type, name);
    digest c = digest_bytes(text, strlen(text));
    for (size_t i = 0; i < sizeof c; i++) sum[i] = (uint8_t)(sum[i] + c.bytes[i]);
}

digest record_layout(const exrio_out_part *parts, int count)
{
    digester *d = digest_begin(NULL);
    if (!d) return (digest){0};
    for (int i = 0; i < count; i++) {
        const exrio_out_part *p = &parts[i];
        uint8_t sum[sizeof(digest)] = {0};
        put_part(d, p->name, p->view, p->data_window, p->display_window, p->compression);
        for (int c = 0; c < p->channel_count; c++) add_channel(sum, p->channels[c].name, p->channels[c].type);
        digest_put(d, sum, sizeof sum);
    }
    digest result = digest_of(d);
    digest_free(d);
    return result;
}

static bool describe_part(const exrio_part *from, exrio_out_part *to)
{
    *to = (exrio_out_part){.name = from->name,
                           .view = from->view,
                           .data_window = from->data_window,
                           .display_window = from->display_window,
                           .compression = from->compression,
                           .channel_count = from->channel_count};
    to->channels = mem_zero((size_t)from->channel_count, sizeof *to->channels, NULL);
    for (int c = 0; to->channels && c < from->channel_count; c++)
        to->channels[c] = (exrio_out_channel){from->channels[c].name, from->channels[c].type, NULL};
    return to->channels != NULL;
}

digest record_layout_of_file(const exrio_file *file)
{
    digest result = {0};
    exrio_out_part *parts = mem_zero((size_t)file->part_count, sizeof *parts, NULL);
    bool ok = parts != NULL;
    for (int i = 0; ok && i < file->part_count; i++) ok = describe_part(&file->parts[i], &parts[i]);
    if (ok) result = record_layout(parts, file->part_count);
    for (int i = 0; parts && i < file->part_count; i++) free(parts[i].channels);
    free(parts);
    return result;
}

// --- the text ---

void record_format(const frame_record *r, digest layout, char text[RECORD_TEXT + 1])
{
    char *exact = text + DIGEST_TEXT + 1, *last = exact + DIGEST_TEXT + 1;
    digest_format(r->sampled, text);
    if (r->has_exact)
        digest_format(r->exact, exact);
    else
        memset(exact, '-', DIGEST_TEXT);
    digest_format(layout, last);
    exact[-1] = last[-1] = ' ';
}

bool record_fits(const frame_record *r, digest layout, const char *text)
{
    char wanted[RECORD_TEXT + 1];
    record_format(r, layout, wanted);
    if (!r->made || strlen(text) != RECORD_TEXT) return false;
    if (r->has_exact) return strcmp(text, wanted) == 0;
    const int exact = DIGEST_TEXT + 1, last = 2 * exact; // another run may have looked at all bytes
    return memcmp(text, wanted, (size_t)exact) == 0 && strcmp(text + last, wanted + last) == 0;
}
