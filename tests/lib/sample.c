#include "sample.h"

#include <json-c/json.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "base/mem.h"
#include "base/sort.h"
#include "exr/file.h"

static double number(json_object *o, const char *key)
{
    json_object *v;
    return json_object_object_get_ex(o, key, &v) ? json_object_get_double(v) : 0.0;
}

static void text(json_object *o, const char *key, const char *dir, char *to, size_t size)
{
    json_object *v;
    *to = 0;
    if (json_object_object_get_ex(o, key, &v) && v)
        snprintf(to, size, "%s%s%s", dir ? dir : "", dir ? "/" : "", json_object_get_string(v));
}

static double element(json_object *list, int i)
{
    return list ? json_object_get_double(json_object_array_get_idx(list, (size_t)i)) : 0.0;
}

static void read_camera(json_object *c, sample *s)
{
    json_object *v = NULL;
    s->orthographic = json_object_object_get_ex(c, "type", &v) && strcmp(json_object_get_string(v), "orthographic") == 0;
    if (json_object_object_get_ex(c, "focal_px", &v) && v) s->focal = element(v, 0);
    s->pixels_per_unit = number(c, "pixels_per_unit");
    if (json_object_object_get_ex(c, "principal_px", &v) && v)
        for (int i = 0; i < 2; i++) s->principal[i] = element(v, i);
    if (json_object_object_get_ex(c, "matrix_world", &v) && v)
        for (int r = 0; r < 4; r++)
            for (int k = 0; k < 4; k++) s->matrix_world[r][k] = element(json_object_array_get_idx(v, (size_t)r), k);
}

int samples_list(const char *dir, sample *list, int max, error *e)
{
    char path[512];
    snprintf(path, sizeof path, "%s/scenes.json", dir);
    json_object *root = json_object_from_file(path), *v;
    int n = 0;
    for (; root && n < max && n < (int)json_object_array_length(root); n++) {
        json_object *o = json_object_array_get_idx(root, (size_t)n);
        sample *s = &list[n];
        *s = (sample){0};
        text(o, "name", NULL, s->name, sizeof s->name);
        text(o, "file", dir, s->file, sizeof s->file);
        text(o, "truth", dir, s->truth, sizeof s->truth);
        text(o, "env", dir, s->env, sizeof s->env);
        s->env_rotate = number(o, "env_rotate_deg");
        s->ao_distance = number(o, "ao_distance");
        s->scene_size = number(o, "scene_size");
        s->film_transparent = json_object_object_get_ex(o, "film_transparent", &v) && json_object_get_boolean(v);
        if (json_object_object_get_ex(o, "camera", &v)) read_camera(v, s);
    }
    if (root) json_object_put(root);
    if (n == 0) err_set(e, ERR_INPUT, path, NULL, "no scenes are listed here");
    return n;
}

static float value_at(const exrio_channel *c, size_t i)
{
    if (c->type == SAMPLE_HALF) return half_to_float(((const uint16_t *)c->data)[i]);
    return ((const float *)c->data)[i];
}

// Components `letters` of layer `name`, interleaved; NULL (no error) if the file has none.
static float *take(const exrio_file *f, const char *name, const char *letters, error *e)
{
    const exrio_part *p = &f->parts[0];
    size_t n = (size_t)box2_width(p->data_window) * (size_t)box2_height(p->data_window), channels = strlen(letters);
    float *out = mem_pixels(n * channels, sizeof *out, e);
    for (size_t k = 0; out && k < channels; k++) {
        char wanted[128];
        const exrio_channel *found = NULL;
        snprintf(wanted, sizeof wanted, "%s.%c", name, letters[k]);
        for (int c = 0; c < p->channel_count; c++)
            if (strcmp(p->channels[c].name, wanted) == 0) found = &p->channels[c];
        if (!found) {
            free(out);
            err_set(e, ERR_INPUT, f->path, wanted, "the sample has no such channel");
            return NULL;
        }
        for (size_t i = 0; i < n; i++) out[i * channels + k] = value_at(found, i);
    }
    return out;
}

static exrio_file *open_all(const char *path, error *e)
{
    exrio_file *f = NULL;
    if (!exrio_file_open(path, &f, e)) return NULL;
    for (int c = 0; c < f->parts[0].channel_count; c++) f->parts[0].channels[c].wanted = true;
    if (exrio_file_load(f, 2, e)) return f;
    exrio_file_close(f);
    return NULL;
}

float *sample_read(const char *path, const char *layer, const char *letters, error *e)
{
    exrio_file *f = open_all(path, e);
    float *v = f ? take(f, layer, letters, e) : NULL;
    exrio_file_close(f);
    return v;
}

static bool has_surface(const sample *s, int x, int y)
{
    if (x < 0 || y < 0 || x >= s->width || y >= s->height) return true;
    float depth = s->depth[y * s->width + x];
    return depth > 0.0f && depth < 1e9f;
}

// Coverage is A on transparent film; on opaque film the averaged normal is shorter where background takes part.
static bool is_filled(const sample *s, int x, int y)
{
    int i = y * s->width + x;
    const float *n = s->normal + 3 * i;
    if (!has_surface(s, x, y)) return false;
    if (s->film_transparent) return s->alpha[i] > 0.999f;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++)
            if (!has_surface(s, x + dx, y + dy)) return n[0] * n[0] + n[1] * n[1] + n[2] * n[2] > 0.998f;
    return true;
}

static bool find_scored(sample *s, error *e)
{
    s->scored = mem_zero((size_t)s->width * (size_t)s->height, sizeof *s->scored, e);
    for (int y = 0; s->scored && y < s->height; y++)
        for (int x = 0; x < s->width; x++) s->scored[y * s->width + x] = is_filled(s, x, y);
    return s->scored != NULL;
}

bool sample_load(sample *s, error *e)
{
    exrio_file *main = open_all(s->file, e), *truth = main ? open_all(s->truth, e) : NULL;
    bool ok = false;
    if (!main || !truth) goto out;
    s->width = box2_width(main->parts[0].data_window);
    s->height = box2_height(main->parts[0].data_window);
    s->depth = take(main, "ViewLayer.Depth", "Z", e);
    s->normal = take(main, "ViewLayer.Normal", "XYZ", e);
    s->albedo = take(main, "ViewLayer.DiffCol", "RGB", e);
    s->beauty = take(main, "ViewLayer.Combined", "RGB", e);
    s->alpha = take(main, "ViewLayer.Combined", "A", e);
    s->ao[0] = take(main, "ViewLayer.AO", "R", e);
    s->direct[0] = take(main, "ViewLayer.DiffDir", "RGB", e);
    s->indirect[0] = take(main, "ViewLayer.DiffInd", "RGB", e);
    s->ao[1] = take(truth, "AO", "R", e);
    s->direct[1] = take(truth, "DiffDir", "RGB", e);
    s->indirect[1] = take(truth, "DiffInd", "RGB", e);
    ok = e->code == ERR_NONE && find_scored(s, e);
out:
    exrio_file_close(main);
    exrio_file_close(truth);
    if (!ok) sample_free(s);
    return ok;
}

void sample_free(sample *s)
{
    float **all[] = {&s->depth,     &s->normal,    &s->albedo, &s->beauty,      &s->alpha,      &s->ao[0],
                     &s->direct[0], &s->direct[1], &s->ao[1],  &s->indirect[0], &s->indirect[1]};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        free(*all[i]);
        *all[i] = NULL;
    }
    free(s->scored);
    s->scored = NULL;
}

score sample_score(const sample *s, const float *x, const float *a, const float *b, int channels)
{
    double n = 0, se = 0, bias = 0, sx = 0, sa = 0, sb = 0, sab = 0, sxx = 0, sxt = 0;
    size_t pixels = (size_t)s->width * (size_t)s->height, kept = 0;
    double *errors = malloc(sizeof *errors * pixels * (size_t)channels);
    for (size_t i = 0; errors && i < pixels; i++)
        for (int k = 0; sample_is_surface(s, (int)i) && k < channels; k++) {
            size_t j = i * (size_t)channels + (size_t)k;
            double v = (double)x[j], p = (double)a[j], q = (double)b[j], t = 0.5 * (p + q);
            n += 1;
            se += (v - p) * (v - q);
            bias += v - t;
            sx += v, sa += p, sb += q, sab += p * q, sxx += v * v, sxt += v * t;
            errors[kept++] = fabs(v - t);
        }
    score r = {0};
    if (!errors || n == 0) return r;
    sort_doubles(errors, kept);
    double mean = 0.5 * (sa + sb) / n, variance_x = sxx / n - sx / n * sx / n, variance_t = sab / n - sa / n * sb / n;
    r.rmse = sqrt(fmax(0.0, se / n));
    r.bias = bias / n;
    r.p99 = errors[(size_t)(0.99 * (double)(kept - 1))];
    r.mean = mean;
    r.constant_rmse = sqrt(fmax(0.0, variance_t)); // the best constant is the mean
    r.correlation = variance_x > 0 && variance_t > 0 ? (sxt / n - sx / n * mean) / sqrt(variance_x * variance_t) : 0.0;
    r.gain = sxx > 0 ? sxt / sxx : 0.0;
    free(errors);
    return r;
}
