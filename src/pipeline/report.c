#include "pipeline/report.h"

#include <errno.h>
#include <json-c/json.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/outfile.h"

static void put(json_object *o, const char *key, json_object *value) { json_object_object_add(o, key, value); }
static void put_text(json_object *o, const char *key, const char *s) { put(o, key, s ? json_object_new_string(s) : NULL); }
static void put_number(json_object *o, const char *key, double v)
{
    put(o, key, v - v == 0.0 ? json_object_new_double(v) : NULL);
}

static json_object *channels_of(const frame_result *r)
{
    json_object *o = json_object_new_object();
    char text[320];
    for (int i = 0; i < ROLE_COUNT; i++) {
        if (!r->resolution.components[i]) continue;
        resolve_describe(r->file, &r->resolution, (role)i, text, sizeof text);
        const char *colon = strstr(text, ": ");
        put_text(o, role_name((role)i), colon ? colon + 2 : text);
    }
    return o;
}

static json_object *camera_of(const frame_result *r)
{
    static const char *sources[] = {"option", "fit", "header", "plane"};
    const camera *c = &r->gb.camera;
    json_object *o = json_object_new_object(), *focal = json_object_new_array(), *centre = json_object_new_array();
    put_text(o, "kind", c->kind == CAMERA_ORTHOGRAPHIC ? "orthographic" : "perspective");
    put_text(o, "source", sources[c->source]);
    json_object_array_add(focal, json_object_new_double(c->fx));
    json_object_array_add(focal, json_object_new_double(c->fy));
    json_object_array_add(centre, json_object_new_double(c->cx));
    json_object_array_add(centre, json_object_new_double(c->cy));
    put(o, "focal_px", focal);
    put(o, "centre_px", centre);
    put_number(o, "residual_px", c->residual);
    put_number(o, "pixels_in_place", c->inliers);
    return o;
}

static const pass_timing *timing_of(const frame_result *r, const char *name)
{
    for (int i = 0; i < r->timing_count; i++)
        if (strcmp(r->timings[i].name, name) == 0) return &r->timings[i];
    return NULL;
}

static json_object *passes_of(const frame_result *r)
{
    json_object *list = json_object_new_array();
    for (int i = 0; i < r->plan.step_count; i++) {
        json_object *o = json_object_new_object();
        const plan_step *s = &r->plan.steps[i];
        bool spared = s->runs && strcmp(s->pass, "edges") == 0 && !timing_of(r, "edges"); // decided with the pixels
        put_text(o, "pass", s->pass);
        put(o, "runs", json_object_new_boolean(s->runs && !spared));
        put_text(o, "why", spared ? "every pixel with a share of a surface has one recorded" : s->why);
        json_object_array_add(list, o);
    }
    return list;
}

static json_object *time_of(const char *name, double wall, double cpu)
{
    json_object *o = json_object_new_object();
    put_text(o, "stage", name);
    put_number(o, "wall_ms", wall);
    put_number(o, "cpu_ms", cpu);
    return o;
}

// In the order things happened. "passes" is the whole GL part, of which "upload" and the passes' own entries are shares.
static json_object *times_of(const frame_result *r)
{
    static const char *names[STAGE_COUNT] = {"read", "resolve", "passes", "read back", "write"};
    json_object *list = json_object_new_array();
    for (int i = 0; i < STAGE_COUNT; i++) {
        json_object_array_add(list, time_of(names[i], r->wall_ms[i], r->cpu_ms[i]));
        for (int k = 0; i == STAGE_PASSES && k < r->timing_count; k++) {
            json_object *o = time_of(r->timings[k].name, r->timings[k].wall_ms, r->timings[k].cpu_ms);
            if (strcmp(r->timings[k].name, "upload") != 0) put(o, "tiles", json_object_new_int(r->timings[k].tiles));
            json_object_array_add(list, o);
        }
    }
    return list;
}

static json_object *upload_of(const char *name, size_t bytes)
{
    json_object *o = json_object_new_object();
    put_text(o, "name", name);
    put(o, "bytes", json_object_new_int64((int64_t)bytes));
    return o;
}

static json_object *uploads_of(const job *j, const frame_result *r)
{
    json_object *list = json_object_new_array();
    for (int i = 0; i < r->upload_count; i++) json_object_array_add(list, upload_of(r->uploads[i].name, r->uploads[i].bytes));
    size_t texels = 0;
    for (int i = 0; i < j->env_image.levels; i++) {
        size_t w = (size_t)j->env_image.width >> i, h = (size_t)j->env_image.height >> i;
        texels += (w ? w : 1) * (h ? h : 1);
    }
    if (j->env_image.id) json_object_array_add(list, upload_of("environment", texels * 4 * sizeof(float)));
    return list;
}

// So far in this run: how many shader programs were made from source, and how many an earlier run had left in the cache.
static json_object *programs_of(const job *j)
{
    json_object *o = json_object_new_object();
    put(o, "compiled", json_object_new_int(j->g.programs_compiled));
    put(o, "from_cache", json_object_new_int(j->g.programs_cached));
    return o;
}

static json_object *tiles_of(const frame_result *r)
{
    json_object *o = json_object_new_object();
    put(o, "size", json_object_new_int(r->tile_size));
    put(o, "dispatched", json_object_new_int(r->tiles_occupied));
    put(o, "skipped", json_object_new_int(r->tiles - r->tiles_occupied));
    return o;
}

// Points of the disc that a sphere of the occlusion radius covers on the screen, that lie outside the frame: a mean over a grid
// of surface pixels. It is an estimate from the radius alone, the same for every method.
static double off_frame_share(const frame_result *r)
{
    enum { GRID = 48, POINTS = 32 };
    const gbuffer *g = &r->gb;
    const double golden = 2.399963229728653; // angle of the spiral
    double outside = 0.0, all = 0.0;
    for (int cell = 0; cell < GRID * GRID; cell++) {
        int x = (2 * (cell % GRID) + 1) * g->width / (2 * GRID), y = (2 * (cell / GRID) + 1) * g->height / (2 * GRID);
        double z = (double)g->depth[(size_t)y * (size_t)g->width + (size_t)x];
        double scale = r->set.radius / (g->camera.kind == CAMERA_PERSPECTIVE ? z : 1.0);
        for (int i = 0; z > 0.0 && i < POINTS; i++) {
            double h = scale * sqrt((i + 0.5) / POINTS), u = x + 0.5 + h * g->camera.fx * cos(golden * i),
                   v = y + 0.5 + h * g->camera.fy * sin(golden * i);
            outside += u < 0.0 || v < 0.0 || u >= g->width || v >= g->height;
            all += 1.0;
        }
    }
    return all > 0.0 ? outside / all : 0.0;
}

static json_object *planes_of(const frame_result *r)
{
    json_object *list = json_object_new_array();
    for (int i = 0; i < r->planes.count; i++) {
        const plane *p = &r->planes.planes[i];
        json_object *o = json_object_new_object(), *normal = json_object_new_array();
        json_object_array_add(normal, json_object_new_double(p->normal.x));
        json_object_array_add(normal, json_object_new_double(p->normal.y));
        json_object_array_add(normal, json_object_new_double(p->normal.z));
        put(o, "normal", normal);
        put_number(o, "offset", p->offset);
        put_number(o, "share", p->share);
        json_object_array_add(list, o);
    }
    return list;
}

static json_object *report_of(const job *j, const frame_result *r, const char *output)
{
    json_object *o = json_object_new_object(), *evidence = json_object_new_array(), *layers = json_object_new_array(),
                *warnings = json_object_new_array(), *inputs = json_object_new_array();
    double pixels = (double)r->gb.width * r->gb.height;
    put_text(o, "version", SSDO_VERSION);
    put_text(o, "input", r->file->path);
    for (int i = 0; i < r->file->member_count; i++)
        json_object_array_add(inputs, json_object_new_string(r->file->members[i]->path));
    put(o, "inputs", inputs); // where the frame's passes are in several files
    put_text(o, "output", output);
    put_text(o, "device", j->g.renderer);
    put_text(o, "convention", r->resolution.convention);
    put(o, "channels", channels_of(r));
    for (int i = 0; i < r->gb.evidence_count; i++) json_object_array_add(evidence, json_object_new_string(r->gb.evidence[i]));
    put(o, "evidence", evidence);
    put(o, "camera", camera_of(r));
    put_text(o, "method", r->plan.method->name);
    put(o, "samples", json_object_new_int(r->set.samples));
    put_number(o, "radius", r->set.radius);
    put_number(o, "thickness", r->set.thickness);
    put_number(o, "valid_share", pixels > 0 ? (double)r->gb.valid / pixels : 0.0);
    put_number(o, "off_frame_share", off_frame_share(r));
    put_number(o, "off_ray_share", r->gb.valid ? (double)r->gb.off_ray / (double)r->gb.valid : 0.0);
    for (int l = 0; l < LAYER_COUNT; l++)
        if (r->layers[l]) json_object_array_add(layers, json_object_new_string(layer_table[l].name));
    put(o, "layers", layers);
    put(o, "planes", planes_of(r)); // camera space: normal . x = offset; share of the surfaces
    put(o, "passes", passes_of(r));
    put(o, "times", times_of(r));
    put(o, "tiles", tiles_of(r));
    put(o, "programs", programs_of(j));
    put(o, "uploads", uploads_of(j, r));
    put(o, "clamped_samples", json_object_new_int64((int64_t)r->clamped));
    for (int i = 0; i < j->log->warning_count; i++) json_object_array_add(warnings, json_object_new_string(j->log->warnings[i]));
    put(o, "warnings", warnings);
    return o;
}

bool report_write(const job *j, const frame_result *r, const char *output, const char *path, error *e)
{
    json_object *o = report_of(j, r, output);
    const char *text =
        json_object_to_json_string_ext(o, JSON_C_TO_STRING_PRETTY | JSON_C_TO_STRING_SPACED | JSON_C_TO_STRING_NOSLASHESCAPE);
    outfile out = OUTFILE_NONE;
    bool ok = outfile_begin(path, &out, e);
    if (ok && (dprintf(out.fd, "%s\n", text) < 0))
        ok = err_set(e, ERR_OUTPUT, path, NULL, "the report cannot be written: %s", strerror(errno));
    if (ok)
        ok = outfile_commit(&out, e);
    else
        outfile_abort(&out);
    json_object_put(o);
    return ok;
}
