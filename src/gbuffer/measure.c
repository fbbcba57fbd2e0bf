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
    mat3 to_camera;
    bool unorm;
    const char *name;
    bool from_header; // then to_camera is the header's rotation, its axes read so that the normals fit
    bool inverse;     // and the matrix is the inverse of what the row says
    bool inwards;     // and the normals point into the surface
    double score;     // mean cosine between the normals read so and those of the surface
} reading;

// Sampled normals as stored, and the surface's own at the same places.
typedef struct evidence {
    vec3 stored[NORMAL_SAMPLES], surface[NORMAL_SAMPLES];
    size_t count;
    bool may_be_unorm; // only if no sampled component lies outside 0..1 can they be coded that way
} evidence;

static void gather(build *b, evidence *v)
{
    size_t stride = b->point_count / NORMAL_SAMPLES + 1;
    bool any = false;
    v->may_be_unorm = true;
    for (size_t i = 0; i < b->point_count; i += stride) {
        int x = (int)b->points[i].x, y = (int)b->points[i].y;
        vec3 n = v3(plane_get(&b->normal[0], x, y), plane_get(&b->normal[1], x, y), plane_get(&b->normal[2], x, y));
        double low = fmin(n.x, fmin(n.y, n.z)), high = fmax(n.x, fmax(n.y, n.z));
        if (!(b->raw[build_index(b, x, y)] > 0.0f) || !v3_finite(n)) continue;
        v->may_be_unorm = v->may_be_unorm && low >= -0.01 && high <= 1.01;
        any = any || high > 0.0;
        v->stored[v->count] = n, v->surface[v->count++] = normals_from_depth(b, b->raw, x, y);
    }
    v->may_be_unorm = v->may_be_unorm && any;
}

// Normals need not have unit length, but they have about one length: far beyond it lies what was never a normal.
static double longest(const evidence *v)
{
    double lengths[NORMAL_SAMPLES];
    for (size_t i = 0; i < v->count; i++) lengths[i] = v3_length(v->stored[i]);
    return 1000.0 * solve_median(lengths, v->count);
}

static double score(const evidence *v, const reading *r)
{
    double sum = 0.0, n = 0.0;
    for (size_t i = 0; i < v->count; i++) {
        vec3 s = v->stored[i];
        if (r->unorm) s = v3(2.0 * s.x - 1.0, 2.0 * s.y - 1.0, 2.0 * s.z - 1.0);
        s = v3_normalize(m3_apply(r->to_camera, s));
        if (!(v3_dot(s, s) > 0.5)) continue;
        sum += v3_dot(s, v->surface[i]), n += 1.0;
    }
    return n > 0.0 ? sum / n : 0.0;
}

static mat3 signs(double x, double y, double z) { return (mat3){{{x, 0, 0}, {0, y, 0}, {0, 0, z}}}; }

// Tries a reading; the convention's own stays unless another fits the surface clearly better: a flat picture fits several.
static void try_reading(const evidence *v, reading r, double first, reading *best)
{
    r.score = score(v, &r);
    if (r.score > best->score && r.score > first + 0.1) *best = r;
}

// The header's rotation with its axes in every order and sign, for writers differ in what they call x, y and z of a camera.
static void try_header(const build *b, const evidence *v, bool unorm, double first, reading *best)
{
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    const mat3 both[2] = {m3_transpose(b->pose.axes), b->pose.axes};
    for (int inverse = 0; inverse < 2; inverse++)
        for (int k = 0; k < 48; k++) {
            mat3 s = {{{0}}};
            for (int row = 0; row < 3; row++) s.m[row][orders[k / 8][row]] = k >> row & 1 ? -1.0 : 1.0;
            reading r = {.to_camera = m3_mul(s, both[inverse]),
                         .unorm = unorm,
                         .name = "world",
                         .from_header = true,
                         .inverse = inverse == 1};
            try_reading(v, r, first, best);
        }
}

static reading choose_reading(const build *b, const evidence *v)
{
    const convention *row = b->row;
    const char *own = b->g->position_is_camera_space ? "camera" : "world";
    const reading list[5] = {
        {.to_camera = m3_transpose(b->g->camera.world_from_camera), .name = own},
        {.to_camera = m3_transpose(m3_mul(b->pose.axes, b->pose.from_ours)), .name = "world", .from_header = true},
        {.to_camera = signs(1, -1, -1), .name = "camera"}, // y up, z back
        {.to_camera = signs(1, -1, 1), .name = "camera"},  // y up, z forward
        {.to_camera = signs(1, 1, 1), .name = "camera"},   // our own axes
    };
    const bool there[5] = {b->has_rotation, b->has_header_pose, true, true, true};
    bool known = row->normal_space != SPACE_CAMERA;
    reading best = list[known && there[0] ? 0 : known && there[1] ? 1 : 2];
    best.unorm = row->normal_encoding == NORMAL_UNORM && v->may_be_unorm;
    best.score = score(v, &best);
    const double first = best.score;
    for (int u = 0; u <= v->may_be_unorm; u++) {
        for (int i = 0; i < 5; i++) {
            reading r = list[i];
            r.unorm = u == 1;
            if (there[i]) try_reading(v, r, first, &best);
            r.to_camera = m3_mul(signs(-1, -1, -1), r.to_camera); // pointing inwards
            r.inwards = true;
            if (there[i]) try_reading(v, r, first, &best);
        }
        if (b->has_header_pose && best.score < 0.9) try_header(b, v, u == 1, first, &best);
    }
    return best;
}

// Where neither positions nor options know the camera's place in the world, the header does: as the normals confirm it, else as
// it is.
static void take_pose(build *b, const reading *r)
{
    if (!b->has_header_pose) return;
    const mat3 outwards = r->inwards ? m3_mul(signs(-1, -1, -1), r->to_camera) : r->to_camera;
    b->world_from_camera = r->from_header ? m3_transpose(outwards) : m3_mul(b->pose.axes, b->pose.from_ours);
    b->eye = r->from_header && r->inverse ? b->pose.inverse_eye : b->pose.eye;
    build_note(b, "the camera's place in the world is the header's%s",
               r->from_header ? ", and the normals agree" : ", unchecked");
}

bool measure_normals(build *b)
{
    bool done = true;
    reading best = {.name = "camera"};
    evidence *v = NULL;
    if (!b->has_normal || b->point_count == 0) goto out;
    v = mem_zero(1, sizeof *v, b->e);
    done = v != NULL;
    if (!done) goto out;
    gather(b, v);
    b->longest_normal = v->count ? longest(v) : INFINITY;
    best = choose_reading(b, v);
    b->normal_to_camera = best.to_camera, b->normal_unorm = best.unorm;
    if (best.score < 0.4) {
        log_warn(b->log, "normals-unrelated",
                 "the normals do not belong to the surface in any reading (mean cosine %.2f); they are rebuilt from depth",
                 best.score);
        b->has_normal = false;
        best.from_header = false;
        goto out;
    }
    build_note(b, "normals: %s space%s%s, mean cosine with the surface %.3f", best.name, best.unorm ? ", stored as 0..1" : "",
               best.inwards ? ", pointing inwards" : "", best.score);
out:
    if (done) take_pose(b, &best);
    free(v);
    return done;
}
