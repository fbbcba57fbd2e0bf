// Which way an orthographic camera looks. Its positions fit a scene and that scene's mirror image in depth equally well. Where
// there is no depth channel, positions in camera space lie in front of their origin, and the normals tell: they fit the surfaces
// of both, but of one in the likelier reading. Where neither tells, or both say otherwise, that is said; a world is then taken to
// be right-handed.
#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/normal_hypotheses.h"

enum { SAMPLES = 800 };

static bool point_of(const build *b, const void *context, int x, int y, vec3 *p)
{
    (void)context;
    if (x < 0 || y < 0 || x >= b->g->width || y >= b->g->height || b->surface[build_index(b, x, y)] != SURFACE_YES) return false;
    *p = camera_from_world(&b->g->camera, build_position(b, x, y));
    return true;
}

static void turn_round(camera *c)
{
    for (int r = 0; r < 3; r++) c->world_from_camera.m[r][2] = -c->world_from_camera.m[r][2];
}

static bool ask(build *b, evidence *v, normal_choice *out)
{
    verdict ignored = {0};
    evidence_gather(b, point_of, NULL, 1, SAMPLES, v);
    return normals_choose(b, v, &ignored, out);
}

// How unlikely a direction is: by the reading of the normals, and by a left-handed space of the positions.
static int cost(const normal_choice *c, double determinant)
{
    static const int of_kind[KINDS] = {[KIND_TURNED] = 2, [KIND_ESTIMATE] = 3};
    return of_kind[c->best.kind] + (determinant < 0.0);
}

// Below 0: the first direction is likelier. *clear: by more than a left-handed space alone would be.
static int compare(const normal_choice *a, const normal_choice *b, double determinant, bool *clear)
{
    const double much = 0.02; // mean loss
    int by = cost(a, determinant) - cost(b, -determinant);
    *clear = true;
    if (fabs(a->best.loss - b->best.loss) > much) return a->best.loss < b->best.loss ? -1 : 1;
    *clear = by < -1 || by > 1;
    return by != 0 ? by : determinant < 0.0;
}

// Positions in camera space: the origin lies in the middle of the picture, and all surfaces well to one side of it. +1 or -1 for
// a camera that looks to that side or away from it, 0 where it is no such space.
static int side_of_origin(const build *b)
{
    const camera *c = &b->g->camera;
    double x, y, low = INFINITY, high = -INFINITY;
    vec3 origin = camera_from_world(c, v3(0, 0, 0));
    if (!b->g->position_is_camera_space || !camera_project(c, v3(origin.x, origin.y, 1.0), &x, &y)) return 0;
    if (fabs(x - 0.5 * b->g->width) > 0.5 || fabs(y - 0.5 * b->g->height) > 0.5) return 0;
    for (size_t i = 0; i < b->sample.count; i++) {
        double z = camera_from_world(c, b->sample.points[i].world).z - origin.z;
        low = fmin(low, z), high = fmax(high, z);
    }
    if (low > 0.1 * high) return 1;
    return high < 0.1 * low ? -1 : 0;
}

bool orthographic_settle(build *b)
{
    camera *c = &b->g->camera;
    if (c->kind != CAMERA_ORTHOGRAPHIC || !b->camera.has_pose || b->position.has_z || c->source != CAMERA_FROM_FIT) return true;
    double determinant = m3_det(c->world_from_camera);
    int worse = determinant < 0.0;
    bool clear = false;
    if (b->normal.there) {
        evidence *v = mem_zero(1, sizeof *v, b->e);
        normal_choice as_it_is, turned;
        bool ok = v && ask(b, v, &as_it_is);
        turn_round(c);
        ok = ok && ask(b, v, &turned);
        turn_round(c);
        free(v);
        if (!ok) return false;
        worse = compare(&as_it_is, &turned, determinant, &clear);
    }
    int side = side_of_origin(b);
    if (side != 0) {
        clear = !clear || worse == 0 || (worse > 0) == (side < 0);
        worse = -side;
    }
    if (worse > 0) turn_round(c);
    b->g->position_verdict.doubtful = b->g->position_verdict.doubtful || !clear;
    if (!clear)
        log_warn(
            b->log, "position-direction",
            "the positions of an orthographic camera do not tell front from back, and the normals hardly do; the likelier way "
            "is taken (a depth pass tells, or --camera)");
    return true;
}
