// The ray-traced reference: the picture's points against the scene's own mesh.
//
// Once a frame every point is put onto the mesh (trace_points). Then, for every sample of every batch of pixels: rays from the
// points (trace_start), traced (passes/trace.h); their sums (trace_add); rays on from what they hit (trace_bounce), traced; their
// sums (trace_gather). Samples come in rounds over the whole frame. At the end sums become layers (trace_finish).
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "light/alias_table.h"
#include "passes/method.h"
#include "passes/params.h"
#include "passes/trace.h"

enum { BATCH = 16384, ROUND = 16, PROBES = 2048 };
static const double WRONG_MESH = 0.1, DOUBTFUL_MESH = 0.8; // shares of the points that lie on it

// One frame being traced.
typedef struct trace_run {
    pass_context *c;
    trace_scene *s;
    trace_params params;
    bool light, bounce, visibility;
    size_t batch, pixel_count;
    gpu_buffer pixels, rays, hits, gains, next_rays, next_hits, next_gains;
    gpu_image point, face;
} trace_run;

// ---- the list of pixels

// In blocks of 32 x 32, so that the rays of a batch start near each other. With `stride` > 1 only every so many.
static size_t list_pixels(const gbuffer *gb, size_t stride, uint32_t *list)
{
    enum { BLOCK = 32 };
    size_t n = 0, seen = 0;
    for (int by = 0; by < gb->height; by += BLOCK)
        for (int bx = 0; bx < gb->width; bx += BLOCK)
            for (int y = by; y < by + BLOCK && y < gb->height; y++)
                for (int x = bx; x < bx + BLOCK && x < gb->width; x++) {
                    size_t i = (size_t)y * (size_t)gb->width + (size_t)x;
                    if (gb->depth[i] > 0.0f && seen++ % stride == 0) list[n++] = (uint32_t)i;
                }
    return n;
}

static bool upload_pixels(trace_run *r, size_t stride, error *e)
{
    const gbuffer *gb = r->c->gb;
    uint32_t *list = mem_pixels((size_t)gb->width * (size_t)gb->height, sizeof *list, e);
    if (!list) return false;
    r->pixel_count = list_pixels(gb, stride, list);
    gpu_buffer_free(&r->pixels);
    bool ok = gpu_buffer_make(r->c->g, &r->pixels, list, r->pixel_count * sizeof *list, "the list of pixels", e);
    free(list);
    return ok;
}

// ---- one step over a batch

// Runs `program` over the batch that begins at `first`. Rays, hits and gains: those of the points, or with `next` those that the
// bounce sends on.
static bool run_step(trace_run *r, const char *program, const char *words, size_t first, bool next, error *e)
{
    pass_context *c = r->c;
    size_t end = first + r->batch < r->pixel_count ? first + r->batch : r->pixel_count;
    const pass_call call = {
        .program = program,
        .variant = words,
        .untimed = true,
        .groups = {(int)((end - first + 63) / 64), 1},
        .range = {(int)first, (int)end},
        PASS_PARAMS(r->params),
        .reads = {{"point_image", &r->point}, {"face_image", &r->face}},
        .writes = {{"occlusion_image", &c->image[IMAGE_OCCLUSION]},
                   {"radiance_image", &c->image[IMAGE_RADIANCE]},
                   {"indirect_image", &c->image[IMAGE_INDIRECT]},
                   {"visibility_image", &c->image[IMAGE_VISIBILITY]}},
        .buffers = {{"Pixels", &r->pixels},
                    {"Rays", next ? &r->next_rays : &r->rays},
                    {"Hits", next ? &r->next_hits : &r->hits},
                    {"Gains", next ? &r->next_gains : &r->gains},
                    {"NextRays", &r->next_rays},
                    {"NextGains", &r->next_gains},
                    {"Triangles", &r->s->triangles},
                    {"AliasTable",
                     r->s->alias_table.id ? &r->s->alias_table : &r->pixels}}, // without a table the shader does not look
    };
    return pass_run(c, &call, e);
}

static size_t size_of_batch(const trace_run *r, size_t first)
{
    return r->pixel_count - first < r->batch ? r->pixel_count - first : r->batch;
}

// ---- where the points are

static bool find_points(trace_run *r, size_t first, error *e)
{
    return run_step(r, "trace_points", "FIND", first, false, e) &&
           trace_send(r->s, r->c, &r->rays, &r->hits, size_of_batch(r, first), e);
}

static bool count_found(trace_run *r, size_t first, size_t *found, error *e)
{
    size_t n = size_of_batch(r, first);
    trace_hit *hits = mem_pixels(n, sizeof *hits, e);
    if (!hits) return false;
    gpu_buffer_read(r->c->g, &r->hits, hits, n * sizeof *hits);
    for (size_t i = 0; i < n; i++) *found += hits[i].triangle < TRACE_NO_RAY;
    free(hits);
    return true;
}

// How the mesh's axes follow from the world's.
static const struct {
    const char *name;
    mat3 mesh_from_world;
} axes[] = {
    {"the picture's own axes", {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
    {"y up, in a world with z up", {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}}},
    {"z up, in a world with y up", {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}}},
};

static void place_camera(trace_run *r, int axis)
{
    const camera *cam = &r->c->gb->camera;
    mat3 m = m3_mul(axes[axis].mesh_from_world, cam->world_from_camera);
    vec3 eye = v3_sub(m3_apply(axes[axis].mesh_from_world, cam->origin), r->s->origin);
    const double offset[3] = {eye.x, eye.y, eye.z};
    for (int row = 0; row < 3; row++) {
        for (int k = 0; k < 3; k++) r->params.mesh_from_camera[row][k] = (float)m.m[row][k];
        r->params.mesh_from_camera[row][3] = (float)offset[row];
    }
}

// Tries the ways in which programs write their axes on a few of the points; the one that puts most of them onto the mesh is it.
static bool choose_axes(trace_run *r, error *e)
{
    int asked = r->c->set.mesh_axes, best = asked < 0 ? 0 : asked;
    size_t stride = r->c->gb->valid / PROBES + 1, most = 0;
    if (asked < 0) {
        if (!upload_pixels(r, stride, e)) return false;
        for (int axis = 0; axis < 3; axis++) {
            size_t found = 0;
            place_camera(r, axis);
            if (!find_points(r, 0, e) || !count_found(r, 0, &found, e)) return false;
            if (found > most) most = found, best = axis;
        }
    }
    place_camera(r, best);
    log_info(r->c->log, "mesh: %s", axes[best].name);
    return upload_pixels(r, 1, e);
}

static bool settle_points(trace_run *r, error *e)
{
    size_t found = 0;
    for (size_t first = 0; first < r->pixel_count; first += r->batch) {
        if (!find_points(r, first, e) || !count_found(r, first, &found, e)) return false;
        if (!run_step(r, "trace_points", "SETTLE", first, false, e)) return false;
    }
    trace_longer_rays(r->s);
    double share = r->pixel_count ? (double)found / (double)r->pixel_count : 1.0;
    log_info(r->c->log, "mesh: %.2f %% of the picture's points lie on it", 100.0 * share);
    if (share < WRONG_MESH)
        return err_set(e, ERR_INPUT, r->s->path, NULL,
                       "only %.1f %% of the picture's points lie on this mesh; export it in world space, in the unit of the "
                       "position pass and at the picture's frame, or name its axes with --mesh-axes",
                       100.0 * share);
    if (share < DOUBTFUL_MESH)
        log_warn(r->c->log, "mesh-fit", "%s: only %.0f %% of the picture's points lie on this mesh; is it of the same frame?",
                 r->s->path, 100.0 * share);
    return true;
}

// ---- samples

static bool trace_sample(trace_run *r, size_t first, int index, error *e)
{
    size_t n = size_of_batch(r, first), kinds = r->params.alias_table[0] > 0 ? 2 : 1;
    r->params.sample_index = index;
    variant start = {{0}};
    variant_add(&start, r->light, "LIGHT");
    variant_add(&start, r->light || r->bounce, "DISTANT");
    if (!run_step(r, "trace_start", start.words, first, false, e) ||
        !trace_send(r->s, r->c, &r->rays, &r->hits, r->light ? n * kinds : n, e) ||
        !run_step(r, "trace_add", r->light ? "LIGHT" : "", first, false, e))
        return false;
    if (!r->bounce) return true;
    return run_step(r, "trace_bounce", "", first, false, e) &&
           trace_send(r->s, r->c, &r->next_rays, &r->next_hits, n * kinds, e) && run_step(r, "trace_gather", "", first, true, e);
}

// Of the occlusion so far, at most: a pixel's samples are spread more evenly than the independent ones this is true of.
static bool report_round(const trace_run *r, int done, error *e)
{
    const pass_context *c = r->c;
    if (c->log->level < LOG_INFO) return true;
    size_t n = (size_t)c->width * (size_t)c->height;
    float *sum = mem_pixels(n, sizeof *sum, e);
    if (!sum) return false;
    gpu_image_download(c->g, &c->image[IMAGE_OCCLUSION], sum);
    double variance = 0.0;
    for (size_t i = 0; i < n; i++) {
        double p = (double)sum[i] / done;
        if (c->gb->depth[i] > 0.0f) variance += p * (1.0 - p) / done;
    }
    free(sum);
    log_info(c->log, "raytrace: %d of %d samples, standard error of occlusion at most %.4f", done, r->params.samples,
             sqrt(variance / (double)r->pixel_count));
    return true;
}

static bool stopped(const pass_context *c) { return c->stop && *c->stop; }

static bool trace_rounds(trace_run *r, error *e)
{
    int samples = r->params.samples;
    for (int done = 0; done < samples;) {
        int end = done + ROUND < samples ? done + ROUND : samples;
        for (size_t first = 0; first < r->pixel_count; first += r->batch)
            for (int i = done; i < end; i++) {
                if (stopped(r->c)) return true; // the frame will be dropped
                if (!trace_sample(r, first, i, e)) return false;
            }
        done = end;
        if (!gpu_finish(r->c->g, "ray tracing", e) || !report_round(r, done, e)) return false;
    }
    variant finish = {{0}};
    variant_add(&finish, r->light, "LIGHT");
    variant_add(&finish, r->bounce, "BOUNCE");
    variant_add(&finish, r->visibility, "VISIBILITY");
    for (size_t first = 0; first < r->pixel_count; first += r->batch)
        if (!run_step(r, "trace_finish", finish.words, first, false, e)) return false;
    return true;
}

// ---- the whole

static bool make_alias_table(trace_run *r, error *e)
{
    trace_scene *s = r->s;
    env_alias_table table;
    if (!(r->light || r->bounce) || !r->c->env || r->c->env->white) return true;
    if (!s->alias_table.id) {
        if (!env_alias_table_make(r->c->env, &table, e)) return false;
        size_t size = (size_t)table.width * (size_t)table.height * sizeof *table.table;
        bool ok = gpu_buffer_make(r->c->g, &s->alias_table, table.table, size, "the environment's table", e);
        s->table_size[0] = table.width, s->table_size[1] = table.height;
        env_alias_table_free(&table);
        if (!ok) return false;
    }
    r->params.alias_table[0] = s->table_size[0], r->params.alias_table[1] = s->table_size[1];
    return true;
}

static bool make_room(trace_run *r, error *e)
{
    pass_context *c = r->c;
    gpu *g = c->g;
    size_t rays = 2 * r->batch;
    if (!pass_make_image(c, IMAGE_OCCLUSION, e) || !pass_make(c, &r->point, GL_RGBA32F, 0.0f, e) ||
        !pass_make(c, &r->face, GL_RGBA32F, 0.0f, e) || (r->light && !pass_make_image(c, IMAGE_RADIANCE, e)) ||
        (r->bounce && !pass_make_image(c, IMAGE_INDIRECT, e)) || (c->want_visibility && !pass_make_image(c, IMAGE_VISIBILITY, e)))
        return false;
    return gpu_buffer_make(g, &r->rays, NULL, rays * sizeof(trace_ray), "rays", e) &&
           gpu_buffer_make(g, &r->hits, NULL, rays * sizeof(trace_hit), "hits", e) &&
           gpu_buffer_make(g, &r->gains, NULL, rays * 4 * sizeof(float), "gains", e) &&
           gpu_buffer_make(g, &r->next_rays, NULL, rays * sizeof(trace_ray), "rays", e) &&
           gpu_buffer_make(g, &r->next_hits, NULL, rays * sizeof(trace_hit), "hits", e) &&
           gpu_buffer_make(g, &r->next_gains, NULL, rays * 4 * sizeof(float), "gains", e);
}

static void free_room(trace_run *r)
{
    gpu_buffer *buffers[] = {&r->pixels, &r->rays, &r->hits, &r->gains, &r->next_rays, &r->next_hits, &r->next_gains};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++) gpu_buffer_free(buffers[i]);
    gpu_image_free(&r->point);
    gpu_image_free(&r->face);
}

static bool prepare(trace_run *r, error *e)
{
    pass_context *c = r->c;
    const pass_settings *set = &c->set;
    if (!c->gb->camera.has_world)
        return err_set(
            e, ERR_INPUT, NULL, NULL,
            "--method raytrace needs to know where the camera stands in the mesh's world, and this frame does not say; "
            "render a position pass in world space or use --camera FILE");
    if (!trace_scene_open(r->s, c->g, set->mesh, (trace_backend)set->trace, c->threads, c->log, e) || !make_alias_table(r, e))
        return false;
    if (r->bounce && !r->s->coloured)
        log_warn(c->log, "mesh-grey",
                 "%s names no colours, so every surface of the bounce reflects 0.8; add Kd or vertex colours", r->s->path);
    return make_room(r, e);
}

static bool run(pass_context *c, error *e)
{
    bool light = c->want_radiance || c->want_visibility, bounce = c->want_indirect;
    pass_timing clock = pass_clock(c, "raytrace");
    trace_run r = {
        .c = c,
        .s = c->trace,
        .light = light,
        .bounce = bounce,
        .visibility = c->want_visibility,
        .batch = BATCH,
        .params = {.radius = (float)c->set.radius,
                   .level = c->set.env_level > 0.0 ? (float)c->set.env_level : 0.0f,
                   .strength = (float)c->set.bounce_strength,
                   .seed = c->set.seed,
                   .samples = c->set.samples},
    };
    bool ok = prepare(&r, e) && (c->gb->valid == 0 || (choose_axes(&r, e) && settle_points(&r, e) && trace_rounds(&r, e)));
    free_room(&r);
    if (ok) pass_clock_stop(c, clock);
    return ok;
}

// Traced in the same loop.
static bool run_bounce(pass_context *c, error *e)
{
    (void)c;
    (void)e;
    return true;
}

static const variant_row variants[] = {
    {.program = "trace_add", .pattern = "[LIGHT]"},
    {.program = "trace_bounce", .pattern = ""},
    {.program = "trace_finish", .pattern = "[BOUNCE] | LIGHT [BOUNCE] [VISIBILITY]"},
    {.program = "trace_gather", .pattern = ""},
    {.program = "trace_grid", .pattern = ""},
    {.program = "trace_points", .pattern = "FIND | SETTLE"},
    {.program = "trace_start", .pattern = "[DISTANT] | LIGHT DISTANT"},
    {0},
};

const bounce_kind bounce_raytrace = {
    .name = "raytrace",
    .source = SEES_MESH,
    .march = BOUNCE_WITH_METHOD,
    .run = run_bounce,
};

const method method_raytrace = {
    .name = "raytrace",
    .summary = "the picture's points against the scene's own mesh, --mesh: the truth, up to noise",
    .weighting = "cosine",
    .reaches = "the mesh within the radius; for light and bounce at any distance",
    .blind = "what the mesh does not hold: textures, emission, transparency; directions under a face that its smooth normal "
             "includes are blocked",
    .light = "everything, against the scene's own mesh",
    .choose = "to know the truth",
    .options = "mesh mesh-axes trace",
    .samples = 64,
    .blur = 0,
    .thickness = 0.0,
    .makes = MAKES_LIGHT,
    .source = SEES_MESH,
    .weight = WEIGHS_COSINE,
    .reach = REACH_SURFACES,
    .bounce = &bounce_raytrace,
    .variants = variants,
    .run = run,
};
