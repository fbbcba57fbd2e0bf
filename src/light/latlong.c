#include "light/latlong.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/half.h"
#include "base/infile.h"
#include "base/mem.h"
#include "exr/file.h"
#include "light/env_map.h"
#include "light/reduce.h"
#include "plugin/images.h"

enum { BAND = 1 << 22 }; // texels converted at a time: each time, OpenColorIO reads its config again

typedef struct reader {
    const char *path;
    const latlong_options *options;
    reduced_map map;
    float *row;  // scratch of take_rows
    float *band; // rows that wait for their conversion
    int band_first, band_rows;
    log_t *log;
    error *e;
} reader;

static bool flush(reader *r)
{
    size_t across = 3 * (size_t)r->map.from_width;
    if (r->band_rows == 0) return true;
    bool ok = r->options->convert(r->options->context, r->band, across / 3 * (size_t)r->band_rows, r->e);
    for (int i = 0; ok && i < r->band_rows; i++) reduce_row(&r->map, r->band_first + i, r->band + across * (size_t)i);
    r->band_rows = 0;
    return ok;
}

// A row on its way into the map: converted to linear light first, for means of anything else are not means of light.
static bool give(reader *r, int y, const float *rgb)
{
    int most = r->map.from_width < BAND ? BAND / r->map.from_width : 1;
    size_t across = 3 * (size_t)r->map.from_width;
    if (!r->options->convert) {
        reduce_row(&r->map, y, rgb);
        return true;
    }
    if (!r->band && !(r->band = mem_pixels(across * (size_t)most, sizeof *r->band, r->e))) return false;
    if (r->band_rows == 0) r->band_first = y;
    memcpy(r->band + across * (size_t)r->band_rows++, rgb, across * sizeof *rgb);
    return r->band_rows < most || flush(r);
}

// By its first bytes, not by its name.
static bool is_exr(const char *path, bool *exr, error *e)
{
    static const uint8_t magic[4] = {0x76, 0x2f, 0x31, 0x01};
    uint8_t first[4] = {0};
    int fd = infile_open(path, (infile_kind){"the environment map", ERR_INPUT}, NULL, e);
    if (fd < 0) return false;
    size_t n = infile_read_at(fd, first, sizeof first, 0);
    int refused = errno;
    close(fd);
    if (refused) return err_set_system(e, ERR_INPUT, refused, path, "the environment map cannot be read");
    if (n == 0) return err_set(e, ERR_INPUT, path, NULL, "the environment map is empty; give a lat-long image");
    *exr = memcmp(first, magic, sizeof magic) == 0;
    return true;
}

// ---- which channels of an EXR

typedef struct selection {
    int part, channels[3]; // one channel three times for a grey map
} selection;

// Channel `layer` + name of a part, -1 if there is none. layer includes its dot, or is "".
static int find_channel(const exrio_part *part, const char *layer, size_t layer_length, const char *name)
{
    for (int i = 0; i < part->channel_count; i++) {
        const char *full = part->channels[i].name;
        if (part->channels[i].type == SAMPLE_UINT || strncmp(full, layer, layer_length) != 0) continue;
        if (strcasecmp(full + layer_length, name) == 0) return i;
    }
    return -1;
}

static bool select_rgb(const exrio_part *part, const char *layer, size_t layer_length, int channels[3])
{
    static const char *const names[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; c++)
        if ((channels[c] = find_channel(part, layer, layer_length, names[c])) < 0) return false;
    return true;
}

static bool select_grey(const exrio_part *part, const char *layer, size_t layer_length, int channels[3])
{
    return (channels[0] = channels[1] = channels[2] = find_channel(part, layer, layer_length, "Y")) >= 0;
}

typedef bool (*select_fn)(const exrio_part *part, const char *layer, size_t layer_length, int channels[3]);

// The unnamed layer first, then the layers in the file's order.
static bool select_in_part(const exrio_part *part, select_fn select, int channels[3])
{
    if (select(part, "", 0, channels)) return true;
    for (int i = 0; i < part->channel_count; i++) {
        const char *name = part->channels[i].name, *dot = strrchr(name, '.');
        if (dot && select(part, name, (size_t)(dot + 1 - name), channels)) return true;
    }
    return false;
}

static bool select_channels(const exrio_file *file, selection *s)
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
static box2 sphere_window(const exrio_part *part)
{
    bool cropped = !box2_equal(part->data_window, part->display_window) && !two_to_one(part->data_window) &&
                   two_to_one(part->display_window) && inside(part->data_window, part->display_window);
    return cropped ? part->display_window : part->data_window;
}

static bool gather(reader *r, const exrio_part *part, const int channels[3])
{
    box2 data = part->data_window, window = sphere_window(part);
    size_t w = (size_t)box2_width(data), across = (size_t)box2_width(window);
    float *row = mem_zero(across, 3 * sizeof *row, r->e);
    bool ok = row != NULL;
    for (int y = window.y0; ok && y <= window.y1; y++) {
        bool there = y >= data.y0 && y <= data.y1;
        memset(row, 0, across * 3 * sizeof *row);
        for (size_t x = 0; there && x < w; x++)
            for (size_t c = 0; c < 3; c++)
                row[3 * (x + (size_t)(data.x0 - window.x0)) + c] = sample_value(
                    part->channels[channels[c]].type, part->channels[channels[c]].data, (size_t)(y - data.y0) * w + x);
        ok = give(r, y - window.y0, row);
    }
    free(row);
    return ok;
}

static bool read_exr(reader *r, int threads, map_primaries *primaries)
{
    bool ok = false;
    exrio_file *file = NULL;
    selection s;
    if (!exrio_file_open(r->path, &file, r->e)) goto out;
    if (!select_channels(file, &s)) {
        err_set(r->e, ERR_INPUT, r->path, NULL,
                "the environment map has no half or float channels R, G and B, nor a single Y; rename them");
        goto out;
    }
    exrio_part *part = &file->parts[s.part];
    box2 window = sphere_window(part);
    double stored = 0.0;
    for (int c = 0; c < 3; c++) {
        stored += part->channels[s.channels[c]].wanted ? 0.0 : (double)sample_size(part->channels[s.channels[c]].type);
        part->channels[s.channels[c]].wanted = true;
    }
    if (!reduce_begin(&r->map, box2_width(window), box2_height(window), stored, r->path, r->e) ||
        !exrio_file_load(file, threads, r->e))
        goto out;
    ok = gather(r, part, s.channels);
    primaries->known = exrio_attr_chromaticities(file, s.part, primaries->xy);
    if (ok)
        log_info(r->log, "environment: %s, %s %s %s, %d x %d", r->path, part->channels[s.channels[0]].name,
                 part->channels[s.channels[1]].name, part->channels[s.channels[2]].name, r->map.from_width, r->map.from_height);
out:
    exrio_file_close(file);
    return ok;
}

// ---- everything else

// One or two channels are grey, with or without alpha.
static int take_rows(void *context, int width, int height, int channels, int y, int rows, const float *pixels)
{
    reader *r = context;
    size_t stride = (size_t)channels, across = (size_t)width;
    if (rows == 0) {
        if (channels < 1)
            return err_set(r->e, ERR_INPUT, r->path, NULL, "the environment map has no channels; give a colour or grey image");
        // Rows in tiles or blocks of 64, as stored and as float, are the most that reading takes.
        return reduce_begin(&r->map, width, height, 0.0, r->path, r->e) &&
               (r->row = mem_pixels(across, 3 * sizeof *r->row, r->e));
    }
    for (int k = 0; k < rows; k++, pixels += across * stride) {
        for (size_t i = 0; i < across; i++)
            for (size_t c = 0; c < 3; c++) r->row[3 * i + c] = pixels[i * stride + (stride >= 3 ? c : 0)];
        if (!give(r, y + k, r->row)) return false;
    }
    return true;
}

bool latlong_read(const latlong_options *options, int *width, int *height, float **rgb, map_primaries *primaries, log_t *log,
                  error *e)
{
    reader r = {.path = options->path, .options = options, .log = log, .e = e};
    bool exr = false;
    *rgb = NULL;
    *primaries = (map_primaries){0};
    bool ok = is_exr(r.path, &exr, e) &&
              (exr ? read_exr(&r, options->threads, primaries) : images_read_rows(r.path, 0, take_rows, &r, e)) && flush(&r);
    free(r.row);
    free(r.band);
    if (ok) {
        reduce_end(&r.map);
        if (r.map.weights)
            log_info(log, "environment: %s has %d x %d texels, which are read as %d x %d", r.path, r.map.from_width,
                     r.map.from_height, r.map.width, r.map.height);
        *width = r.map.width, *height = r.map.height, *rgb = r.map.rgb;
        r.map.rgb = NULL;
    }
    reduce_free(&r.map);
    return ok;
}
