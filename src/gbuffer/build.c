// gbuffer_build: the order of the steps.
#include "gbuffer/build.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/mem.h"
#include "base/threads.h"
#include "gbuffer/radius.h"

void build_note(build *b, const char *format, ...)
{
    gbuffer *g = b->g;
    char line[sizeof g->evidence[0]];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    log_info(b->log, "%s", line);
    const int most = (int)(sizeof g->evidence / sizeof g->evidence[0]);
    if (g->evidence_count < most) snprintf(g->evidence[g->evidence_count++], sizeof line, "%s", line);
}

typedef struct row_job {
    build *b;
    build_row_fn fn;
} row_job;

static bool run_row(void *context, size_t row, int worker)
{
    (void)worker;
    row_job *job = context;
    job->fn(job->b, (int)row);
    return true;
}

const int build_around[BUILD_AROUND][2] = {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};

void build_rows(build *b, build_row_fn fn)
{
    row_job job = {b, fn};
    threads_for(b->options->threads, (size_t)b->g->height, run_row, &job);
}

plane build_plane(const build *b, role r, int component)
{
    plane p = {0};
    if (component >= b->r->components[r]) return p;
    channel_ref ref = b->r->channels[r][component];
    const exrio_part *part = &b->file->parts[ref.part];
    p = (plane){.data = part->channels[ref.channel].data,
                .type = part->channels[ref.channel].type,
                .width = box2_width(part->data_window),
                .height = box2_height(part->data_window),
                .dx = b->g->data_window.x0 - part->data_window.x0,
                .dy = b->g->data_window.y0 - part->data_window.y0};
    return p;
}

static void open_planes(build *b)
{
    for (int c = 0; c < 3; c++) {
        b->position.p[c] = build_plane(b, ROLE_POSITION, c);
        b->normal.n[c] = build_plane(b, ROLE_NORMAL, c);
    }
    b->position.z = build_plane(b, ROLE_DEPTH, 0);
    b->alpha = build_plane(b, ROLE_ALPHA, 0);
    b->position.has_p = b->position.p[0].data && b->position.p[1].data && b->position.p[2].data;
    b->normal.there = b->normal.n[0].data && b->normal.n[1].data && b->normal.n[2].data;
    b->position.has_z = b->position.z.data != NULL;
    b->position.code = (depth_code){.kind = DEPTH_PLANAR, .sign = 1.0};
}

static bool open_frame(build *b)
{
    gbuffer *g = b->g;
    const exrio_part *part = &b->file->parts[b->r->main_part];
    g->data_window = part->data_window, g->display_window = part->display_window;
    g->width = box2_width(part->data_window), g->height = box2_height(part->data_window);
    g->pixel_aspect = part->pixel_aspect > 0.0f && isfinite(part->pixel_aspect) ? (double)part->pixel_aspect : 1.0;
    size_t pixels = (size_t)g->width * (size_t)g->height;
    open_planes(b);
    g->depth = mem_pixels(pixels, sizeof *g->depth, b->e);
    g->normal = mem_pixels(pixels, 4 * sizeof *g->normal, b->e);
    b->surface = mem_zero(pixels, 1, b->e);
    return g->depth && g->normal && b->surface;
}

static bool prepare_lengths(build *b)
{
    if (!filtered_asked(b) && !mixed_asked(b)) return true;
    b->normal.lengths = mem_pixels((size_t)b->g->width * (size_t)b->g->height, 1, b->e);
    return b->normal.lengths != NULL;
}

static bool summarise(build *b)
{
    gbuffer *g = b->g;
    if (!gbuffer_extent(g, &g->extent, b->e)) return false;
    if (g->off_ray)
        build_note(b, "%zu of %zu positions lay off their pixel's centre and were moved onto it", g->off_ray, g->valid);
    if (g->normals_from_depth && g->valid)
        log_warn(b->log, "normals-from-depth",
                 "no usable normals in the file: they are rebuilt from depth and show its facets "
                 "(--normal names a channel)");
    defects_warn(b);
    g->position_verdict.used = g->position_verdict.present && b->position.has_p;
    g->depth_verdict.used = g->depth_verdict.present && b->position.has_z;
    if (g->position_is_camera_space) g->camera.has_world = false;
    if (b->camera.has_header_pose)
        g->camera.world_from_camera = b->camera.world_from_camera, g->camera.origin = b->camera.eye, g->camera.has_world = true;
    if (b->camera.rotation_from_normals) g->camera.world_from_camera = b->camera.world_from_camera, g->camera.has_world = false;
    g->camera.has_rotation = g->camera.has_world || b->camera.rotation_from_normals;
    const mat3 y_up = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    g->normal_from_camera = b->normal.there       ? m3_transpose(b->normal.to_camera)
                            : g->camera.has_world ? g->camera.world_from_camera
                                                  : y_up;
    return true;
}

bool gbuffer_build(const exrio_file *file, const resolution *r, const gbuffer_options *options, gbuffer *out, log_t *log,
                   error *e)
{
    *out = (gbuffer){0};
    build b = {.file = file, .r = r, .options = options, .g = out, .log = log, .e = e, .row = convention_named(r->convention)};
    bool done = open_frame(&b) && depth_open(&b) && validity_find(&b) && choose_camera(&b) && orthographic_settle(&b) &&
                depth_settle(&b) && positions_raw(&b) && measure_normals(&b) && damage_warn(&b) && prepare_lengths(&b);
    if (done) {
        positions_final(&b);
        normals_make(&b);
        done = cracks_mend(&b) && filtered_mend(&b) && albedo_make(&b) && coverage_make(&b) && mixed_make(&b) &&
               colours_make(&b) && summarise(&b);
    }
    free(b.surface);
    free(b.position.raw);
    free(b.normal.lengths);
    free(b.sample.points);
    free(b.sample.depth);
    if (!done) gbuffer_free(out);
    return done;
}

const char *gbuffer_doubt(const gbuffer *g)
{
    if (g->position_verdict.doubtful) return role_name(ROLE_POSITION);
    if (g->depth_verdict.doubtful) return role_name(ROLE_DEPTH);
    return g->normal_verdict.doubtful ? role_name(ROLE_NORMAL) : NULL;
}

void gbuffer_free(gbuffer *g)
{
    float *arrays[] = {g->depth, g->normal, g->albedo, g->beauty, g->material, g->emission, g->diffuse_direct, g->coverage};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
    free(g->mixed);
    g->mixed = NULL, g->mixed_count = 0;
    g->depth = g->normal = g->albedo = g->beauty = g->material = g->emission = g->diffuse_direct = g->coverage = NULL;
}

vec3 gbuffer_position(const gbuffer *g, int x, int y)
{
    double z = (double)g->depth[(size_t)y * (size_t)g->width + (size_t)x];
    return z > 0.0 ? build_point(&g->camera, x, y, z) : v3(0, 0, 0);
}
