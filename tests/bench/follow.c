// Scores the steadiness of occlusion over a rendered shot (samples/render.py --shot) in which nothing moves but the camera.
//
//     follow DIR NAME OUT FRAMES   OUT/NAME.0001.exr ... against DIR/NAME.0001.exr ... and DIR/NAME_truth.0001.exr ...
//
// Points of surfaces are followed from each frame to the next. The score is the root mean square of how much more a point's
// occlusion changes than the truth's does, over all points that both frames show; the truth's noise is left out, as there are two
// renders of it (tests/lib/sample.h).
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gbuffer/world_view.h"
#include "sample.h"

typedef struct frame {
    world_view view;
    float *made, *truth[2]; // occlusion, one a pixel
} frame;

enum { MOST_PIXELS = 1 << 22 };

static bool read_view(const char *path, world_view *out, error *e)
{
    static const role wanted[] = {ROLE_POSITION, ROLE_NORMAL, ROLE_DEPTH};
    exrio_file *file = NULL;
    resolution r;
    bool ok = exrio_file_open(path, &file, e) && resolve_channels(file, &(resolve_options){0}, &r, NULL, e);
    for (int i = 0; ok && i < 3; i++)
        for (int k = 0; k < r.components[wanted[i]]; k++) {
            const channel_ref at = r.channels[wanted[i]][k];
            if (at.part >= 0) file->parts[at.part].channels[at.channel].wanted = true;
        }
    ok = ok && exrio_file_load(file, 0, e) && world_view_read(file, &r, &(gbuffer_options){0}, MOST_PIXELS, out, NULL, e);
    exrio_file_close(file);
    return ok;
}

static void free_frame(frame *f)
{
    world_view_free(&f->view);
    free(f->made);
    for (int i = 0; i < 2; i++) free(f->truth[i]);
    *f = (frame){0};
}

static bool read_frame(const char *dir, const char *name, const char *out, int number, frame *f, error *e)
{
    char seen[512], truth[512], made[512];
    snprintf(seen, sizeof seen, "%s/%s.%04d.exr", dir, name, number);
    snprintf(truth, sizeof truth, "%s/%s_truth.%04d.exr", dir, name, number);
    snprintf(made, sizeof made, "%s/%s.%04d.exr", out, name, number);
    return read_view(seen, &f->view, e) && (f->made = sample_read(made, "occlusion", "R", e)) &&
           (f->truth[0] = sample_read(seen, "ViewLayer.AO", "R", e)) &&
           (f->truth[1] = sample_read(truth, "ViewLayer.AO", "R", e));
}

static vec3 normal_of(const world_view *v, size_t i)
{
    const float *n = v->surface + 4 * i + 1;
    return m3_apply(v->camera.world_from_camera, v3((double)n[0], (double)n[1], (double)n[2]));
}

static vec3 point_of(const world_view *v, int x, int y)
{
    double z = (double)v->surface[4 * ((size_t)y * (size_t)v->width + (size_t)x)];
    vec3 p = v3((x + 0.5 - v->camera.cx) / v->camera.fx * z, (y + 0.5 - v->camera.cy) / v->camera.fy * z, z);
    return v3_add(v->camera.origin, m3_apply(v->camera.world_from_camera, p));
}

// Made, truth A and truth B at a point of a surface, linear between pixels. False unless all four pixels around it show that
// surface.
static bool value_at(const frame *f, vec3 point, vec3 normal, double out[3])
{
    const double ALIKE = 0.99, OFF = 0.004; // cosine; distance from the surface, as a share of the depth
    const world_view *v = &f->view;
    vec3 p = m3_apply(m3_transpose(v->camera.world_from_camera), v3_sub(point, v->camera.origin));
    if (!(p.z > 0.0)) return false;
    double x = p.x / p.z * v->camera.fx + v->camera.cx - 0.5, y = p.y / p.z * v->camera.fy + v->camera.cy - 0.5;
    if (!(x >= 0.0 && y >= 0.0 && x < v->width - 1 && y < v->height - 1)) return false;
    out[0] = out[1] = out[2] = 0.0;
    for (int k = 0; k < 4; k++) {
        int px = (int)x + (k & 1), py = (int)y + (k >> 1);
        size_t i = (size_t)py * (size_t)v->width + (size_t)px;
        double w = (k & 1 ? x - (int)x : 1.0 - (x - (int)x)) * (k >> 1 ? y - (int)y : 1.0 - (y - (int)y));
        if (v->surface[4 * i] <= 0.0f || v3_dot(normal_of(v, i), normal) < ALIKE) return false;
        if (fabs(v3_dot(normal, v3_sub(point_of(v, px, py), point))) > OFF * p.z) return false;
        out[0] += w * (double)f->made[i];
        for (int t = 0; t < 2; t++) out[1 + t] += w * (double)f->truth[t][i];
    }
    return true;
}

// Adds the squares of a pair of frames.
static void compare(const frame *a, const frame *b, double *sum, double *count)
{
    for (int y = 0; y < a->view.height; y++)
        for (int x = 0; x < a->view.width; x++) {
            size_t i = (size_t)y * (size_t)a->view.width + (size_t)x;
            double was[3], is[3];
            if (a->view.surface[4 * i] <= 0.0f) continue;
            vec3 p = point_of(&a->view, x, y), n = normal_of(&a->view, i);
            if (!value_at(a, p, n, was) || !value_at(b, p, n, is)) continue;
            double made = is[0] - was[0];
            *sum += (made - (is[1] - was[1])) * (made - (is[2] - was[2])), *count += 1.0;
        }
}

int main(int argc, char **argv)
{
    setlocale(LC_ALL, "C");
    if (argc != 5) return fprintf(stderr, "usage: follow DIR NAME OUT FRAMES\n"), 2;
    error e = {0};
    static frame two[2];
    double sum = 0.0, count = 0.0;
    bool ok = true;
    for (int f = 1; ok && f <= atoi(argv[4]); f++) {
        frame *now = &two[f & 1], *before = &two[~f & 1];
        free_frame(now);
        ok = read_frame(argv[1], argv[2], argv[3], f, now, &e);
        if (ok && f > 1) compare(before, now, &sum, &count);
    }
    for (int i = 0; i < 2; i++) free_frame(&two[i]);
    if (!ok || count == 0.0) {
        char text[ERROR_TEXT] = "no point is seen twice";
        if (!ok) err_format(&e, text, sizeof text);
        return fprintf(stderr, "follow: %s\n", text), 1;
    }
    printf("| %s | %.0f | %.4f |\n", argv[2], count, sqrt(fmax(sum / count, 0.0)));
    return 0;
}
