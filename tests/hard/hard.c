#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "hard.h"

#include <unistd.h>

#include "exr/write.h"
#include "pipeline/frame.h"

int hard_open(void **state)
{
    hard *h = calloc(1, sizeof *h);
    error e = {0};
    if (!h) return -1;
    must(rig_open(&h->rig, &(env_options){.up_z = true, .scale = 1.0}, &e), &e);
    strcpy(h->folder, access("/dev/shm", W_OK) == 0 ? "/dev/shm/ssdo-hard-XXXXXX" : "/tmp/ssdo-hard-XXXXXX");
    *state = h;
    return mkdtemp(h->folder) ? 0 : -1;
}

int hard_close(void **state)
{
    hard *h = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", h->folder);
    rig_close(&h->rig);
    int code = system(command);
    free(h);
    return code;
}

bool hard_whole(void)
{
    const char *s = getenv("SSDO_HARD");
    return s && strcmp(s, "whole") == 0;
}

exrio_file *hard_file(const scene *s, const view *v, const scene_exr_options *o)
{
    error e = {0};
    scene_exr_options with = *o;
    if (!with.convention) with.convention = "plain";
    exrio_file *f = scene_file(s, v, &with, &e);
    must(f != NULL, &e);
    return f;
}

float *hard_channel(const exrio_file *f, const char *name)
{
    for (int i = 0; i < f->parts[0].channel_count; i++)
        if (strcmp(f->parts[0].channels[i].name, name) == 0) return f->parts[0].channels[i].data;
    return NULL;
}

const char *hard_write(const hard *h, const exrio_file *f, const char *name)
{
    static char path[128];
    exrio_out_channel channels[32];
    const exrio_part *p = &f->parts[0];
    error e = {0};
    assert_true(p->channel_count <= 32);
    for (int i = 0; i < p->channel_count; i++)
        channels[i] = (exrio_out_channel){p->channels[i].name, p->channels[i].type, p->channels[i].data};
    exrio_out_part part = {.data_window = p->data_window,
                           .display_window = p->display_window,
                           .pixel_aspect = p->pixel_aspect,
                           .compression = p->compression,
                           .channels = channels,
                           .channel_count = p->channel_count};
    snprintf(path, sizeof path, "%s/%s.exr", h->folder, name);
    must(exrio_write(path, &part, 1, 1, &e), &e);
    return path;
}

bool hard_frame(hard *h, const char *path, frame_result *out, error *e)
{
    return frame_read(&h->rig.job, path, out, e) && frame_filter(&h->rig.job, out, e);
}

void hard_run(hard *h, const exrio_file *f, frame_result *out)
{
    error e = {0};
    must(hard_frame(h, hard_write(h, f, "in"), out, &e), &e);
}

static bool is_share(int layer) { return layer == LAYER_OCCLUSION || layer == LAYER_VISIBILITY; }

static bool is_light(int layer) { return layer == LAYER_RADIANCE || layer == LAYER_INDIRECT || layer == LAYER_SPECULAR; }

void hard_check_layers(const frame_result *r, const char *what)
{
    size_t pixels = (size_t)r->gb.width * (size_t)r->gb.height;
    int made = 0;
    for (int l = 0; l < LAYER_COUNT; l++) {
        size_t n = pixels * strlen(layer_table[l]->channels);
        const float *v = r->layers[l];
        made += v != NULL;
        for (size_t i = 0; v && i < n; i++) {
            bool good = isfinite(v[i]) && (!is_share(l) || (v[i] >= 0.0f && v[i] <= 1.0f)) && (!is_light(l) || v[i] >= 0.0f);
            if (!good)
                fail_msg("%s, %s: %s holds %g at sample %zu", what, r->plan.method->name, layer_table[l]->name, (double)v[i], i);
        }
    }
    assert_true(made > 0);
}

difference hard_compare(const frame_result *a, const frame_result *b, layer_id layer, const unsigned char *mask)
{
    difference d = {0};
    size_t channels = strlen(layer_table[layer]->channels);
    const float *u = a->layers[layer], *v = b->layers[layer];
    assert_int_equal(a->gb.width, b->gb.width);
    assert_int_equal(a->gb.height, b->gb.height);
    assert_true(u && v);
    for (size_t i = 0; i < (size_t)a->gb.width * (size_t)a->gb.height; i++) {
        if (!(a->gb.depth[i] > 0.0f && b->gb.depth[i] > 0.0f) || (mask && !mask[i])) continue;
        for (size_t k = 0; k < channels; k++) {
            double by = (double)u[i * channels + k] - (double)v[i * channels + k];
            d.mean += by;
            d.rms += by * by;
            if (!(fabs(by) <= d.worst)) d.worst = fabs(by);
            d.count++;
        }
    }
    if (d.count) d.mean /= (double)d.count, d.rms = sqrt(d.rms / (double)d.count);
    return d;
}

FILE *hard_table(const char *name, const char *title)
{
    char path[4096];
    const char *folder = getenv("SSDO_TABLES");
    if (!folder) return NULL;
    snprintf(path, sizeof path, "%s/%s.md", folder, name);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "%s\n\n", title);
    return f;
}

void hard_cell(FILE *table, const char *format, ...)
{
    if (!table) return;
    va_list args;
    va_start(args, format);
    vfprintf(table, format, args);
    va_end(args);
}

void hard_table_end(FILE *table)
{
    if (!table) return;
    fputc('\n', table);
    fclose(table);
}
