// What the file's depth means, by comparing it with the positions.
#include <stdio.h>
#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/build.h"
#include "gbuffer/solve.h"

static const double same_depth = 0.01; // relative: Z within this of one kind is that kind

typedef struct comparison {
    double planar, radial, offset; // median relative errors; orthographic: offset = median of z - Z
    double position_step, depth_step;
} comparison;

static double step_of(sample_type type) { return type == SAMPLE_HALF ? 0x1p-11 : 0x1p-24; }

static double median_by(build *b, double *scratch, double (*value)(const build *, size_t, double), double parameter)
{
    for (size_t i = 0; i < b->sample.count; i++) scratch[i] = value(b, i, parameter);
    return solve_median(scratch, b->sample.count);
}

static vec3 seen(const build *b, size_t i) { return camera_from_world(&b->g->camera, b->sample.points[i].world); }
static double planar_error(const build *b, size_t i, double offset)
{
    double z = seen(b, i).z;
    return fabs(b->sample.depth[i] + offset - z) / fabs(z);
}
static double radial_error(const build *b, size_t i, double unused)
{
    (void)unused;
    double r = v3_length(seen(b, i));
    return fabs(b->sample.depth[i] - r) / r;
}
static double inverse_error(const build *b, size_t i, double unused)
{
    double z = seen(b, i).z;
    (void)unused;
    return fabs(1.0 / b->sample.depth[i] - z) / fabs(z);
}
static double offset_of(const build *b, size_t i, double unused)
{
    (void)unused;
    return seen(b, i).z - b->sample.depth[i];
}
// Rounding steps of P (largest component) and of Z, in units of depth.
static double position_step(const build *b, size_t i, double unused)
{
    (void)unused;
    vec3 p = b->sample.points[i].world;
    return fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))) * step_of(b->position.p[0].type);
}
static double depth_step(const build *b, size_t i, double unused)
{
    double step = step_of(b->position.z.type);
    (void)unused;
    if (b->position.code.kind <= DEPTH_INVERSE) return b->sample.depth[i] * step;
    double v = plane_get(&b->position.z, (int)b->sample.points[i].x, (int)b->sample.points[i].y);
    return fabs(depth_decode(&b->position.code, v * (1.0 - step)) - b->sample.depth[i]);
}
// P's rounding seen from the camera, in pixels.
static double lateral_step(const build *b, size_t i, double unused)
{
    const camera *c = &b->g->camera;
    double scale = c->kind == CAMERA_PERSPECTIVE ? c->fx / fabs(seen(b, i).z) : c->fx;
    return position_step(b, i, unused) * scale;
}

// The distances of 1 / z, where nothing else fits.
static void take_inverse(build *b)
{
    b->position.code.kind = DEPTH_INVERSE;
    for (size_t i = 0; i < b->sample.count; i++) b->sample.depth[i] = 1.0 / b->sample.depth[i];
}

static void settle_kind(build *b, double *scratch)
{
    gbuffer *g = b->g;
    verdict *v = &g->depth_verdict;
    bool perspective = g->camera.kind == CAMERA_PERSPECTIVE;
    b->position.z_offset = perspective ? 0.0 : median_by(b, scratch, offset_of, 0.0);
    double planar = median_by(b, scratch, planar_error, b->position.z_offset);
    double radial = perspective ? median_by(b, scratch, radial_error, 0.0) : INFINITY;
    double inverse = perspective ? median_by(b, scratch, inverse_error, 0.0) : INFINITY;
    const depth_kind code = b->position.code.kind; // of an option
    verdict_try(v, depth_text(code > DEPTH_RADIAL ? code : DEPTH_PLANAR), planar, planar);
    verdict_try(v, depth_text(DEPTH_RADIAL), radial, radial);
    if (code <= DEPTH_RADIAL) verdict_try(v, depth_text(DEPTH_INVERSE), inverse, inverse);
    v->measure = "median relative difference from the positions";
    v->fit = v->tried[0].fit, v->next = v->tried[1].fit;
    if (code <= DEPTH_RADIAL && !b->r->depth_told && fmin(planar, radial) >= same_depth && inverse < same_depth) {
        take_inverse(b);
        planar = inverse, radial = INFINITY;
    }
    g->depth_kind = radial < planar ? DEPTH_RADIAL : DEPTH_PLANAR;
    b->position.z_measured = fmin(planar, radial) < same_depth;
    depth_kind found = b->position.code.kind > DEPTH_RADIAL ? b->position.code.kind : g->depth_kind;
    snprintf(v->reading, sizeof v->reading, "%s", b->position.z_measured ? depth_text(found) : "no known kind of depth");
    if (!b->position.z_measured)
        build_note(b,
                   "depth is neither planar nor radial distance nor 1 / z (off by %.2g %% at best); only its background is used",
                   100.0 * v->fit);
    else
        build_note(b, "depth: %s%s (median difference from the positions %.2g; next best %.2g)",
                   b->position.code.sign < 0.0 ? "negative " : "", v->reading, v->fit, v->next);
    if (!b->r->depth_told) return;
    if (b->r->depth <= DEPTH_RADIAL && b->r->depth != g->depth_kind) {
        log_warn(b->log, "depth-kind", "--depth-kind contradicts the positions, which say %s",
                 word_of(depth_kind_words, g->depth_kind));
        g->depth_kind = b->r->depth;
        v->doubtful = true;
    } else if (b->r->depth > DEPTH_RADIAL && !b->position.z_measured) {
        log_warn(b->log, "depth-kind", "--depth-kind %s contradicts the positions; only the depth's background is used",
                 word_of(depth_kind_words, b->r->depth));
        v->doubtful = true;
    }
}

static double typical_depth(const build *b, size_t i, double unused)
{
    (void)unused;
    return b->position.z_wins ? b->sample.depth[i] : seen(b, i).z;
}

// Half floats have 11 bits. So the depths of a surface form steps, each several pixels wide where the surface faces the eye.
static void warn_half(build *b)
{
    const camera *c = &b->g->camera;
    const char *what = b->position.z_wins ? "depth is" : "positions are";
    sample_type type = b->position.z_wins ? b->position.z.type : b->position.p[0].type;
    if (type != SAMPLE_HALF) return;
    double pixel = (c->kind == CAMERA_PERSPECTIVE ? b->position.typical_depth : 1.0) / c->fx;
    log_warn(b->log, b->position.z_wins ? "half-depth" : "half-position",
             "%s stored as half floats and there is no finer pass: steps of %.2g units, %.2g pixels, at the median depth; "
             "expect stepped surfaces and bands in the occlusion; render them as float",
             what, 2.0 * b->position.rounding, 2.0 * b->position.rounding / pixel);
}

// P against Z where both are there: what Z means, and which is finer.
static void compare(build *b, double *scratch)
{
    b->position.lateral = median_by(b, scratch, lateral_step, 0.0) < 0.05;
    if (!b->position.has_z) return;
    settle_kind(b, scratch);
    double p = median_by(b, scratch, position_step, 0.0), z = median_by(b, scratch, depth_step, 0.0);
    b->position.z_wins = b->position.z_measured && p > 16.0 * z;
    if (b->position.z_wins)
        build_note(b, "depth comes from the depth channel: positions are rounded to %.2g units, it to %.2g", p, z);
}

bool measure_depth(build *b)
{
    gbuffer *g = b->g;
    if (b->position.has_p) g->depth_kind = b->r->depth == DEPTH_RADIAL ? DEPTH_RADIAL : DEPTH_PLANAR;
    b->position.z_wins = b->position.has_z && !b->position.has_p;
    b->position.z_measured = b->position.z_wins;
    if (b->sample.count == 0) return true;
    double *scratch = mem_pixels(b->sample.count, sizeof *scratch, b->e);
    if (!scratch) return false;
    if (b->position.has_p) compare(b, scratch);
    b->position.typical_depth = median_by(b, scratch, typical_depth, 0.0);
    b->position.rounding = median_by(b, scratch, b->position.z_wins ? depth_step : position_step, 0.0);
    warn_half(b);
    free(scratch);
    return true;
}
