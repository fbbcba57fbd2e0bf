// The camera of the frame: flag, then fit, then header, then one plane.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "gbuffer/build.h"
#include "gbuffer/camera_header.h"
#include "gbuffer/camera_solve.h"
#include "gbuffer/solve.h"

static const double least_inliers = 0.5;

static bool from_flag(build *b, bool *given)
{
    gbuffer *g = b->g;
    const gbuffer_options *o = b->options;
    *given = true;
    if (o->camera_file)
        return camera_from_json(o->camera_file, g->data_window, g->display_window, g->pixel_aspect, &g->camera, b->e);
    if (o->fov > 0.0)
        camera_from_fov(o->fov, g->data_window, g->display_window, g->pixel_aspect, &g->camera);
    else if (o->ortho > 0.0)
        camera_from_ortho(o->ortho, g->data_window, g->display_window, g->pixel_aspect, &g->camera);
    else
        *given = false;
    return true;
}

static bool from_header(const build *b, camera *out)
{
    double m[4][4];
    const gbuffer *g = b->g;
    if (!b->file->core) return false;
    size_t count = b->position.has_p ? b->sample.count : 0;
    if (exrio_attr_m44(b->file, exrio_attr_part(b->file, b->r->main_part, "worldToNDC"), "worldToNDC", m) &&
        camera_from_ndc(m, g->data_window, g->display_window, b->sample.points, count, out))
        return true;
    // A lens alone cannot be held against the positions.
    return count == 0 &&
           camera_from_lens(b->file, b->r->main_part, &b->row->camera, g->data_window, g->display_window, g->pixel_aspect, out);
}

static bool from_plane(build *b, camera *out, error *e)
{
    if (!b->position.has_z || b->r->depth == DEPTH_RADIAL) return false;
    const gbuffer *g = b->g;
    double cx = (double)g->display_window.x0 - g->data_window.x0 + 0.5 * box2_width(g->display_window);
    double cy = (double)g->display_window.y0 - g->data_window.y0 + 0.5 * box2_height(g->display_window);
    return camera_fit_plane(b->sample.points, b->sample.depth, b->sample.count, g->pixel_aspect, cx, cy, out, e);
}

// An orthographic fit cannot tell a scene from its mirror image in depth; Z can, and else the normals, which face the eye.
static void settle_direction(const build *b, camera *c)
{
    if (c->kind != CAMERA_ORTHOGRAPHIC) return;
    mat3 *m = &c->world_from_camera;
    vec3 forward = v3(m->m[0][2], m->m[1][2], m->m[2][2]);
    double agreement = 0.0, mean_z = 0.0, mean_depth = 0.0, n = (double)b->sample.count;
    for (size_t i = 0; i < b->sample.count && b->position.has_z; i++)
        mean_z += v3_dot(forward, b->sample.points[i].world) / n, mean_depth += b->sample.depth[i] / n;
    for (size_t i = 0; i < b->sample.count; i++) {
        const camera_point *p = &b->sample.points[i];
        if (b->position.has_z)
            agreement += (v3_dot(forward, p->world) - mean_z) * (b->sample.depth[i] - mean_depth);
        else if (b->normal.there) {
            int x = (int)p->x, y = (int)p->y;
            vec3 normal =
                v3(plane_get(&b->normal.n[0], x, y), plane_get(&b->normal.n[1], x, y), plane_get(&b->normal.n[2], x, y));
            if (v3_finite(normal)) agreement -= v3_dot(forward, normal);
        }
    }
    for (int r = 0; r < 3 && agreement < 0.0; r++) m->m[r][2] = -m->m[r][2];
}

// The fit, or what stands in for it when the positions leave the camera open.
static bool from_positions(build *b, camera *out, error *e)
{
    error plane_error = {0};
    camera header;
    bool has_header = from_header(b, &header);
    if (camera_fit(b->sample.points, b->sample.count, out, e)) {
        if (has_header)
            build_note(b, "header camera agrees: it puts the positions within %.2g pixels of their places", header.residual);
        else if (b->file->core &&
                 exrio_attr_exists(b->file, exrio_attr_part(b->file, b->r->main_part, "worldToNDC"), "worldToNDC"))
            build_note(b, "header camera disagrees with the positions and is not used");
        settle_direction(b, out);
        return true;
    }
    if (e->code == ERR_MEMORY) return false;
    if (has_header) {
        *out = header;
    } else if (!from_plane(b, out, &plane_error)) {
        if (plane_error.code == ERR_MEMORY) *e = plane_error;
        return false;
    }
    *e = (error){0};
    return true;
}

// Pose for a camera whose lens the user gave: that of the fit, refined with the lens held fixed.
static bool pose_for_lens(build *b, camera *lens)
{
    camera fitted;
    error e = {0};
    if (!from_positions(b, &fitted, &e)) {
        if (e.code == ERR_MEMORY) err_set(b->e, e.code, NULL, NULL, "%s", e.message);
        return false;
    }
    if (fitted.kind != lens->kind) return false;
    if (fabs(fitted.fx / lens->fx - 1.0) > 0.005)
        log_warn(b->log, "lens-disagrees",
                 "the positions say a focal length of %.6g pixels, the option says %.6g; the option is used", fitted.fx,
                 lens->fx);
    double *weights = mem_pixels(b->sample.count + 1, sizeof *weights, b->e);
    if (!weights) return false;
    double limit = fmax(5.0 * fitted.residual, 1.0);
    for (size_t i = 0; i < b->sample.count; i++)
        weights[i] = camera_point_error(&fitted, &b->sample.points[i]) < limit ? 1.0 : 0.0;
    lens->world_from_camera = fitted.world_from_camera, lens->origin = fitted.origin, lens->has_world = true;
    bool good = camera_refine(lens, b->sample.points, NULL, weights, b->sample.count, FREE_POSE, NULL);
    free(weights);
    return good;
}

// Axes of P's space that are the camera's own (up to their signs), and an origin at the eye.
static bool is_camera_space(const build *b, const camera *c)
{
    if (b->row->position_space == SPACE_WORLD) return false;
    double size = 0.0;
    for (size_t i = 0; i < b->sample.count; i++) size += v3_length(b->sample.points[i].world) / (double)b->sample.count;
    for (int i = 0; i < 3; i++)
        if (fabs(fabs(c->world_from_camera.m[i][i]) - 1.0) > 1e-5) return false;
    return c->kind == CAMERA_ORTHOGRAPHIC || v3_length(c->origin) < 1e-3 * size;
}

static void describe(build *b)
{
    static const char *const sources[] = {[CAMERA_FROM_FLAG] = "given",
                                          [CAMERA_FROM_FIT] = "fitted to the positions",
                                          [CAMERA_FROM_HEADER] = "from the header",
                                          [CAMERA_FROM_PLANE] = "from one plane of positions and depth"};
    const camera *c = &b->g->camera;
    const char *kind = c->kind == CAMERA_PERSPECTIVE ? "perspective" : "orthographic";
    build_note(b, "camera: %s, %s, %s %.7g x %.7g, centre %.6g, %.6g", kind, sources[c->source],
               c->kind == CAMERA_PERSPECTIVE ? "focal length in pixels" : "pixels per unit", c->fx, c->fy, c->cx, c->cy);
    if (c->residual >= 0.0)
        build_note(b, "positions lie %.3g pixels from their own pixel (median), %.1f %% within half a pixel", c->residual,
                   100.0 * c->inliers);
}

// Only where nothing better says where the camera is in the world.
static void find_header_pose(build *b, const camera *c)
{
    if (b->camera.has_rotation && !b->g->position_is_camera_space) return;
    b->camera.has_header_pose = camera_header_pose(b->file, b->r->main_part, &b->row->camera, &b->camera.header);
    if (b->camera.has_header_pose || b->camera.has_rotation || c->source != CAMERA_FROM_HEADER || !c->has_world) return;
    b->camera.header = (header_pose){c->world_from_camera, m3_identity(), c->origin, c->origin};
    b->camera.has_header_pose = true;
}

// What the positions are, and whether they are what they are taken for: most lie on the rays of their pixels.
static void judge_positions(build *b)
{
    const camera *c = &b->g->camera;
    verdict *v = &b->g->position_verdict;
    if (!b->camera.has_pose) return;
    const char *space = b->g->position_is_camera_space ? "camera space" : "world space";
    snprintf(v->reading, sizeof v->reading, "%s%s", space, m3_det(c->world_from_camera) < 0.0 ? ", left-handed" : "");
    v->measure = "median distance in pixels between the positions and their pixels";
    v->fit = c->residual;
    verdict_try(v, v->reading, c->residual, c->residual);
    v->doubtful = c->inliers < least_inliers;
    if (v->doubtful)
        log_warn(
            b->log, "position-doubt",
            "only %.0f %% of the positions lie within half a pixel of their own pixels (median %.2g pixels): they may be those "
            "of a reference pose, of another frame or another camera (--position names another layer)",
            100.0 * c->inliers, c->residual);
}

static bool finish(build *b, camera *c)
{
    if (b->position.has_p && c->has_world) {
        b->camera.has_pose = true;
        camera_residual(c, b->sample.points, b->sample.count, &c->residual, &c->inliers);
        if (c->residual < 0.0)
            return err_set(b->e, ERR_MEMORY, NULL, NULL, "out of memory; try a smaller frame or fewer frames in flight");
    }
    b->position.far_pixels = fmax(3.0, 10.0 * c->residual);
    b->camera.has_rotation = b->camera.has_pose || (c->source == CAMERA_FROM_FLAG && c->has_world);
    if (b->camera.has_pose && c->source != CAMERA_FROM_FLAG && is_camera_space(b, c)) {
        b->g->position_is_camera_space = true;
        build_note(b, "positions are in camera space");
    }
    find_header_pose(b, c);
    describe(b);
    judge_positions(b);
    return true;
}

bool choose_camera(build *b)
{
    camera *c = &b->g->camera;
    bool given;
    b->g->position_verdict = (verdict){.present = b->position.has_p, .fit = (double)NAN, .next = (double)NAN};
    if (!from_flag(b, &given)) return false;
    if (b->sample.count == 0) {
        // Nothing to see: any camera will do.
        if (!given && !from_header(b, c)) camera_from_fov(50.0, b->g->data_window, b->g->display_window, b->g->pixel_aspect, c);
        return true;
    }
    if (given) {
        if (!b->position.has_p || c->has_world || pose_for_lens(b, c)) return finish(b, c);
        if (b->e->code != ERR_NONE) return false;
        if (!b->position.has_z)
            return err_set(b->e, ERR_INPUT, b->file->path, NULL,
                           "the camera's pose cannot be found from the positions; give it with --camera (world_from_camera)");
        b->g->position_verdict.doubtful = true;
        log_warn(b->log, "pose-unknown", "the camera's pose cannot be found from the positions; depth is used instead of them");
        b->position.has_p = false;
        return finish(b, c);
    }
    if (b->position.has_p) {
        error e = {0};
        if (from_positions(b, c, &e)) return finish(b, c);
        return err_set(b->e, e.code, b->file->path, NULL, "%s", e.message);
    }
    if (from_header(b, c)) return finish(b, c);
    return err_set(b->e, ERR_INPUT, b->file->path, NULL,
                   "the file holds depth but no positions and no camera; give the camera with --fov, --ortho or --camera");
}
