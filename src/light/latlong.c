#include "light/latlong.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/half.h"
#include "base/infile.h"
#include "base/mem.h"
#include "exr/file.h"
#include "light/environment.h"
#include "plugin/images.h"

// By its first bytes, not by its name.
static bool is_exr(const char *path, bool *exr, error *e)
{
    static const uint8_t magic[4] = {0x76, 0x2f, 0x31, 0x01};
    uint8_t first[4] = {0};
    int fd = infile_open(path, (infile_kind){"the environment map", ERR_INPUT}, NULL, e);
    if (fd < 0) return false;
    size_t n = infile_read_at(fd, first, sizeof first, 0);
    close(fd);
    if (n == 0) return err_set(e, ERR_INPUT, path, NULL, "the environment map is empty; give a lat-long image");
    *exr = memcmp(first, magic, sizeof magic) == 0;
    return true;
}

// ---- which channels of an EXR

typedef struct selection {
    int part, channels[3]; // one channel three times for a grey map
} selection;

// Channel `layer` + name of a part, -1 if there is none. layer includes its dot, or is "".
static int find_channel(const exr_part *part, const char *layer, size_t layer_length, const char *name)
{
    for (int i = 0; i < part->channel_count; i++) {
        const char *full = part->channels[i].name;
        if (part->channels[i].type == SAMPLE_UINT || strncmp(full, layer, layer_length) != 0) continue;
        if (strcasecmp(full + layer_length, name) == 0) return i;
    }
    return -1;
}

static bool select_rgb(const exr_part *part, const char *layer, size_t layer_length, int channels[3])
{
    static const char *const names[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; c++)
        if ((channels[c] = find_channel(part, layer, layer_length, names[c])) < 0) return false;
    return true;
}

static bool select_grey(const exr_part *part, const char *layer, size_t layer_length, int channels[3])
{
    return (channels[0] = channels[1] = channels[2] = find_channel(part, layer, layer_length, "Y")) >= 0;
}

typedef bool (*select_fn)(const exr_part *part, const char *layer, size_t layer_length, int channels[3]);

// The unnamed layer first, then the layers in the file's order.
static bool select_in_part(const exr_part *part, select_fn select, int channels[3])
{
    if (select(part, "", 0, channels)) return true;
    for (int i = 0; i < part->channel_count; i++) {
        const char *name = part->channels[i].name, *dot = strrchr(name, '.');
        if (dot && select(part, name, (size_t)(dot + 1 - name), channels)) return true;
    }
    return false;
}

static bool select_channels(const exr_file *file, selection *s)
{
    for (s->part = 0; s->part < file->part_count; s->part++)
        if (select_in_part(&file->parts[s->part], select_rgb, s->channels)) return true;
    for (s->part = 0; s->part < file->part_count; s->part++)
        if (select_in_part(&file->parts[s->part], select_grey, s->channels)) return true;
    return false;
}

// ---- its pixels

static bool inside(box2 a, box2 b) { return a.x0 >= b.x0 && a.y0 >= b.y0 && a.x1 <= b.x1 && a.y1 <= b.y1; }

// 64 bits: nobody has checked the size of a display window yet.
static bool two_to_one(box2 b)
{
    long long width = (long long)b.x1 - b.x0 + 1, height = (long long)b.y1 - b.y0 + 1;
    return width == 2 * height && width > 0 && width <= ENV_MAX_SIZE;
}

// Renderers crop black borders off the data window. Then the display window is the sphere.
static box2 sphere_window(const exr_part *part)
{
    bool cropped = !box2_equal(part->data_window, part->display_window) && !two_to_one(part->data_window) &&
                   two_to_one(part->display_window) && inside(part->data_window, part->display_window);
    return cropped ? part->display_window : part->data_window;
}

static float sample(const exr_channel *channel, size_t i)
{
    return channel->type == SAMPLE_HALF ? half_to_float(((const uint16_t *)channel->data)[i]) : ((const float *)channel->data)[i];
}

static bool gather(const exr_part *part, const int channels[3], int *width, int *height, float **rgb, error *e)
{
    box2 data = part->data_window, window = sphere_window(part);
    size_t w = (size_t)box2_width(data), across = (size_t)box2_width(window), down = (size_t)box2_height(window);
    float *out = mem_zero(across * down, 3 * sizeof *out, e);
    if (!out) return false;
    for (int y = data.y0; y <= data.y1; y++)
        for (int x = data.x0; x <= data.x1; x++) {
            size_t from = (size_t)(y - data.y0) * w + (size_t)(x - data.x0);
            size_t to = (size_t)(y - window.y0) * across + (size_t)(x - window.x0);
            for (size_t c = 0; c < 3; c++) out[3 * to + c] = sample(&part->channels[channels[c]], from);
        }
    *width = (int)across;
    *height = (int)down;
    *rgb = out;
    return true;
}

static bool read_exr(const char *path, int threads, int *width, int *height, float **rgb, map_primaries *primaries, log_t *log,
                     error *e)
{
    bool ok = false;
    exr_file *file = NULL;
    selection s;
    if (!exr_file_open(path, &file, e)) goto out;
    if (!select_channels(file, &s)) {
        err_set(e, ERR_INPUT, path, NULL,
                "the environment map has no half or float channels R, G and B, nor a single Y; rename them");
        goto out;
    }
    exr_part *part = &file->parts[s.part];
    for (int c = 0; c < 3; c++) part->channels[s.channels[c]].wanted = true;
    if (!exr_file_load(file, threads, e)) goto out;
    ok = gather(part, s.channels, width, height, rgb, e);
    primaries->known = exr_attr_chromaticities(file, s.part, primaries->xy);
    if (ok)
        log_info(log, "environment: %s, %s %s %s, %d x %d", path, part->channels[s.channels[0]].name,
                 part->channels[s.channels[1]].name, part->channels[s.channels[2]].name, *width, *height);
out:
    exr_file_close(file);
    return ok;
}

// ---- everything else

static bool read_other(const char *path, int *width, int *height, float **rgb, error *e)
{
    int channels = 0;
    float *pixels = NULL;
    if (!images_read_float(path, 0, width, height, &channels, &pixels, e)) return false;
    size_t texels = (size_t)*width * (size_t)*height, stride = (size_t)channels;
    float *out = channels > 0 ? mem_pixels(texels, 3 * sizeof *out, e) : NULL;
    // One or two channels are grey, with or without alpha.
    for (size_t i = 0; out && i < texels; i++)
        for (size_t c = 0; c < 3; c++) out[3 * i + c] = pixels[i * stride + (stride >= 3 ? c : 0)];
    free(pixels);
    *rgb = out;
    return out || err_set(e, ERR_INPUT, path, NULL, "the environment map has no channels; give a colour or grey image");
}

bool latlong_read(const char *path, int threads, int *width, int *height, float **rgb, map_primaries *primaries, log_t *log,
                  error *e)
{
    bool exr = false;
    *rgb = NULL;
    *primaries = (map_primaries){0};
    if (!is_exr(path, &exr, e)) return false;
    return exr ? read_exr(path, threads, width, height, rgb, primaries, log, e) : read_other(path, width, height, rgb, e);
}
