// What the normals of the file mean: which reading is taken, whether it is believed, and what follows for the camera's place.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "gbuffer/normal_hypotheses.h"
#include "gbuffer/rotation.h"
#include "gbuffer/solve.h"

// A smooth surface's normals are its own within 14 degrees for half of the samples, facets and interpolated normals included.
// Bumps may turn them further, but to all sides: then the rotation that would fit best is the reading's own within a few degrees.
static const double close_fit = 0.97, bumpy_fit = 0.8, bumpy_turn = 4.0, least_following = 0.6;

bool normals_believed(const normal_choice *c, const evidence *v)
{
    const reading *r = &c->best;
    if (v->count == 0 || c->one_way || !(r->follows > least_following)) return false;
    return r->fit >= close_fit || (r->fit >= bumpy_fit && r->source != FROM_ESTIMATE && c->turn < bumpy_turn);
}

// "-y +x +z": what of the stored vector the camera's (or the world's) axes are.
static void describe_axes(mat3 s, char buf[12])
{
    size_t used = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (fabs(s.m[i][j]) > 0.5)
                used += (size_t)snprintf(buf + used, 12 - used, "%s%c%c", i ? " " : "", s.m[i][j] < 0.0 ? '-' : '+', "xyz"[j]);
}

void reading_describe(const build *b, const reading *r, char *buf, size_t size)
{
    static const mat3 inwards = {{{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    static const double to_y_up[3] = {1, -1, -1}; // our camera's axes to y up, z backwards
    char axes[12] = "", turned[40] = "";
    mat3 t = r->turned;
    double off;
    if (r->source == FROM_CAMERA)
        for (int i = 0; i < 9; i++) t.m[i / 3][i % 3] *= to_y_up[i / 3];
    rotation_nearest_axes(t, &off);
    describe_axes(t, axes);
    if (memcmp(&t, &inwards, sizeof t) == 0)
        snprintf(turned, sizeof turned, " pointing inwards");
    else if (strcmp(axes, "+x +y +z") != 0 && r->source != FROM_ESTIMATE)
        snprintf(turned, sizeof turned, " of axes %s", axes);
    bool eye = r->source == FROM_CAMERA || (r->source == FROM_KNOWN && b->g->position_is_camera_space);
    bool coded = r->encoding != NORMAL_SIGNED;
    snprintf(buf, size, "%s%s%s%s%s%s", coded ? encoding_text(r->encoding) : "", coded ? ", " : "",
             eye ? "camera space"
             : r->source == FROM_ESTIMATE
                 ? (m3_det(r->to_camera) < 0.0 ? "a mirrored space of estimated rotation" : "a space of estimated rotation")
                 : "world space",
             turned, r->source == FROM_HEADER ? " by the header" : "", r->inverse ? ", its matrix inverted" : "");
}

// What the surfaces are made of: P itself where it is finer than a pixel, else the depth on the pixel's ray.
static bool surface_point(const build *b, const void *context, int x, int y, vec3 *p)
{
    (void)context;
    double z = (double)b->position.raw[build_index(b, x, y)];
    if (!(z > 0.0)) return false;
    bool whole = b->position.has_p && b->position.lateral && !b->position.z_wins;
    *p = whole ? camera_from_world(&b->g->camera, build_position(b, x, y)) : build_point(&b->g->camera, x, y, z);
    return true;
}

// Normals need not have unit length, but they have about one length: far beyond it lies what was never a normal.
static double longest(const evidence *v)
{
    double lengths[EVIDENCE_SAMPLES];
    for (size_t i = 0; i < v->count; i++) lengths[i] = v3_length(v->stored[i]);
    return 1000.0 * solve_median(lengths, v->count);
}

// The files' normals at the samples that hold one.
static void drop_unusable(evidence *v)
{
    size_t n = 0;
    for (size_t i = 0; i < v->count; i++) {
        if (!v3_finite(v->stored[i]) || v3_length(v->stored[i]) == 0.0) continue;
        v->stored[n] = v->stored[i], v->surface[n] = v->surface[i], v->weight[n++] = v->weight[i];
    }
    v->count = n;
}

// Where neither positions nor options know the camera's place in the world, the header does: as the normals confirm it, else as
// it is. Without a header the normals themselves know the rotation, unless it is one that camera axes of another order would
// give.
static void take_pose(build *b, const reading *r, bool believed)
{
    bool by_header = believed && r->source == FROM_HEADER, by_normals = believed && r->source == FROM_ESTIMATE;
    mat3 outwards = r->to_camera;
    if (memcmp(&r->turned, &(mat3){{{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}}, sizeof outwards) == 0)
        for (int i = 0; i < 9; i++) outwards.m[i / 3][i % 3] *= -1.0;
    if (b->camera.has_header_pose) {
        b->camera.world_from_camera =
            by_header ? m3_transpose(outwards) : m3_mul(b->camera.header.axes, b->camera.header.from_ours);
        b->camera.eye = by_header && r->inverse ? b->camera.header.inverse_eye : b->camera.header.eye;
        build_note(b, "the camera's place in the world is the header's%s", by_header ? ", and the normals agree" : ", unchecked");
        return;
    }
    bool knows_world = b->camera.has_rotation && !b->g->position_is_camera_space;
    if (!by_normals || knows_world) return;
    double degrees;
    rotation_nearest_axes(r->to_camera, &degrees);
    b->camera.rotation_from_normals = degrees > 1.0 || b->options->normal_space == SPACE_WORLD;
    b->camera.world_from_camera = m3_transpose(r->to_camera);
    build_note(
        b, b->camera.rotation_from_normals
               ? "the camera's rotation is that which takes the normals to the surfaces; which axis is up is assumed (--env-up)"
               : "the normals are turned by a signed order of the axes: camera or world space (--normal-space says)");
}

static void tell(build *b, const normal_choice *c, verdict *out)
{
    reading_describe(b, &c->best, out->reading, sizeof out->reading);
    out->measure = "median cosine with the surface";
    out->fit = c->best.fit, out->next = c->next;
    char next[40] = "";
    if (isfinite(out->next)) snprintf(next, sizeof next, " (next best %.3f)", out->next);
    build_note(b, "normals: %s, fit %.3f%s", out->reading, out->fit, next);
}

static void refuse(build *b, const normal_choice *c, verdict *out)
{
    out->doubtful = true;
    log_warn(b->log, "normals-unrelated",
             c->one_way
                 ? "the normals all point one way while the surfaces do not (median cosine %.2f): a tangent-space or "
                   "constant pass; they are rebuilt from depth (--normal names another layer)"
                 : "the normals do not fit the surfaces in any reading (median cosine %.2f at best); they are rebuilt from "
                   "depth (--normal names another layer, --normal-space and --normal-encoding say how to read this one)",
             c->best.fit);
    b->normal.there = false;
}

bool measure_normals(build *b)
{
    verdict *out = &b->g->normal_verdict;
    normal_choice c = {.best = {.to_camera = m3_identity()}};
    bool done = true, believed = false;
    evidence *v = NULL;
    out->present = b->normal.there, out->fit = out->next = (double)NAN;
    if (!b->normal.there || b->sample.count == 0) goto out;
    v = mem_zero(1, sizeof *v, b->e);
    done = v != NULL;
    if (!done) goto out;
    evidence_gather(b, surface_point, NULL, evidence_step(b, b->position.rounding, b->position.typical_depth), EVIDENCE_SAMPLES,
                    v);
    drop_unusable(v);
    b->normal.longest = v->count ? longest(v) : INFINITY;
    done = normals_choose(b, v, out, &c);
    if (!done) goto out;
    b->normal.to_camera = c.best.to_camera, b->normal.encoding = c.best.encoding;
    bool told = b->options->normal_space != SPACE_UNKNOWN && b->options->encoding_told;
    believed = normals_believed(&c, v);
    tell(b, &c, out);
    if (!believed && !told)
        refuse(b, &c, out);
    else if (!believed) {
        out->doubtful = true;
        log_warn(b->log, "normals-told",
                 "the normals, read as --normal-space and --normal-encoding say, do not fit the surfaces (median cosine %.2f)",
                 c.best.fit);
    }
out:
    if (done) take_pose(b, &c.best, believed);
    out->used = b->normal.there;
    free(v);
    return done;
}
