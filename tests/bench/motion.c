// A shot of the test still life, the camera sliding past it: what the noise of the layers does in motion, and on flat patches.
//
//     motion write WIDTH HEIGHT DIR [curtain]       the frames' G-buffers, DIR/in.1.exr ...
//     motion score WIDTH HEIGHT DIR NAME [curtain]  of DIR/NAME.1.exr ..., a line for each layer: its name, change, residual
//     motion flat SAMPLES DIR             of DIR/NAME.exr of every rendered sample, for each layer: sample, layer, residual,
//     beyond the truth's, windows
//
// With `curtain`: pillars before a wall and a curtain beside one of them, and the camera turns away until the curtain has left
// the frame. Of the occlusion alone, for a radius of 0.8.
//
// Change: surface points are followed by their positions. The scene and its light stand still and the layers do not depend on the
// view, so in truth nothing at a point changes. What changes from frame to frame is the noise, and what the view shows otherwise:
// the root mean square over points and frames; of light over its mean. Points that an edge passes are left out.
// Residual: on windows of a frame that show one plane, the root mean square of what is left of the layer beside its best linear
// fit, over the window's mean; root mean square over the windows.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sample.h"
#include "scene_picture.h"

enum { FRAMES = 8, LAYERS = 3, WINDOW = 9 };
static const double SLIDE = 1.3;          // pixels a frame at the middle of the scene, of a picture 480 pixels wide
static const double SAME_SURFACE = 0.002; // relative distance of a followed point from its four pixels' plane
static const struct {
    const char *name, *letters;
} layers[LAYERS] = {{"occlusion", "R"}, {"radiance", "RGB"}, {"indirect", "RGB"}};

typedef struct shot {
    scene scene;
    view view[FRAMES];
    picture picture[FRAMES];
    float *values[FRAMES]; // of one layer, luminance
} shot;

static void set_cameras(shot *s, int width, int height)
{
    scene_clutter(&s->scene);
    for (int f = 0; f < FRAMES; f++) {
        view *v = &s->view[f];
        *v = view_perspective(width, height, 50.0, 1.0);
        view_scene(v, &s->scene);
        double far = v3_length(v3_sub(s->scene.target, s->scene.eye)), pixel = far / v->camera.fx * width / 480.0;
        const double(*m)[3] = (const double(*)[3])v->camera.world_from_camera.m;
        v->camera.origin = v3_add(v->camera.origin, v3_scale(v3(m[0][0], m[1][0], m[2][0]), f * SLIDE * pixel));
    }
}

static void set_curtain(shot *s, int width, int height)
{
    enum { FOLDS = 6 };
    const vec3 grey = {0.5, 0.5, 0.5};
    scene_add_plane(&s->scene, v3(0, 0, 0), v3(0, 0, 1), grey);
    scene_add_plane(&s->scene, v3(0, 4.5, 0), v3(0, -1, 0), grey);
    for (int i = 0; i < 3; i++) scene_add_box(&s->scene, v3(-2.2 + 1.525 * i, 2.0, 2.0), v3(0.25, 0.25, 2.0), 0.0, grey);
    scene_add_sphere(&s->scene, v3(0.1, 1.2, 0.35), 0.35, grey);
    for (int i = 0; i < FOLDS; i++)
        scene_add_quad(&s->scene, v3(i % 2 ? 1.32 : 1.24, 0.9 + 0.8 / FOLDS * i, 0.0), v3(i % 2 ? -0.08 : 0.08, 0.8 / FOLDS, 0),
                       v3(0, 0, 3.2), grey);
    for (int f = 0; f < FRAMES; f++) {
        double turn = (9.3 - 2.0 * f) * M_PI / 180.0; // to the right
        s->view[f] = view_perspective(width, height, 67.4, 1.0);
        view_look(&s->view[f], v3(-0.6, -1.6, 1.4), v3(-0.6 + 6.0 * sin(turn), -1.6 + 6.0 * cos(turn), 1.25), 0.0);
    }
}

static bool write_shot(shot *s, const char *dir, error *e)
{
    for (int f = 0; f < FRAMES; f++) {
        char path[512];
        snprintf(path, sizeof path, "%s/in.%d.exr", dir, f + 1);
        if (!scene_write(&s->scene, &s->view[f], &(scene_exr_options){.convention = "plain"}, path, e)) return false;
    }
    return true;
}

// ---- change

static vec3 triple(const float *p, size_t i) { return v3((double)p[3 * i], (double)p[3 * i + 1], (double)p[3 * i + 2]); }

// The layer of a frame at a world point with a normal; NaN where the frame does not show it whole.
static double value_at(const shot *s, int f, vec3 p, vec3 n)
{
    const picture *g = &s->picture[f];
    double x, y, z, sum = 0.0;
    if (!view_project(&s->view[f], p, &x, &y, &z)) return (double)NAN;
    x -= 0.5, y -= 0.5;
    if (!(x >= 0.0 && y >= 0.0 && x < g->width - 1 && y < g->height - 1)) return (double)NAN;
    double fx = x - floor(x), fy = y - floor(y);
    for (int k = 0; k < 4; k++) {
        size_t i = (size_t)((int)y + (k >> 1)) * (size_t)g->width + (size_t)((int)x + (k & 1));
        if (!g->valid[i] || v3_dot(triple(g->normal, i), n) < 0.99 ||
            fabs(v3_dot(n, v3_sub(triple(g->position, i), p))) > SAME_SURFACE * z)
            return (double)NAN;
        sum += (k & 1 ? fx : 1.0 - fx) * (k >> 1 ? fy : 1.0 - fy) * (double)s->values[f][i];
    }
    return sum;
}

// Points are the pixels of the middle frame.
static double change_of(const shot *s, bool relative)
{
    const picture *g = &s->picture[FRAMES / 2];
    double squares = 0.0, mean = 0.0, count = 0.0, points = 0.0;
    for (size_t i = 0; i < (size_t)g->width * (size_t)g->height; i++) {
        if (!g->valid[i]) continue;
        double last = (double)NAN;
        for (int f = 0; f < FRAMES; f++) {
            double now = value_at(s, f, triple(g->position, i), triple(g->normal, i)), d = now - last;
            if (!isnan(now)) mean += now, points += 1.0;
            if (!isnan(d)) squares += d * d, count += 1.0;
            last = now;
        }
    }
    return sqrt(squares / count) / (relative ? mean / points : 1.0);
}

// ---- residual

static bool is_flat(const picture *g, int x, int y)
{
    size_t middle = (size_t)(y + WINDOW / 2) * (size_t)g->width + (size_t)(x + WINDOW / 2);
    if (!g->valid[middle]) return false;
    vec3 n = triple(g->normal, middle), p = triple(g->position, middle);
    for (int v = y; v < y + WINDOW; v++)
        for (int u = x; u < x + WINDOW; u++) {
            size_t i = (size_t)v * (size_t)g->width + (size_t)u;
            if (!g->valid[i] || v3_dot(triple(g->normal, i), n) < 0.9999 ||
                fabs(v3_dot(n, v3_sub(triple(g->position, i), p))) > 1e-4 * (double)g->depth[i])
                return false;
        }
    return true;
}

typedef struct window {
    double mean, along, down; // sums over the window: of values, and of values times the coordinates about its middle
} window;

static const double PIXELS = WINDOW * WINDOW, MOMENT = WINDOW * WINDOW * (WINDOW * WINDOW - 1) / 12.0; // of a coordinate

static double at(const float *values, int width, int x, int y) { return (double)values[(size_t)y * (size_t)width + (size_t)x]; }

static window window_at(const float *values, int width, int x, int y)
{
    window w = {0};
    for (int v = 0; v < WINDOW; v++)
        for (int u = 0; u < WINDOW; u++) {
            double value = at(values, width, x + u, y + v);
            w.mean += value / PIXELS, w.along += value * (u - WINDOW / 2), w.down += value * (v - WINDOW / 2);
        }
    return w;
}

// Mean product of what is left of a and b on a window beside their best linear fits.
static double left_of(const float *a, const float *b, int width, int x, int y)
{
    window p = window_at(a, width, x, y), q = window_at(b, width, x, y);
    double products = 0.0;
    for (int v = y; v < y + WINDOW; v++)
        for (int u = x; u < x + WINDOW; u++) products += at(a, width, u, v) * at(b, width, u, v);
    return (products - PIXELS * p.mean * q.mean - (p.along * q.along + p.down * q.down) / MOMENT) / PIXELS;
}

typedef struct residual {
    double squares, windows;
} residual;

// Of the fields a and b, over the mean of `values`.
static residual residual_between(const picture *g, const float *values, const float *a, const float *b)
{
    residual r = {0};
    for (int y = 0; y + WINDOW <= g->height; y += WINDOW)
        for (int x = 0; x + WINDOW <= g->width; x += WINDOW) {
            double mean = window_at(values, g->width, x, y).mean;
            if (!(mean > 0.0) || !is_flat(g, x, y)) continue;
            r.squares += left_of(a, b, g->width, x, y) / (mean * mean), r.windows += 1.0;
        }
    return r;
}

static double residual_of(const shot *s)
{
    double squares = 0.0, windows = 0.0;
    for (int f = 0; f < FRAMES; f++) {
        residual r = residual_between(&s->picture[f], s->values[f], s->values[f], s->values[f]);
        squares += r.squares, windows += r.windows;
    }
    return sqrt(squares / windows);
}

// ---- the layers of a run

static float *luminance_of(const float *from, size_t channels, size_t pixels)
{
    float *out = malloc(pixels * sizeof *out);
    for (size_t i = 0; out && i < pixels; i++) {
        const float *p = from + channels * i;
        out[i] = channels == 1 ? *p : (float)luminance((double)p[0], (double)p[1], (double)p[2]);
    }
    return out;
}

static float *luminances(const char *path, int layer, size_t pixels, error *e)
{
    float *read = sample_read(path, layers[layer].name, layers[layer].letters, e),
          *out = read ? luminance_of(read, strlen(layers[layer].letters), pixels) : NULL;
    free(read);
    return out;
}

static bool score_layer(shot *s, int layer, const char *dir, const char *name, error *e)
{
    bool ok = true;
    size_t pixels = (size_t)s->view[0].width * (size_t)s->view[0].height;
    for (int f = 0; ok && f < FRAMES; f++) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s.%d.exr", dir, name, f + 1);
        ok = (s->values[f] = luminances(path, layer, pixels, e)) != NULL;
    }
    if (ok) printf("%s\t%.4f\t%.4f\n", layers[layer].name, change_of(s, layer > 0), residual_of(s));
    for (int f = 0; f < FRAMES; f++) free(s->values[f]), s->values[f] = NULL;
    return ok;
}

static bool score_shot(shot *s, const char *dir, const char *name, int count, error *e)
{
    bool ok = true;
    for (int f = 0; ok && f < FRAMES; f++) ok = scene_picture(&s->scene, &s->view[f], &s->picture[f], e);
    for (int layer = 0; ok && layer < count; layer++) ok = score_layer(s, layer, dir, name, e);
    for (int f = 0; f < FRAMES; f++) picture_free(&s->picture[f]);
    return ok;
}

// ---- the flat patches of the rendered samples

static void subtract(float *a, const float *b, size_t n)
{
    for (size_t i = 0; i < n; i++) a[i] = b[i] - a[i];
}

// A shadow's edge is no noise: what is left of the layer's difference to the truth, too. The truth is rendered twice, so that its
// own noise is left out: it is not the same in both.
static bool flat_layer(const sample *s, const picture *g, int layer, const char *path, error *e)
{
    const float *truth[] = {layer == 0   ? s->ao[0]
                            : layer == 1 ? s->direct[0]
                                         : s->indirect[0],
                            layer == 0   ? s->ao[1]
                            : layer == 1 ? s->direct[1]
                                         : s->indirect[1]};
    size_t pixels = (size_t)s->width * (size_t)s->height, channels = strlen(layers[layer].letters);
    float *values = luminances(path, layer, pixels, e), *a = luminance_of(truth[0], channels, pixels),
          *b = luminance_of(truth[1], channels, pixels);
    bool ok = values && a && b;
    if (ok) {
        residual own = residual_between(g, values, values, values);
        subtract(a, values, pixels), subtract(b, values, pixels);
        residual beyond = residual_between(g, values, a, b);
        if (own.windows > 0.0)
            printf("%s\t%s\t%.4f\t%.4f\t%.0f\n", s->name, layers[layer].name, sqrt(own.squares / own.windows),
                   sqrt(fmax(beyond.squares, 0.0) / beyond.windows), own.windows);
    }
    free(values), free(a), free(b);
    return ok;
}

static bool flat_sample(sample *s, const char *dir, error *e)
{
    char path[1024];
    snprintf(path, sizeof path, "%.512s/%.31s.exr", dir, s->name);
    size_t pixels = (size_t)s->width * (size_t)s->height;
    float *position = sample_read(s->file, "ViewLayer.Position", "XYZ", e);
    unsigned char *valid = calloc(pixels, 1);
    picture g = {s->width, s->height, position, s->normal, NULL, s->depth, valid};
    bool ok = position && valid;
    for (size_t i = 0; ok && i < pixels; i++) valid[i] = s->scored[i];
    for (int layer = 0; ok && layer < LAYERS; layer++) ok = flat_layer(s, &g, layer, path, e);
    free(position), free(valid);
    return ok;
}

static bool flat_samples(const char *samples, const char *dir, error *e)
{
    static sample list[SAMPLE_MAX];
    int n = samples_list(samples, list, SAMPLE_MAX, e);
    bool ok = n > 0;
    for (int i = 0; ok && i < n; i++) {
        ok = sample_load(&list[i], e) && flat_sample(&list[i], dir, e);
        sample_free(&list[i]);
    }
    return ok;
}

int main(int argc, char **argv)
{
    static shot s;
    error e = {0};
    char text[1024];
    bool curtain = argc > 5 && strcmp(argv[argc - 1], "curtain") == 0;
    argc -= curtain;
    bool writes = argc == 5 && strcmp(argv[1], "write") == 0, scores = argc == 6 && strcmp(argv[1], "score") == 0,
         flat = argc == 4 && strcmp(argv[1], "flat") == 0, ok;
    if (!writes && !scores && !flat) return 2;
    if (flat) {
        ok = flat_samples(argv[2], argv[3], &e);
    } else {
        (curtain ? set_curtain : set_cameras)(&s, atoi(argv[2]), atoi(argv[3]));
        ok = writes ? write_shot(&s, argv[4], &e) : score_shot(&s, argv[4], argv[5], curtain ? 1 : LAYERS, &e);
    }
    err_format(&e, text, sizeof text);
    if (!ok) fprintf(stderr, "motion: %s\n", text);
    return ok ? 0 : 1;
}
