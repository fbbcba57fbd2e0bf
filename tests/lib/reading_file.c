#include "reading_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <OpenEXR/openexr_attr.h>

#include "base/half.h"
#include "base/mem.h"
#include "exr/write.h"
#include "scene_list.h"

enum { FINE = 5, REACH = 2 };
enum { POSITION, NORMAL = 3, DEPTH = 6, ALPHA, CHANNELS };

// ---- the master

static void flat_scene(scene *s)
{
    scene_add_quad(s, v3(-4, -4, 0), v3(8, 0, 0), v3(0, 8, 0), v3(0.6, 0.6, 0.6));
    scene_add_quad(s, v3(-4, 2.5, 0), v3(8, 0, 0), v3(0, 0, 4), v3(0.6, 0.5, 0.4));
    scene_add_box(s, v3(-1.2, 0.4, 0.6), v3(0.6, 0.5, 0.6), 20.0, v3(0.7, 0.2, 0.2));
    scene_add_box(s, v3(1.0, 0.8, 0.9), v3(0.5, 0.5, 0.9), -35.0, v3(0.2, 0.7, 0.2));
    scene_add_box(s, v3(0.2, -0.9, 0.3), v3(0.4, 0.3, 0.3), 60.0, v3(0.2, 0.2, 0.7));
}

// With the background around it.
static void round_scene(scene *s)
{
    scene_add_disc(s, v3(0, 0, 0), v3(0, 0, 1), 2.4, v3(0.6, 0.6, 0.5));
    scene_add_sphere(s, v3(-0.8, -0.3, 0.6), 0.6, v3(0.8, 0.2, 0.1));
    scene_add_sphere(s, v3(0.8, 0.3, 0.9), 0.9, v3(0.2, 0.3, 0.8));
    scene_add_sphere(s, v3(0.1, -1.2, 0.35), 0.35, v3(0.2, 0.8, 0.3));
}

static void build(reading_scene kind, int width, int height, scene *s, view *v)
{
    *s = (scene){0};
    *v = kind == SCENE_ORTHO ? view_orthographic(width, height, 6.0, 1.0)
                             : view_perspective(width, height, kind == SCENE_ROUND ? 35.0 : 45.0, 1.0);
    if (kind == SCENE_FLAT) flat_scene(s);
    if (kind == SCENE_ROUND || kind == SCENE_BUMPY) round_scene(s);
    if (kind == SCENE_FACETS) scene_rocks(s);
    if (kind == SCENE_ORTHO) scene_clutter(s);
    if (kind == SCENE_FACETS || kind == SCENE_ORTHO)
        view_scene(v, s);
    else
        view_look(v, v3(1.5, -5.5, 3.2), v3(0, 0.2, 0.5), 4.0);
}

// A normal map of waves, some 8 degrees steep.
static vec3 bumped(vec3 n, vec3 p)
{
    vec3 d = v3(sin(17.0 * p.x + 3.0 * p.z), sin(19.0 * p.y - 2.0 * p.x), sin(13.0 * p.z + 5.0 * p.y));
    return v3_normalize(v3_add(n, v3_scale(d, 0.14)));
}

bool master_make(reading_scene kind, int scale, master *m, error *e)
{
    scene s;
    *m = (master){.near = INFINITY, .width = scale * READING_WIDTH, .height = scale * READING_HEIGHT};
    const int fine_width = m->width * FINE, fine_height = m->height * FINE;
    const size_t count = (size_t)fine_width * (size_t)fine_height;
    build(kind, m->width, m->height, &s, &m->view);
    m->radius = 0.6;
    m->position = mem_zero(count, sizeof *m->position, e);
    m->normal = mem_zero(count, sizeof *m->normal, e);
    if (!m->position || !m->normal) return false;
    tracer t = scene_tracer(&s);
    mat3 to_camera = m3_transpose(m->view.camera.world_from_camera);
    for (int y = 0; y < fine_height; y++)
        for (int x = 0; x < fine_width; x++) {
            vec3 origin, direction;
            hit h;
            size_t i = (size_t)y * (size_t)fine_width + (size_t)x;
            view_ray(&m->view, (x + 0.5) / FINE, (y + 0.5) / FINE, &origin, &direction);
            if (!t.closest(t.data, origin, direction, 0.0, INFINITY, &h) || h.t > 60.0) continue;
            m->position[i] = m3_apply(to_camera, v3_sub(h.position, m->view.camera.origin));
            m->normal[i] = m3_apply(to_camera, kind == SCENE_BUMPY ? bumped(h.normal, h.position) : h.normal);
            m->near = fmin(m->near, m->position[i].z), m->far = fmax(m->far, m->position[i].z);
        }
    m->near *= 0.7, m->far *= 1.2;
    return true;
}

void master_free(master *m)
{
    free(m->position);
    free(m->normal);
}

// ---- one case

// The axes of the vectors stored in a space: rows.
static mat3 space_axes(const reading_case *c, reading_space space)
{
    if (space == EYE_BACK) return (mat3){{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    if (space == EYE_FORWARD) return (mat3){{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}};
    if (space == EYE_DOWN) return m3_identity();
    // Looking along +y of a world with z up, then turned.
    const mat3 ahead = {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}};
    const vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mat3 r = m3_mul(rotation_about(axes[c->axis], c->turn), ahead);
    if (space == OBJECT) r = m3_mul(rotation_about(v3(0.48, 0.6, 0.64), 77.0), r);
    for (int k = 0; k < 3 && c->mirrored; k++) r.m[1][k] = -r.m[1][k];
    return r;
}

static vec3 stored_position(const reading_case *c, vec3 p)
{
    vec3 q = m3_apply(space_axes(c, c->position), p);
    if (c->position == WORLD) q = v3_add(q, v3(1.5, -5.5, 3.2));
    if (c->position == OBJECT) q = v3_add(q, v3(-12, 3, 7));
    return q;
}

static double encoded(normal_encoding e, double n)
{
    double u = 0.5 * (n + 1.0);
    switch (e) {
    case NORMAL_UNORM:
        return u;
    case NORMAL_GAMMA:
        return pow(u, 1.0 / 2.2);
    case NORMAL_SRGB:
        return u <= 0.0031308 ? 12.92 * u : 1.055 * pow(u, 1.0 / 2.4) - 0.055;
    case NORMAL_DEGAMMA:
        return pow(u, 2.2);
    case NORMAL_DESRGB:
        return u <= 0.04045 ? u / 12.92 : pow((u + 0.055) / 1.055, 2.4);
    default:
        return n;
    }
}

static double stored_depth(const master *m, const reading_case *c, vec3 p)
{
    double z = p.z, n = m->near, f = m->far, sign = c->negative_depth ? -1.0 : 1.0;
    double linear = (z - n) / (f - n), hyperbolic = f * (z - n) / (z * (f - n));
    const double by_kind[DEPTH_KINDS] = {
        0, z, v3_length(p), 1.0 / z, linear, 1.0 - linear, hyperbolic, 1.0 - hyperbolic, 2.0 * hyperbolic - 1.0};
    const double v = sign * by_kind[c->depth], changed[READING_CHANGES] = {v, sqrt(v), log(v), v - n};
    return changed[c->change];
}

static double background_depth(const reading_case *c)
{
    bool one = c->depth == DEPTH_LINEAR || c->depth == DEPTH_ZBUFFER || c->depth == DEPTH_NDC;
    return one ? 1.0 : c->depth <= DEPTH_RADIAL && c->filter == FILTER_CLOSEST && !c->negative_depth ? 1e10 : 0.0;
}

// One fine sample as the renderer would store it.
static void sample(const master *m, const reading_case *c, size_t i, double out[CHANNELS])
{
    vec3 p = m->position[i];
    memset(out, 0, CHANNELS * sizeof *out);
    out[DEPTH] = background_depth(c);
    if (!(p.z > 0.0)) return;
    vec3 q = stored_position(c, p), n = m3_apply(space_axes(c, c->normal), m->normal[i]);
    const double position[3] = {q.x, q.y, q.z}, normal[3] = {n.x, n.y, n.z};
    for (int k = 0; k < 3; k++) {
        out[POSITION + k] = position[k];
        out[NORMAL + k] = encoded(c->encoding, c->flips >> k & 1 ? -normal[k] : normal[k]);
    }
    out[DEPTH] = stored_depth(m, c, p), out[ALPHA] = 1.0;
}

static double kernel(reading_filter f, double x)
{
    x = fabs(x);
    if (f == FILTER_BOX) return x < 0.5;
    if (f == FILTER_GAUSS) return x < 1.5 ? exp(-2.0 * x * x) - exp(-4.5) : 0.0;
    const double pi = 3.14159265358979323846;
    return x >= 2.0 ? 0.0 : x < 1e-9 ? 1.0 : 2.0 * sin(pi * x) * sin(0.5 * pi * x) / (pi * pi * x * x); // Lanczos
}

// Filters a line of `count` pixels out of FINE samples each, `stride` apart; beyond the ends the last sample goes on.
static void filter_line(reading_filter f, const double *in, size_t in_stride, int count, double *out, size_t out_stride)
{
    double weights[2 * REACH * FINE + 1], sum = 0.0;
    for (int k = 0; k <= 2 * REACH * FINE; k++) sum += weights[k] = kernel(f, (double)(k - REACH * FINE) / FINE);
    for (int x = 0; x < count; x++) {
        double *to = out + (size_t)x * out_stride;
        memset(to, 0, CHANNELS * sizeof *to);
        for (int k = 0; k <= 2 * REACH * FINE; k++) {
            if (weights[k] == 0.0) continue;
            int u = x * FINE + FINE / 2 + k - REACH * FINE, most = count * FINE - 1;
            const double *from = in + (size_t)(u < 0 ? 0 : u > most ? most : u) * in_stride;
            for (int c = 0; c < CHANNELS; c++) to[c] += weights[k] / sum * from[c];
        }
    }
}

// All pixels, CHANNELS each, as the renderer stores them.
static bool make_pixels(const master *m, const reading_case *c, double *out, error *e)
{
    const size_t width = (size_t)m->width, height = (size_t)m->height, fine_width = width * FINE, fine_height = height * FINE;
    if (c->filter == FILTER_CLOSEST) {
        for (size_t i = 0; i < width * height; i++) {
            size_t u = i % width * FINE + FINE / 2 + (size_t)c->aside, v = i / width * FINE + FINE / 2;
            sample(m, c, v * fine_width + u, out + i * CHANNELS);
        }
        return true;
    }
    double *line = mem_pixels(fine_width, CHANNELS * sizeof *line, e);
    double *columns = mem_pixels(width * fine_height, CHANNELS * sizeof *line, e);
    bool ok = line && columns;
    for (size_t v = 0; ok && v < fine_height; v++) {
        for (size_t u = 0; u < fine_width; u++) sample(m, c, v * fine_width + u, line + u * CHANNELS);
        filter_line(c->filter, line, CHANNELS, m->width, columns + v * width * CHANNELS, CHANNELS);
    }
    for (size_t x = 0; ok && x < width; x++)
        filter_line(c->filter, columns + x * CHANNELS, width * CHANNELS, m->height, out + x * CHANNELS, width * CHANNELS);
    free(line);
    free(columns);
    return ok;
}

typedef struct sheet {
    void *data[CHANNELS];
    sample_type type[CHANNELS];
    char names[CHANNELS][32];
    bool there[CHANNELS];
} sheet;

static void name_channels(const reading_case *c, sheet *s)
{
    static const char *const layers[2][2] = {{"P", "N"}, {"position", "normal"}};
    const char *letters = c->layout == LAYOUT_RGB ? "RGB" : "XYZ";
    for (int k = 0; k < 6; k++) {
        s->there[k] = k < 3 ? c->position != ABSENT : c->normal != ABSENT;
        if (c->layout == LAYOUT_PARTS)
            snprintf(s->names[k], sizeof s->names[k], "%c", letters[k % 3]);
        else
            snprintf(s->names[k], sizeof s->names[k], "%s.%c", layers[c->layout == LAYOUT_RGB][k / 3], letters[k % 3]);
    }
    s->there[DEPTH] = c->depth != DEPTH_AUTO, s->there[ALPHA] = true;
    snprintf(s->names[DEPTH], sizeof s->names[DEPTH], "Z");
    snprintf(s->names[ALPHA], sizeof s->names[ALPHA], "A");
}

static bool write_sheet(const master *m, const reading_case *c, const sheet *s, const char *path, error *e)
{
    static const char *const part_names[4] = {"P", "N", "depth", "rgba"};
    static const int first[5] = {POSITION, 3, DEPTH, ALPHA, CHANNELS};
    exrio_out_channel channels[CHANNELS];
    exrio_out_part parts[4];
    int used = 0, count = 0;
    for (int p = 0; p < 4; p++) {
        int before = used;
        for (int k = first[p]; k < first[p + 1]; k++)
            if (s->there[k]) channels[used++] = (exrio_out_channel){s->names[k], s->type[k], s->data[k]};
        if (used == before) continue;
        if (count > 0 && c->layout != LAYOUT_PARTS) {
            parts[0].channel_count = used;
            continue;
        }
        parts[count++] = (exrio_out_part){.name = c->layout == LAYOUT_PARTS ? part_names[p] : NULL,
                                          .data_window = m->view.data_window,
                                          .display_window = m->view.display_window,
                                          .pixel_aspect = 1.0f,
                                          .compression = EXR_COMPRESSION_ZIP,
                                          .channels = channels + before,
                                          .channel_count = used - before};
    }
    return exrio_write(path, parts, count, 1, e);
}

bool reading_write(const master *m, const reading_case *c, const char *path, error *e)
{
    sheet s = {0};
    const size_t count = (size_t)m->width * (size_t)m->height;
    bool ok = true;
    name_channels(c, &s);
    for (int k = 0; ok && k < CHANNELS; k++) {
        s.type[k] = k >= 3 && k < DEPTH && c->half_normals ? SAMPLE_HALF : SAMPLE_FLOAT;
        s.data[k] = mem_pixels(count, sample_size(s.type[k]), e);
        ok = s.data[k] != NULL;
    }
    double *pixels = ok ? mem_pixels(count, CHANNELS * sizeof *pixels, e) : NULL;
    ok = pixels && make_pixels(m, c, pixels, e);
    for (size_t i = 0; ok && i < count; i++) {
        const double *v = pixels + i * CHANNELS;
        for (int k = 0; k < CHANNELS; k++)
            if (s.type[k] == SAMPLE_HALF)
                ((uint16_t *)s.data[k])[i] = float_to_half((float)v[k]);
            else
                ((float *)s.data[k])[i] = (float)v[k];
    }
    free(pixels);
    ok = ok && write_sheet(m, c, &s, path, e);
    for (int k = 0; k < CHANNELS; k++) free(s.data[k]);
    return ok;
}

void reading_name(const reading_case *c, char *buf, size_t size)
{
    static const char *const scenes[] = {"flat", "round", "bumpy", "facets", "ortho"};
    static const char *const spaces[] = {"absent", "world", "camera", "camera z+", "camera y-", "object"};
    static const char *const encodings[] = {"signed", "unorm", "gamma", "srgb", "degamma", "desrgb"};
    static const char *const filters[] = {"closest", "box", "gauss", "lobes"};
    static const char *const layouts[] = {"XYZ", "RGB", "parts"};
    static const char *const changes[] = {"", "square root of ", "logarithm of ", "less near, "};
    const char *depth_name = c->depth == DEPTH_AUTO ? "auto" : word_of(depth_kind_words, c->depth);
    snprintf(buf, size, "%s, turned %g about %c%s, P %s, N %s %s%s flips %d, Z %s%s%s, %s, %s", scenes[c->scene], c->turn,
             "xyz"[c->axis], c -> mirrored ? " mirrored" : "", spaces[c->position], spaces[c->normal], encodings[c->encoding],
             c->half_normals ? " half" : "", c->flips, changes[c->change], c->negative_depth ? "-" : "", depth_name,
             filters[c->filter], layouts[c->layout]);
}
