#include "renderer_file.h"

#include <math.h>
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "base/mem.h"

enum { GROUPS = 5, MOST_CHANNELS = 16, NAME = 96 };
enum { POSITION, NORMAL, DEPTH, ALBEDO, BEAUTY };

// One layer of the file: its channels and where they go.
typedef struct layer {
    char layer[NAME], names[4][NAME]; // full channel names
    int components;
    sample_type type;
    void *data[4];
} layer;

typedef struct sheet {
    layer layers[GROUPS];
    box2 window; // data window
} sheet;

static vec3 to_world(world_axes w, vec3 v)
{
    if (w == WORLD_Y_UP) return v3(v.x, v.z, -v.y);
    if (w == WORLD_UNREAL) return v3(v.x, -v.y, v.z);
    return v;
}
static double unit_of(world_axes w) { return w == WORLD_UNREAL ? 100.0 : 1.0; }

static vec3 to_space(const renderer_fact *f, const view *v, vector_space space, vec3 x, bool place)
{
    if (space == IN_WORLD) return v3_scale(to_world(f->world, x), place ? unit_of(f->world) : 1.0);
    vec3 d = m3_apply(m3_transpose(v->camera.world_from_camera), place ? v3_sub(x, v->camera.origin) : x);
    return v3(d.x, -d.y, space == IN_CAMERA_BACK ? -d.z : d.z);
}

// "layer:XYZ" into full channel names; "Z" is a bare scalar, ":RGBA" the unnamed layer, "a:z" the channel a.z.
static void name_layer(const char *text, bool parts, layer *out)
{
    const char *colon = strchr(text, ':'), *components = colon ? colon + 1 : text;
    snprintf(out->layer, NAME, "%.*s", colon ? (int)(colon - text) : 0, text);
    bool bare = !out->layer[0], whole = !colon && strlen(text) > 1;
    out->components = whole ? 1 : (int)strlen(components);
    for (int c = 0; c < out->components; c++)
        if (whole)
            snprintf(out->names[c], NAME, "%s", text);
        else if (bare || parts)
            snprintf(out->names[c], NAME, "%c", components[c]);
        else
            snprintf(out->names[c], NAME, "%.80s.%c", out->layer, components[c]);
}

static void store(layer *l, int c, size_t i, double v)
{
    if (l->type == SAMPLE_HALF)
        ((uint16_t *)l->data[c])[i] = float_to_half((float)v);
    else
        ((float *)l->data[c])[i] = (float)v;
}

static void store3(layer *l, size_t i, vec3 v)
{
    const double values[3] = {v.x, v.y, v.z};
    for (int c = 0; c < l->components && c < 3; c++) store(l, c, i, values[c]);
}

static void fill_pixel(const renderer_fact *f, const scene *s, const view *v, sheet *out, int x, int y, size_t i)
{
    hit h;
    bool there = scene_at_pixel(s, v, x, y, &h);
    double far_p = f->background_position, z = f->background_depth;
    vec3 p = v3(far_p, far_p, far_p), n = v3(0, 0, 0), albedo = n, lit = n;
    if (there) {
        vec3 seen = m3_apply(m3_transpose(v->camera.world_from_camera), v3_sub(h.position, v->camera.origin));
        p = to_space(f, v, f->position_space, h.position, true), n = to_space(f, v, f->normal_space, h.normal, false);
        z = (f->radial ? v3_length(seen) : seen.z) * (f->position_space == IN_WORLD ? unit_of(f->world) : 1.0);
        albedo = h.albedo, lit = v3_scale(h.albedo, 0.5 + 0.5 * h.normal.z);
        if (f->unorm_normals) n = v3_add(v3_scale(n, 0.5), v3(0.5, 0.5, 0.5));
    }
    store3(&out->layers[POSITION], i, p);
    store3(&out->layers[NORMAL], i, n);
    store3(&out->layers[DEPTH], i, v3(z, 0, 0));
    store3(&out->layers[ALBEDO], i, albedo);
    store3(&out->layers[BEAUTY], i, lit);
    if (out->layers[BEAUTY].components > 3) store(&out->layers[BEAUTY], 3, i, there);
}

// The box around what is seen.
static box2 crop_of(const scene *s, const view *v)
{
    box2 b = {v->width, v->height, -1, -1};
    hit h;
    for (int y = 0; y < v->height; y++)
        for (int x = 0; x < v->width; x++) {
            if (!scene_at_pixel(s, v, x, y, &h)) continue;
            b.x0 = x < b.x0 ? x : b.x0, b.x1 = x > b.x1 ? x : b.x1;
            b.y0 = y < b.y0 ? y : b.y0, b.y1 = y > b.y1 ? y : b.y1;
        }
    return b;
}

static bool make_sheet(const renderer_fact *f, const scene *s, const view *v, sheet *out, error *e)
{
    const char *texts[GROUPS] = {f->position, f->normal, f->depth, f->albedo, f->beauty};
    const bool half[GROUPS] = {false, f->half_normals, false, f->half_colours, f->half_colours};
    out->window = f->cropped ? crop_of(s, v) : v->data_window;
    size_t pixels = (size_t)box2_width(out->window) * (size_t)box2_height(out->window);
    for (int g = 0; g < GROUPS; g++) {
        layer *l = &out->layers[g];
        if (!texts[g]) continue;
        name_layer(texts[g], f->layout != ONE_PART, l);
        l->type = half[g] ? SAMPLE_HALF : SAMPLE_FLOAT;
        for (int c = 0; c < l->components; c++)
            if (!(l->data[c] = mem_pixels(pixels, sample_size(l->type), e))) return false;
    }
    size_t i = 0;
    for (int y = out->window.y0; y <= out->window.y1; y++)
        for (int x = out->window.x0; x <= out->window.x1; x++) fill_pixel(f, s, v, out, x, y, i++);
    return true;
}

fact_camera renderer_camera(const renderer_fact *f, const view *v)
{
    const mat3 *m = &v->camera.world_from_camera;
    fact_camera c = {.eye = v3_scale(to_world(f->world, v->camera.origin), unit_of(f->world)),
                     .cot_x = 2.0 * v->camera.fx / v->width,
                     .cot_y = 2.0 * v->camera.fy / v->height};
    c.right = to_world(f->world, v3(m->m[0][0], m->m[1][0], m->m[2][0]));
    c.up = to_world(f->world, v3(-m->m[0][1], -m->m[1][1], -m->m[2][1]));
    c.forward = to_world(f->world, v3(m->m[0][2], m->m[1][2], m->m[2][2]));
    c.fov_degrees = 2.0 * 57.29577951308232 * atan(1.0 / c.cot_x);
    return c;
}

// The layers with numbers first .. last as one part.
static exrio_out_part part_of(sheet *sh, const view *v, int first, int last, exrio_out_channel *channels)
{
    exrio_out_part part = {.data_window = sh->window,
                           .display_window = v->display_window,
                           .pixel_aspect = 1,
                           .compression = EXR_COMPRESSION_ZIP,
                           .channels = channels};
    for (int g = first; g <= last; g++)
        for (int c = 0; c < sh->layers[g].components; c++)
            channels[part.channel_count++] =
                (exrio_out_channel){sh->layers[g].names[c], sh->layers[g].type, sh->layers[g].data[c]};
    return part;
}

static bool write_tiled(const char *path, error *e)
{
    char command[700];
    snprintf(command, sizeof command, "exrmaketiled -o -t 64 64 '%s' '%s.tiled' >/dev/null 2>&1 && mv '%s.tiled' '%s'", path,
             path, path, path);
    if (system(command) == 0) return true;
    return err_set(e, ERR_OUTPUT, path, NULL, "exrmaketiled failed");
}

bool renderer_write(const renderer_fact *f, const scene *s, const view *v, const char *folder, char paths[FACT_FILES][256],
                    int *count, error *e)
{
    static const char *const fallback[GROUPS] = {"position", "normal", "depth", "albedo", "rgba"};
    exrio_out_channel channels[GROUPS][MOST_CHANNELS + 1];
    exrio_out_part parts[GROUPS];
    exrio_out_attr attributes[FACT_ATTRIBUTES];
    char texts[FACT_ATTRIBUTES][32];
    fact_camera c = renderer_camera(f, v);
    sheet sh = {0};
    int attribute_count = f->attributes ? f->attributes(&c, attributes, texts) : 0, n = 0;
    bool ok = make_sheet(f, s, v, &sh, e);
    *count = 0;
    for (int g = 0; ok && f->layout != ONE_PART && g < GROUPS; g++) {
        if (!sh.layers[g].components) continue;
        parts[n] = part_of(&sh, v, g, g, channels[g]);
        parts[n++].name = sh.layers[g].layer[0] ? sh.layers[g].layer : fallback[g];
    }
    if (ok && f->layout == ONE_PART) parts[n++] = part_of(&sh, v, 0, GROUPS - 1, (exrio_out_channel *)channels);
    for (int i = 0; i < n; i++) parts[i].attributes = attributes, parts[i].attribute_count = attribute_count;
    if (f->layout == FILE_PER_LAYER) {
        for (int i = 0; ok && i < n; i++) {
            snprintf(paths[i], 256, "%s/shot_%s.0001.exr", folder, parts[i].name);
            parts[i].name = NULL;
            ok = exrio_write(paths[i], &parts[i], 1, 1, e);
            *count = i + 1;
        }
    } else if (ok) {
        snprintf(paths[0], 256, "%s/%s.exr", folder, f->expected);
        *count = 1;
        ok = exrio_write(paths[0], parts, n, 1, e) && (!f->tiled || write_tiled(paths[0], e));
    }
    for (int g = 0; g < GROUPS; g++)
        for (int k = 0; k < 4; k++) free(sh.layers[g].data[k]);
    return ok;
}
