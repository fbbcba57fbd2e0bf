#include "light/environment.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "light/latlong.h"
#include "light/mips.h"
#include "light/primaries.h"
#include "light/sh.h"
#include "plugin/colour.h"

static const float greatest = 1e30f;

// World to map space. OpenEXR's latlong is ours with the axes renamed: longitude atan2(x, z) and height y are our atan2(y, x) and
// z for the direction (z, x, y), a rotation. Turning the environment by r turns the looking direction by -r.
static mat3 orientation(bool up_z, double rotate_degrees)
{
    double r = rotate_degrees * M_PI / 180, c = cos(r), s = sin(r);
    mat3 turn = {{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}};
    mat3 y_to_z = {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}};
    return up_z ? turn : m3_mul(turn, y_to_z);
}

static float largest_finite(const float *rgb, size_t n)
{
    float most = 0;
    for (size_t i = 0; i < n; i++)
        if (isfinite(rgb[i]) && rgb[i] > most) most = rgb[i];
    return most;
}

// Level 0 from the map's values. Returns how many texels had to be repaired.
static size_t fill_level0(const float *rgb, size_t texels, double scale, float *rgba)
{
    size_t count = 0;
    float most = -1; // the largest finite value, looked for when an infinity asks for it
    for (size_t i = 0; i < texels; i++) {
        bool bad = false;
        for (size_t c = 0; c < 3; c++) {
            float v = rgb[3 * i + c];
            if (!(v >= 0) || isinf(v)) {
                bad = true;
                if (v > 0 && most < 0) most = largest_finite(rgb, 3 * texels);
                v = v > 0 ? most : 0;
            }
            double scaled = (double)v * scale;
            rgba[4 * i + c] = scaled < (double)greatest ? (float)scaled : greatest;
        }
        rgba[4 * i + 3] = 0;
        count += bad;
    }
    return count;
}

static bool check_size(int width, int height, const char *path, log_t *log, error *e)
{
    if (width < 1 || height < 1 || width > ENV_MAX_SIZE || height > ENV_MAX_SIZE)
        return err_set(e, ERR_INPUT, path, NULL,
                       "the environment map has %d x %d texels, at most %d a side are taken; scale it down", width, height,
                       ENV_MAX_SIZE);
    if (height == 6 * width || width == 6 * height)
        return err_set(e, ERR_INPUT, path, NULL,
                       "%d x %d looks like a cube map, and a lat-long map is needed; convert it with exrenvmap -l", width,
                       height);
    if (width != 2 * height && (width > 2 || height > 2))
        log_warn(log, "env-shape",
                 "%s: the environment map is %d x %d, not twice as wide as high; it is taken as the whole sphere",
                 path ? path : "environment", width, height);
    return true;
}

bool environment_prepare(const float *rgb, int width, int height, const env_options *options, environment *out, log_t *log,
                         error *e)
{
    *out = (environment){.map_from_world = orientation(options->up_z, options->rotate_degrees)};
    if (!check_size(width, height, options->path, log, e)) return false;
    size_t texels = (size_t)width * (size_t)height;
    float *rgba = mem_pixels(texels, 4 * sizeof *rgba, e);
    if (!rgba) return false;
    out->levels[0] = (env_level){width, height, rgba};
    out->level_count = 1;
    out->repaired = fill_level0(rgb, texels, options->scale, rgba);
    if (out->repaired == texels) {
        err_set(e, ERR_INPUT, options->path, NULL,
                "every texel of the environment map is NaN, infinite or negative; render it or convert it again");
        environment_free(out);
        return false;
    }
    if (out->repaired)
        log_warn(log, "env-repaired", "%s: %zu of %zu texels of the environment were NaN, infinite or negative and were repaired",
                 options->path ? options->path : "environment", out->repaired, texels);
    if (!sh_project(rgba, width, height, options->threads, out->sh, e) || !mips_build(out, options->threads, e)) {
        environment_free(out);
        return false;
    }
    for (int c = 0; c < 3; c++) out->mean[c] = out->sh[0][c] / sqrt(4 * M_PI);
    return true;
}

// Only where both files say what their primaries are: the format's default, Rec. 709, is more often an omission than a statement.
static void match_primaries(const env_options *options, const map_primaries *map, float *rgb, size_t texels, log_t *log)
{
    mat3 m;
    if (!map->known || !options->primaries || primaries_equal(map->xy, options->primaries)) return;
    if (!primaries_between(map->xy, options->primaries, &m)) {
        log_warn(log, "primaries", "%s: its chromaticities are no primaries; the map is used as it is", options->path);
        return;
    }
    for (size_t i = 0; i < texels; i++) {
        vec3 v = m3_apply(m, v3((double)rgb[3 * i], (double)rgb[3 * i + 1], (double)rgb[3 * i + 2]));
        rgb[3 * i] = (float)v.x, rgb[3 * i + 1] = (float)v.y, rgb[3 * i + 2] = (float)v.z;
    }
    log_info(log, "environment: converted to the picture's primaries (chromaticities of both files)");
}

static bool to_linear(void *context, float *rgb, size_t n, error *e)
{
    const env_options *options = context;
    return colour_to_scene_linear(options->ocio, options->colorspace, rgb, n, e);
}

bool environment_load(const env_options *options, environment *out, log_t *log, error *e)
{
    static const float white[3] = {1, 1, 1};
    *out = (environment){0};
    if (!options->path) {
        if (!environment_prepare(white, 1, 1, options, out, log, e)) return false;
        out->white = true;
        return true;
    }
    int width, height;
    float *rgb = NULL;
    map_primaries primaries;
    const latlong_options reading = {.path = options->path,
                                     .threads = options->threads,
                                     .convert = options->colorspace ? to_linear : NULL,
                                     .context = (void *)(uintptr_t)options};
    if (!latlong_read(&reading, &width, &height, &rgb, &primaries, log, e)) return false;
    if (!options->colorspace) match_primaries(options, &primaries, rgb, (size_t)width * (size_t)height, log);
    bool ok = environment_prepare(rgb, width, height, options, out, log, e);
    free(rgb);
    return ok;
}
