// What the file's depth and normals mean, by comparing them with the positions.
#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/build.h"
#include "gbuffer/solve.h"

static const double same_depth = 0.01; // relative: Z within this of one kind is that kind
enum { NORMAL_SAMPLES = 3000 };

typedef struct comparison {
    double planar, radial, offset; // median relative errors; orthographic: offset = median of z - Z
    double position_step, depth_step;
} comparison;

static double step_of(sample_type type) { return type == SAMPLE_HALF ? 0x1p-11 : 0x1p-24; }

static double median_by(build *b, double *scratch, double (*value)(const build *, size_t, double), double parameter)
{
    for (size_t i = 0; i < b->point_count; i++) scratch[i] = value(b, i, parameter);
    return solve_median(scratch, b->point_count);
}

static vec3 seen(const build *b, size_t i) { return camera_from_world(&b->g->camera, b->points[i].world); }
static double planar_error(const build *b, size_t i, double offset)
{
    double z = seen(b, i).z;
    return fabs(b->point_depth[i] + offset - z) / fabs(z);
}
static double radial_error(const build *b, size_t i, double unused)
{
    (void)unused;
    double r = v3_length(seen(b, i));
    return fabs(b->point_depth[i] - r) / r;
}
static double offset_of(const build *b, size_t i, double unused)
{
    (void)unused;
    return seen(b, i).z - b->point_depth[i];
}
// Rounding steps of P (largest component) and of Z, in units of depth.
static double position_step(const build *b, size_t i, double unused)
{
    (void)unused;
    vec3 p = b->points[i].world;
    return fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))) * step_of(b->position[0].type);
}
static double depth_step(const build *b, size_t i, double unused)
{
    (void)unused;
    return b->point_depth[i] * step_of(b->depth.type);
}
// P's rounding seen from the camera, in pixels.
static double lateral_step(const build *b, size_t i, double unused)
{
    const camera *c = &b->g->camera;
    double scale = c->kind == CAMERA_PERSPECTIVE ? c->fx / fabs(seen(b, i).z) : c->fx;
    return position_step(b, i, unused) * scale;
}

static void settle_kind(build *b, double *scratch)
{
    gbuffer *g = b->g;
    bool perspective = g->camera.kind == CAMERA_PERSPECTIVE;
    b->depth_offset = perspective ? 0.0 : median_by(b, scratch, offset_of, 0.0);
    double planar = median_by(b, scratch, planar_error, b->depth_offset);
    double radial = perspective ? median_by(b, scratch, radial_error, 0.0) : INFINITY;
    g->depth_kind = radial < planar ? DEPTH_RADIAL : DEPTH_PLANAR;
    b->depth_measured = fmin(planar, radial) < same_depth;
    if (!b->depth_measured)
        build_note(b, "depth is neither planar nor radial distance (off by %.2g %% at best); only its background is used",
                   100.0 * fmin(planar, radial));
    else
        build_note(b, "depth: %s (median difference from the positions %.2g; as %s %.2g)",
                   g->depth_kind == DEPTH_RADIAL ? "radial" : "planar", fmin(planar, radial),
                   g->depth_kind == DEPTH_RADIAL ? "planar" : "radial", fmax(planar, radial));
    if (b->r->depth != DEPTH_AUTO && b->r->depth != g->depth_kind) {
        log_warn(b->log, "depth-kind", "--depth-kind contradicts the positions, which say %s",
                 g->depth_kind == DEPTH_RADIAL ? "radial" : "planar");
        g->depth_kind = b->r->depth;
    }
}

bool measure_depth(build *b)
{
    gbuffer *g = b->g;
    g->depth_kind = b->r->depth == DEPTH_AUTO ? DEPTH_PLANAR : b->r->depth;
    b->depth_wins = b->has_depth && !b->has_position;
    b->depth_measured = b->depth_wins;
    if (!b->has_position || b->point_count == 0) return true;
    double *scratch = mem_pixels(b->point_count, sizeof *scratch, b->e);
    if (!scratch) return false;
    b->lateral = median_by(b, scratch, lateral_step, 0.0) < 0.05;
    if (b->has_depth) {
        settle_kind(b, scratch);
        double p = median_by(b, scratch, position_step, 0.0), z = median_by(b, scratch, depth_step, 0.0);
        b->depth_wins = b->depth_measured && p > 16.0 * z;
        if (b->depth_wins)
            build_note(b, "depth comes from the depth channel: positions are rounded to %.2g units, it to %.2g", p, z);
    }
    if (b->position[0].type == SAMPLE_HALF && !b->depth_wins)
        log_warn(
            b->log, "half-position",
            "positions are stored as half floats and there is no finer depth: expect stepped surfaces; render them as float");
    free(scratch);
    return true;
}

// One way to read the normals.
typedef struct reading {
    space space;
    bool unorm;
    double sign_y, sign_z;
    double score; // mean cosine between the normals read so and those of the surface
} reading;

static void apply(build *b, const reading *r)
{
    b->normal_space = r->space, b->normal_unorm = r->unorm;
    b->normal_sign_y = r->sign_y, b->normal_sign_z = r->sign_z;
}

static double score(build *b, const reading *r)
{
    size_t stride = b->point_count / NORMAL_SAMPLES + 1;
    double sum = 0.0, n = 0.0;
    apply(b, r);
    for (size_t i = 0; i < b->point_count; i += stride) {
        int x = (int)b->points[i].x, y = (int)b->points[i].y;
        vec3 normal;
        if (!(b->raw[build_index(b, x, y)] > 0.0f) || !normals_read(b, x, y, &normal)) continue;
        sum += v3_dot(normal, normals_from_depth(b, b->raw, x, y));
        n += 1.0;
    }
    return n > 0.0 ? sum / n : 0.0;
}

// Only if no sampled component lies outside 0..1 can they be coded that way.
static bool may_be_unorm(const build *b)
{
    bool any = false;
    for (size_t i = 0; i < b->point_count; i++)
        for (int c = 0; c < 3; c++) {
            double v = plane_get(&b->normal[c], (int)b->points[i].x, (int)b->points[i].y);
            if (v < -0.01 || v > 1.01) return false;
            any = any || v > 0.0;
        }
    return any;
}

// The convention's reading stays unless another fits the surface clearly better: a flat picture fits several.
void measure_normals(build *b)
{
    if (!b->has_normal || b->point_count == 0) return;
    const convention *row = b->row;
    bool unorm = row->normal_encoding == NORMAL_UNORM, coded = may_be_unorm(b);
    bool world = row->normal_space != SPACE_CAMERA && b->has_pose;
    reading best = {world ? SPACE_WORLD : SPACE_CAMERA, unorm, -1.0, -1.0, 0.0};
    best.score = score(b, &best);
    const double first = best.score;
    static const double signs[3][2] = {{-1, -1}, {-1, 1}, {1, 1}}; // y up z back; y up z forward; our own axes
    for (int u = 0; u <= (coded || unorm); u++)
        for (int k = b->has_pose ? 0 : 1; k < 4; k++) {
            reading r = {k == 0 ? SPACE_WORLD : SPACE_CAMERA, u == 1, k ? signs[k - 1][0] : -1, k ? signs[k - 1][1] : -1, 0.0};
            r.score = score(b, &r);
            if (r.score > best.score && r.score > first + 0.1) best = r;
        }
    apply(b, &best);
    if (best.score < 0.4) {
        log_warn(b->log, "normals-unrelated",
                 "the normals do not belong to the surface in any reading (mean cosine %.2f); they are rebuilt from depth",
                 best.score);
        b->has_normal = false;
        return;
    }
    build_note(b, "normals: %s space%s, mean cosine with the surface %.3f", best.space == SPACE_WORLD ? "world" : "camera",
               best.unorm ? ", stored as 0..1" : "", best.score);
}
