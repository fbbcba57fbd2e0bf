// The camera of a frame that shows one plane: positions and pixels alone leave the focal length open there, planar depth settles
// it.
//
// With square pixels and a known centre, depth gives the camera-space position up to the focal length: perspective
// (z (x - cx) / f, z (y - cy) / f, z), orthographic ((x - cx) / f, (y - cy) / f, z). Distances are the same in both spaces, so
// any pair of points yields 1/f^2 = (D^2 - dz^2) / (du^2 + dv^2), which needs no homography; the pose is the rotation between the
// two sets of positions (Horn 1987, unit quaternions). A plane cannot tell a mirrored world: determinant +1 is taken.
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "gbuffer/camera_solve.h"
#include "gbuffer/solve.h"

enum { LEAST = 12, PAIRS = 2048, TRIPLES = 400, SCORED = 512 };

typedef struct problem {
    camera_kind kind;
    const camera_point *points;
    const double *depth;
    size_t count;
    double aspect, cx, cy;
    double *weights, *errors;
} problem;

// (x - cx, y - cy) in units of horizontal pixels, times z for a perspective camera.
static vec3 sheared(const problem *k, size_t i)
{
    double scale = k->kind == CAMERA_PERSPECTIVE ? k->depth[i] : 1.0;
    return v3((k->points[i].x - k->cx) * scale, (k->points[i].y - k->cy) / k->aspect * scale, k->depth[i]);
}

// 1/f^2 from a set of at least two points (sums over all pairs of a triple); <= 0 when it is impossible.
static double inverse_focal_squared(const problem *k, const size_t *picked, int n)
{
    double top = 0.0, bottom = 0.0;
    for (int a = 0; a < n; a++)
        for (int b = 0; b < a; b++) {
            vec3 d = v3_sub(sheared(k, picked[a]), sheared(k, picked[b]));
            vec3 w = v3_sub(k->points[picked[a]].world, k->points[picked[b]].world);
            top += v3_dot(w, w) - d.z * d.z;
            bottom += d.x * d.x + d.y * d.y;
        }
    return bottom > 0.0 ? top / bottom : 0.0;
}

// The pose that takes world positions to the camera-space positions of focal length f (Horn's quaternion).
static bool pose_of(const problem *k, double f, const size_t *picked, size_t n, const double *weights, camera *c)
{
    vec3 mean_w = {0}, mean_c = {0};
    double sum = 0.0, s[3][3] = {{0}};
    for (int pass = 0; pass < 2; pass++) {
        for (size_t j = 0; j < n; j++) {
            size_t i = picked ? picked[j] : j;
            double w = weights ? weights[i] : 1.0;
            vec3 q = sheared(k, i), p = k->points[i].world;
            q.x /= f, q.y /= f;
            if (pass == 0) {
                mean_w = v3_add(mean_w, v3_scale(p, w)), mean_c = v3_add(mean_c, v3_scale(q, w));
                sum += w;
                continue;
            }
            p = v3_sub(p, mean_w), q = v3_sub(q, mean_c);
            const double pp[3] = {p.x, p.y, p.z}, qq[3] = {q.x, q.y, q.z};
            for (int a = 0; a < 3; a++)
                for (int b = 0; b < 3; b++) s[a][b] += w * pp[a] * qq[b];
        }
        if (pass == 0) mean_w = v3_scale(mean_w, 1.0 / sum), mean_c = v3_scale(mean_c, 1.0 / sum);
    }
    double a[16] = {s[0][0] + s[1][1] + s[2][2],  s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0], s[1][2] - s[2][1],
                    s[0][0] - s[1][1] - s[2][2],  s[0][1] + s[1][0], s[2][0] + s[0][2], s[2][0] - s[0][2], s[0][1] + s[1][0],
                    -s[0][0] + s[1][1] - s[2][2], s[1][2] + s[2][1], s[0][1] - s[1][0], s[2][0] + s[0][2], s[1][2] + s[2][1],
                    -s[0][0] - s[1][1] + s[2][2]};
    double values[4], vectors[16];
    solve_eigen(4, a, values, vectors);
    const double *q = vectors + 12;
    double w = q[0], x = q[1], y = q[2], z = q[3];
    mat3 r = {{{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
               {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
               {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}}};
    *c = (camera){.kind = k->kind, .source = CAMERA_FROM_PLANE, .fx = f, .fy = f * k->aspect, .cx = k->cx, .cy = k->cy};
    c->has_world = true;
    c->world_from_camera = m3_transpose(r);
    c->origin = v3_sub(mean_w, m3_apply(c->world_from_camera, mean_c));
    return isfinite(f) && f > 0.0 && v3_finite(c->origin) && v3_length(v3(w, x, y)) + fabs(z) > 0.5;
}

// Pixels off, and depth off expressed in pixels, together.
static double error_of(const problem *k, const camera *c, size_t i)
{
    double pixels = camera_point_error(c, &k->points[i]);
    double dz = camera_from_world(c, k->points[i].world).z - k->depth[i];
    dz *= k->kind == CAMERA_PERSPECTIVE ? c->fx / k->depth[i] : c->fx;
    double both = hypot(pixels, dz);
    return both < 1e30 ? both : 1e30;
}

static bool search(const problem *k, camera *best)
{
    uint64_t random = 7;
    double least = INFINITY;
    size_t stride = k->count / SCORED + 1;
    for (int trial = 0; trial < TRIPLES; trial++) {
        size_t picked[3];
        for (int i = 0; i < 3; i++) picked[i] = (size_t)(solve_random(&random) % k->count);
        double g = inverse_focal_squared(k, picked, 3), sum = 0.0;
        camera c;
        if (!(g > 0.0) || !pose_of(k, 1.0 / sqrt(g), picked, 3, NULL, &c)) continue;
        for (size_t i = 0; i < k->count; i += stride) {
            double r = error_of(k, &c, i);
            sum += fmin(r * r, 16.0);
        }
        if (sum < least) least = sum, *best = c;
    }
    return isfinite(least);
}

// Returns the median error in pixels, INFINITY on failure.
static double solve(const problem *k, camera *c)
{
    if (!search(k, c)) return INFINITY;
    for (int round = 0; round < 5; round++) {
        for (size_t i = 0; i < k->count; i++) k->weights[i] = k->errors[i] = error_of(k, c, i);
        double limit = fmax(3.0 * solve_median(k->weights, k->count), 0.05);
        for (size_t i = 0; i < k->count; i++) k->weights[i] = k->errors[i] < limit ? 1.0 : 0.0;
        if (!camera_refine(c, k->points, k->depth, k->weights, k->count, FREE_F_TIED | FREE_POSE, NULL)) return INFINITY;
    }
    for (size_t i = 0; i < k->count; i++) k->weights[i] = error_of(k, c, i);
    return solve_median(k->weights, k->count);
}

// Points near the origin of their own coordinates, so that nothing is lost by squaring.
static size_t copy_shifted(const camera_point *points, const double *depth, size_t count, camera_point *to, double *to_depth,
                           vec3 *centre)
{
    size_t n = 0;
    for (size_t i = 0; i < count; i++) {
        if (!v3_finite(points[i].world) || !(depth[i] > 0.0) || !isfinite(depth[i])) continue;
        if (n == 0) *centre = points[i].world;
        to[n] = points[i];
        to[n].world = v3_sub(points[i].world, *centre);
        to_depth[n++] = depth[i];
    }
    return n;
}

bool camera_fit_plane(const camera_point *points, const double *planar_depth, size_t count, double pixel_aspect, double cx,
                      double cy, camera *out, error *e)
{
    bool done = false;
    vec3 centre = {0};
    camera_point *copy = mem_pixels(count + 1, sizeof *copy, e);
    double *scratch = mem_pixels(3 * count + 1, sizeof *scratch, e);
    if (!copy || !scratch) goto out;
    size_t n = copy_shifted(points, planar_depth, count, copy, scratch, &centre);
    if (n >= LEAST) {
        problem k = {.points = copy, .depth = scratch, .count = n, .aspect = pixel_aspect > 0.0 ? pixel_aspect : 1.0};
        k.cx = cx, k.cy = cy, k.weights = scratch + count, k.errors = scratch + 2 * count;
        camera orthographic;
        double perspective_error = solve(&k, out);
        k.kind = CAMERA_ORTHOGRAPHIC;
        double orthographic_error = solve(&k, &orthographic);
        // A plane seen face on fits both; then perspective is the likelier camera.
        if (orthographic_error < 0.8 * perspective_error - 1e-3) *out = orthographic, perspective_error = orthographic_error;
        done = perspective_error < 2.0;
    }
    if (!done) {
        err_set(e, ERR_INPUT, NULL, NULL,
                "the positions do not determine the camera, and neither do positions and depth together with square pixels and a "
                "centred camera; give the camera with --fov, --ortho or --camera");
        goto out;
    }
    out->origin = v3_add(out->origin, centre);
    camera_residual(out, points, count, &out->residual, &out->inliers);
out:
    free(copy);
    free(scratch);
    return done;
}
