#include "pipeline/report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "pipeline/json.h"

const char *const report_stage_names[STAGE_COUNT] = {"read", "resolve", "passes", "read back", "convert", "write"};

static json_object *channels_of(const frame_result *r)
{
    json_object *o = json_object_new_object();
    char text[320];
    for (int i = 0; i < ROLE_COUNT; i++) {
        if (!r->resolution.components[i]) continue;
        resolve_describe(r->file, &r->resolution, (role)i, text, sizeof text);
        const char *colon = strstr(text, ": ");
        json_put_text(o, role_name((role)i), colon ? colon + 2 : text);
    }
    return o;
}

static json_object *camera_of(const frame_result *r)
{
    static const char *sources[] = {"option", "fit", "header", "plane"};
    const camera *c = &r->gb.camera;
    json_object *o = json_object_new_object(), *focal = json_object_new_array(), *centre = json_object_new_array();
    json_put_text(o, "kind", c->kind == CAMERA_ORTHOGRAPHIC ? "orthographic" : "perspective");
    json_put_text(o, "source", sources[c->source]);
    json_object_array_add(focal, json_object_new_double(c->fx));
    json_object_array_add(focal, json_object_new_double(c->fy));
    json_object_array_add(centre, json_object_new_double(c->cx));
    json_object_array_add(centre, json_object_new_double(c->cy));
    json_put(o, "focal_px", focal);
    json_put(o, "centre_px", centre);
    json_put_number(o, "residual_px", c->residual);
    json_put_number(o, "pixels_in_place", c->inliers);
    return o;
}

static json_object *names_of(image_set images)
{
    json_object *list = json_object_new_array();
    for (int i = 0; i < IMAGE_COUNT; i++)
        if (images & IMAGE_BIT(i)) json_object_array_add(list, json_text(image_table[i].name));
    return list;
}

// In their order, and after them those that did not run.
static json_object *passes_of(const frame_result *r)
{
    json_object *list = json_object_new_array();
    for (int i = 0; i < r->steps.count; i++) {
        const plan_step *s = &r->steps.steps[i];
        json_object *o = json_object_new_object();
        json_put_text(o, "pass", s->pass);
        json_put(o, "runs", json_object_new_boolean(s->runs));
        json_put_text(o, "why", s->why);
        if (s->size == STEP_SMALL) json_put_text(o, "size", "half");
        if (s->runs) json_put(o, "reads", names_of(s->reads));
        if (s->runs) json_put(o, "writes", names_of(s->writes));
        json_object_array_add(list, o);
    }
    return list;
}

// In the order things happened. "passes" is the whole GL part, of which "upload" and the passes' own entries are shares.
static json_object *times_of(const frame_result *r)
{
    json_object *list = json_object_new_array();
    for (int i = 0; i < STAGE_COUNT; i++) {
        json_object_array_add(list, json_time(report_stage_names[i], r->wall_ms[i], r->cpu_ms[i]));
        for (int k = 0; i == STAGE_PASSES && k < r->timing_count; k++) {
            json_object *o = json_time(r->timings[k].name, r->timings[k].wall_ms, r->timings[k].cpu_ms);
            if (strcmp(r->timings[k].name, "upload") != 0) json_put(o, "tiles", json_object_new_int(r->timings[k].tiles));
            json_object_array_add(list, o);
        }
    }
    return list;
}

static json_object *upload_of(const char *name, size_t bytes)
{
    json_object *o = json_object_new_object();
    json_put_text(o, "name", name);
    json_put(o, "bytes", json_object_new_int64((int64_t)bytes));
    return o;
}

static json_object *uploads_of(const job *j, const frame_result *r)
{
    json_object *list = json_object_new_array();
    for (int i = 0; i < r->upload_count; i++) json_object_array_add(list, upload_of(r->uploads[i].name, r->uploads[i].bytes));
    size_t texels = 0;
    for (int i = 0; i < j->light.image.levels; i++) {
        size_t w = (size_t)j->light.image.width >> i, h = (size_t)j->light.image.height >> i;
        texels += (w ? w : 1) * (h ? h : 1);
    }
    if (j->light.image.id) json_object_array_add(list, upload_of("environment", texels * 4 * sizeof(float)));
    return list;
}

// So far in this run: how many shader programs were made from source, and how many an earlier run had left in the cache.
static json_object *programs_of(const job *j)
{
    json_object *o = json_object_new_object();
    json_put(o, "compiled", json_object_new_int(j->g.programs_compiled));
    json_put(o, "from_cache", json_object_new_int(j->g.programs_cached));
    return o;
}

// What the frame asked of GL; the environment, which all frames share, is not among it.
static json_object *gl_of(const gpu_counts *c)
{
    const struct {
        const char *name;
        long long count;
    } list[] = {
        {"dispatches", c->dispatches}, {"draws", c->draws},           {"barriers", c->barriers},     {"uploads", c->uploads},
        {"bytes_up", c->bytes_up},     {"read_backs", c->read_backs}, {"bytes_down", c->bytes_down},
    };
    json_object *o = json_object_new_object();
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) json_put(o, list[i].name, json_object_new_int64(list[i].count));
    return o;
}

static json_object *tiles_of(const frame_result *r)
{
    json_object *o = json_object_new_object();
    json_put(o, "size", json_object_new_int(r->tile_size));
    json_put(o, "dispatched", json_object_new_int(r->tiles_occupied));
    json_put(o, "skipped", json_object_new_int(r->tiles - r->tiles_occupied));
    return o;
}

// Points of the disc that a sphere of the occlusion radius covers on the screen, that lie outside the frame: a mean over a grid
// of surface pixels. It is an estimate from the radius alone, the same for every method.
double report_off_frame_share(const frame_result *r)
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
    for (int i = 0; i < r->planes.count + r->planes.uneven; i++) {
        const plane *p = &r->planes.planes[i];
        json_object *o = json_object_new_object(), *normal = json_object_new_array();
        json_object_array_add(normal, json_object_new_double(p->normal.x));
        json_object_array_add(normal, json_object_new_double(p->normal.y));
        json_object_array_add(normal, json_object_new_double(p->normal.z));
        json_put(o, "normal", normal);
        json_put_number(o, "offset", p->offset);
        json_put_number(o, "share", p->share);
        json_put_number(o, "belief", p->belief);
        json_put(o, "uneven", json_object_new_boolean(i == r->planes.count));
        json_object_array_add(list, o);
    }
    return list;
}

// Of --error.
json_object *report_rounds(const frame_result *r)
{
    json_object *o = json_object_new_object();
    json_put_number(o, "error", r->set.target_error);
    json_put(o, "rounds", json_object_new_int(r->rounds));
    json_put_number(o, "mean_samples", r->mean_samples);
    json_put(o, "tiles_above", json_object_new_int(r->tiles_above));
    return o;
}

static json_object *report_of(const job *j, const frame_result *r, const char *output)
{
    json_object *o = json_object_new_object(), *evidence = json_object_new_array(), *layers = json_object_new_array(),
                *warnings = json_object_new_array(), *inputs = json_object_new_array();
    double pixels = (double)r->gb.width * r->gb.height;
    char record[DIGEST_TEXT + 1];
    if (r->record.made) digest_format(r->record.sampled, record);
    json_put_text(o, "version", SSDO_VERSION);
    json_put_text(o, "digest", r->record.made ? record : NULL); // by which --skip-existing knows it
    json_put_text(o, "input", r->file->path);
    for (int i = 0; i < r->file->member_count; i++) json_object_array_add(inputs, json_text(r->file->members[i]->path));
    json_put(o, "inputs", inputs); // where the frame's passes are in several files
    json_put_text(o, "output", output);
    json_put_text(o, "device", j->g.renderer);
    if (j->g.software) json_put_text(o, "why_software", j->g.why_software);
    json_put_text(o, "convention", r->resolution.convention);
    json_put(o, "channels", channels_of(r));
    for (int i = 0; i < r->gb.evidence_count; i++) json_object_array_add(evidence, json_text(r->gb.evidence[i]));
    json_put(o, "evidence", evidence);
    json_put(o, "camera", camera_of(r));
    json_put_text(o, "method", r->plan.method->name);
    if (r->set.target_error <= 0.0) json_put(o, "samples", json_object_new_int(r->set.samples));
    if (r->set.target_error > 0.0) json_put(o, "rounds", report_rounds(r));
    json_put_number(o, "radius", r->set.radius);
    json_put_number(o, "thickness", r->set.thickness);
    json_put_number(o, "outside", openness_mean(&r->set.outside));
    if (r->unexplained > 0.0) json_put_number(o, "outside_unexplained", r->unexplained);
    json_put_number(o, "valid_share", pixels > 0 ? (double)r->gb.valid / pixels : 0.0);
    json_put_number(o, "off_frame_share", report_off_frame_share(r));
    json_put_number(o, "off_ray_share", r->gb.valid ? (double)r->gb.off_ray / (double)r->gb.valid : 0.0);
    for (int l = 0; l < LAYER_COUNT; l++)
        if (r->samples[l][0]) json_object_array_add(layers, json_text(layer_table[l]->name));
    json_put(o, "layers", layers);
    json_put(o, "planes", planes_of(r)); // camera space: normal . x = offset; share of the surfaces
    json_put(o, "passes", passes_of(r));
    json_put(o, "times", times_of(r));
    json_put(o, "tiles", tiles_of(r));
    json_put(o, "gl", gl_of(&r->gl));
    json_put(o, "programs", programs_of(j));
    json_put(o, "uploads", uploads_of(j, r));
    json_put(o, "clamped_samples", json_object_new_int64((int64_t)r->clamped));
    log_each_warning(j->log, json_add_text, warnings);
    json_put(o, "warnings", warnings);
    return o;
}

bool report_write(const job *j, const frame_result *r, const char *output, const char *path, error *e)
{
    return json_save(report_of(j, r, output), path, e);
}
