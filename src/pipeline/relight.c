#include "pipeline/relight.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/half.h"
#include "base/mem.h"
#include "pipeline/layers.h"
#include "pipeline/views.h"

enum { NAME_SIZE = 128 };

static int count(const options *o) { return o->sh_bands == 3 ? 16 : 9; }

// Coefficients 0 to 8 are in layers of three, 9 to 15 in one of seven.
static void name_of(const options *o, const exrio_file *file, const char *view, int i, char *name)
{
    char plain[NAME_SIZE];
    const image_row *l = layer_table[i < 9 ? LAYER_SH_0 + i / 3 : LAYER_SH_3];
    snprintf(plain, NAME_SIZE, "%s%s.%c", o->prefix ? o->prefix : "", l->name, l->channels[i < 9 ? i % 3 : i - 9]);
    view_name(file, view, plain, name, NAME_SIZE);
}

static exrio_channel *find(const exrio_file *file, const char *view, const char *name, const exrio_part **part)
{
    for (int p = 0; p < file->part_count; p++)
        for (int c = 0; c < file->parts[p].channel_count; c++)
            if (view_has(&file->parts[p], view) && strcmp(file->parts[p].channels[c].name, name) == 0) {
                *part = &file->parts[p];
                return &file->parts[p].channels[c];
            }
    return NULL;
}

bool relight_want(const options *o, exrio_file *file, const char *view, error *e)
{
    const exrio_part *part;
    for (int i = 0; i < count(o); i++) {
        char name[NAME_SIZE];
        name_of(o, file, view, i, name);
        exrio_channel *channel = find(file, view, name, &part);
        if (!channel)
            return err_set(e, ERR_INPUT, file->path, name,
                           "--from-sh needs the layers that --method s3ho --layers sh_0,sh_1,sh_2 (and sh_3 with --sh-bands 3) "
                           "writes, and this one is missing");
        channel->wanted = true;
    }
    return true;
}

static float sample_at(const exrio_channel *c, size_t i)
{
    float v = sample_value(c->type, c->data, i);
    return isfinite(v) ? v : 0.0f;
}

bool relight_load(const options *o, const exrio_file *file, const char *view, const gbuffer *gb, float *out[5], error *e)
{
    size_t n = (size_t)gb->width * (size_t)gb->height;
    for (int i = 0; i < count(o); i++) {
        char name[NAME_SIZE];
        name_of(o, file, view, i, name);
        const exrio_part *part = NULL;
        const exrio_channel *channel = find(file, view, name, &part);
        if (!channel || !channel->data || !box2_equal(part->data_window, gb->data_window))
            return err_set(e, ERR_INPUT, file->path, name,
                           "this stored layer has another data window than the picture's surfaces");
        int image = i < 9 ? i / 3 : i < 13 ? 3 : 4, place = i < 9 ? i % 3 : (i - 9) % 4;
        if (place == 0 && !(out[image] = mem_zero(4 * n, sizeof **out, e))) return false;
        for (size_t k = 0; k < n; k++) out[image][4 * k + (size_t)place] = sample_at(channel, k);
    }
    return true;
}
