// Test scenes as EXR files, in memory and on disk: the second half of scene_picture.h.
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "base/mem.h"
#include "exr/write.h"
#include "scene_picture.h"

typedef struct convention {
    const char *name;
    const char *position[3], *normal[3], *albedo[3], *beauty[4], *depth;
    double background_depth;
} convention;

static const convention conventions[] = {
    {"blender",
     {"ViewLayer.Position.X", "ViewLayer.Position.Y", "ViewLayer.Position.Z"},
     {"ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z"},
     {"ViewLayer.DiffCol.R", "ViewLayer.DiffCol.G", "ViewLayer.DiffCol.B"},
     {"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B", "ViewLayer.Combined.A"},
     "ViewLayer.Depth.Z",
     1e10},
    {"plain", {"P.X", "P.Y", "P.Z"}, {"N.X", "N.Y", "N.Z"}, {"albedo.R", "albedo.G", "albedo.B"}, {"R", "G", "B", "A"}, "Z", 0.0},
};

static const convention *find_convention(const char *name)
{
    for (size_t i = 0; i < sizeof conventions / sizeof *conventions; i++)
        if (!name || !strcmp(conventions[i].name, name)) return &conventions[i];
    return NULL;
}

enum { POSITION = 0, NORMAL = 3, ALBEDO = 6, BEAUTY = 9, DEPTH = 13, VALUES = 14 };

// One pixel's values, in the order above.
typedef struct sample {
    double v[VALUES];
} sample;

static void put3(double *to, vec3 v)
{
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

// From camera/gbuffer axes (y down, z forward) to the y-up, z-backwards axes that renderers call camera space.
static vec3 flipped(vec3 p) { return v3(p.x, -p.y, -p.z); }

// Position and depth of the pixel's centre; background values where there is no surface.
static void geometry(const scene *s, const view *v, const scene_exr_options *o, double background, int x, int y, sample *out)
{
    hit h;
    out->v[DEPTH] = background;
    if (!scene_at_pixel(s, v, x, y, &h)) return;
    vec3 camera_space = m3_apply(m3_transpose(v->camera.world_from_camera), v3_sub(h.position, v->camera.origin));
    put3(out->v + POSITION, o->camera_space ? flipped(camera_space) : h.position);
    out->v[DEPTH] = o->radial_depth ? v3_length(camera_space) : h.t;
}

// Normal, albedo, beauty and alpha: means of n x n sub-samples of the pixel.
static void surface(const scene *s, const view *v, const scene_exr_options *o, int x, int y, sample *out)
{
    tracer t = scene_tracer(s);
    int n = o->edge_samples > 1 ? o->edge_samples : 1;
    double share = 1.0 / (n * n);
    for (int i = 0; i < n * n; i++) {
        vec3 origin, direction;
        hit h;
        int column = i % n, row = i / n;
        view_ray(v, x + (column + 0.5) / n, y + (row + 0.5) / n, &origin, &direction);
        if (!t.closest(t.data, origin, direction, 0.0, INFINITY, &h)) continue;
        vec3 normal = o->camera_space ? flipped(m3_apply(m3_transpose(v->camera.world_from_camera), h.normal)) : h.normal;
        vec3 lit = v3_scale(h.albedo, 0.5 + 0.5 * h.normal.z);
        double values[] = {normal.x, normal.y, normal.z, h.albedo.x, h.albedo.y, h.albedo.z, lit.x, lit.y, lit.z, 1.0};
        for (int k = 0; k < DEPTH - NORMAL; k++) out->v[NORMAL + k] += share * values[k];
    }
}

// The channels that the options leave in: name of the i-th value, or NULL.
static const char *channel_name(const convention *c, const scene_exr_options *o, int i)
{
    if (i < NORMAL) return o->no_position ? NULL : c->position[i];
    if (i < ALBEDO) return o->no_normal ? NULL : c->normal[i - NORMAL];
    if (i < BEAUTY) return o->no_albedo ? NULL : c->albedo[i - ALBEDO];
    if (i < DEPTH) return o->no_beauty ? NULL : c->beauty[i - BEAUTY];
    return o->no_depth ? NULL : c->depth;
}

static bool make_channels(exrio_part *part, const convention *c, const scene_exr_options *o, size_t pixels, int index[VALUES],
                          error *e)
{
    part->channels = mem_zero(VALUES, sizeof *part->channels, e);
    if (!part->channels) return false;
    for (int i = 0; i < VALUES; i++) {
        const char *name = channel_name(c, o, i);
        index[i] = -1;
        if (!name) continue;
        exrio_channel *channel = &part->channels[part->channel_count];
        index[i] = part->channel_count++;
        channel->type = i < NORMAL && o->half_position ? SAMPLE_HALF : SAMPLE_FLOAT;
        channel->wanted = true;
        channel->name = mem_string(name, e);
        channel->data = mem_pixels(pixels, sample_size(channel->type), e);
        if (!channel->name || !channel->data) return false;
    }
    return true;
}

static void store(exrio_channel *channel, size_t pixel, double value)
{
    if (channel->type == SAMPLE_HALF)
        ((uint16_t *)channel->data)[pixel] = float_to_half((float)value);
    else
        ((float *)channel->data)[pixel] = (float)value;
}

static void fill(const scene *s, const view *v, const scene_exr_options *o, double background, exrio_part *part,
                 const int index[VALUES])
{
    for (int y = 0; y < v->height; y++) {
        for (int x = 0; x < v->width; x++) {
            sample one = {{0}};
            geometry(s, v, o, background, x, y, &one);
            surface(s, v, o, x, y, &one);
            size_t pixel = (size_t)y * (size_t)v->width + (size_t)x;
            for (int i = 0; i < VALUES; i++)
                if (index[i] >= 0) store(&part->channels[index[i]], pixel, one.v[i]);
        }
    }
}

void scene_file_free(exrio_file *f)
{
    if (!f) return;
    for (int i = 0; i < f->part_count; i++) {
        exrio_part *part = &f->parts[i];
        for (int c = 0; part->channels && c < part->channel_count; c++) {
            free(part->channels[c].name);
            free(part->channels[c].data);
        }
        free(part->channels);
        free(part->name);
        free(part->view);
    }
    free(f->parts);
    free(f->path);
    free(f);
}

static exrio_file *new_file(const view *v, int compression, error *e)
{
    exrio_file *f = mem_zero(1, sizeof *f, e);
    if (!f) return NULL;
    f->path = mem_string("scene.exr", e);
    f->parts = mem_zero(1, sizeof *f->parts, e);
    if (!f->path || !f->parts) goto out;
    f->part_count = 1;
    f->parts[0].name = mem_string("", e);
    f->parts[0].view = mem_string("", e);
    if (!f->parts[0].name || !f->parts[0].view) goto out;
    f->parts[0].data_window = v->data_window;
    f->parts[0].display_window = v->display_window;
    f->parts[0].pixel_aspect = (float)v->pixel_aspect;
    f->parts[0].compression = compression;
    return f;
out:
    scene_file_free(f);
    return NULL;
}

exrio_file *scene_file(const scene *s, const view *v, const scene_exr_options *options, error *e)
{
    const convention *c = find_convention(options->convention);
    if (!c) {
        err_set(e, ERR_USAGE, NULL, NULL, "unknown naming convention '%s'; use blender or plain", options->convention);
        return NULL;
    }
    exrio_file *f = new_file(v, options->compression, e);
    if (!f) return NULL;
    int index[VALUES];
    if (!make_channels(&f->parts[0], c, options, (size_t)v->width * (size_t)v->height, index, e)) {
        scene_file_free(f);
        return NULL;
    }
    double background = options->background_depth != 0.0 ? options->background_depth : c->background_depth;
    fill(s, v, options, background, &f->parts[0], index);
    return f;
}

bool scene_write(const scene *s, const view *v, const scene_exr_options *options, const char *path, error *e)
{
    exrio_file *f = scene_file(s, v, options, e);
    if (!f) return false;
    exrio_out_channel channels[VALUES];
    exrio_part *from = &f->parts[0];
    for (int i = 0; i < from->channel_count; i++)
        channels[i] = (exrio_out_channel){from->channels[i].name, from->channels[i].type, from->channels[i].data};
    exrio_out_attr marker = {.name = "BlenderMultiChannel", .kind = EXRIO_OUT_STRING, .string = "Blender V2.55.1 and newer"};
    bool blender = !options->convention || !strcmp(options->convention, "blender");
    exrio_out_part part = {.data_window = from->data_window,
                           .display_window = from->display_window,
                           .pixel_aspect = from->pixel_aspect,
                           .compression = options->compression,
                           .channels = channels,
                           .channel_count = from->channel_count,
                           .attributes = &marker,
                           .attribute_count = blender ? 1 : 0};
    bool done = exrio_write(path, &part, 1, 1, e);
    scene_file_free(f);
    return done;
}
