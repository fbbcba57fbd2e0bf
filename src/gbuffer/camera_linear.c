// Linear camera fits: the DLT, the affine fit, and taking a projection matrix apart.
#include <string.h>

#include "gbuffer/camera_solve.h"
#include "gbuffer/solve.h"

typedef struct scaling {
    vec3 centre;
    double size;      // world: u = (X - centre) / size
    double px, py, s; // pixels: (x - px) / s
} scaling;

static scaling scaling_of(const camera_point *points, const double *weights, size_t count)
{
    scaling k = {.size = 0.0};
    double sum = 0.0, spread = 0.0;
    for (size_t i = 0; i < count; i++) {
        double w = weights ? weights[i] : 1.0;
        k.centre = v3_add(k.centre, v3_scale(points[i].world, w));
        k.px += w * points[i].x, k.py += w * points[i].y;
        sum += w;
    }
    k.centre = v3_scale(k.centre, 1.0 / sum), k.px /= sum, k.py /= sum;
    for (size_t i = 0; i < count; i++) {
        double w = weights ? weights[i] : 1.0;
        k.size += w * v3_length(v3_sub(points[i].world, k.centre));
        spread += w * hypot(points[i].x - k.px, points[i].y - k.py);
    }
    k.size /= sum, k.s = spread / sum;
    if (!(k.size > 0.0) || !isfinite(k.size)) k.size = 1.0;
    if (!(k.s > 0.0) || !isfinite(k.s)) k.s = 1.0;
    return k;
}

static void homogeneous(const scaling *k, vec3 world, double h[4])
{
    vec3 u = v3_scale(v3_sub(world, k->centre), 1.0 / k->size);
    h[0] = u.x, h[1] = u.y, h[2] = u.z, h[3] = 1.0;
}

// m in scaled coordinates to m in world and pixel coordinates.
static void unscale(const scaling *k, projection *p)
{
    for (int r = 0; r < 2; r++)
        for (int c = 0; c < 4; c++) p->m[r][c] = k->s * p->m[r][c] + (r == 0 ? k->px : k->py) * p->m[2][c];
    for (int r = 0; r < 3; r++) {
        double *m = p->m[r];
        m[0] /= k->size, m[1] /= k->size, m[2] /= k->size;
        m[3] -= m[0] * k->centre.x + m[1] * k->centre.y + m[2] * k->centre.z;
    }
}

// Points lie in front of the eye: the sign for which most of the weight has a positive third component.
static void orient(const camera_point *points, const double *weights, size_t count, projection *p)
{
    double front = 0.0;
    const double *m = p->m[2];
    for (size_t i = 0; i < count; i++) {
        vec3 q = points[i].world;
        double w = weights ? weights[i] : 1.0;
        front += m[0] * q.x + m[1] * q.y + m[2] * q.z + m[3] > 0.0 ? w : -w;
    }
    for (int r = 0; r < 3 && front < 0.0; r++)
        for (int c = 0; c < 4; c++) p->m[r][c] = -p->m[r][c];
}

// The 12x12 normal matrix of the DLT is built of four symmetric 4x4 sums.
static bool fit_dlt(const camera_point *points, const double *weights, size_t count, const projection *previous, projection *out)
{
    scaling k = scaling_of(points, weights, count);
    double sums[4][4][4] = {{{0}}};
    for (size_t i = 0; i < count; i++) {
        double h[4], w = weights ? weights[i] : 1.0;
        if (!(w > 0.0)) continue;
        homogeneous(&k, points[i].world, h);
        double depth = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2] + 1.0);
        if (previous) {
            vec3 q = points[i].world;
            const double *m = previous->m[2];
            depth = fabs(m[0] * q.x + m[1] * q.y + m[2] * q.z + m[3]);
            if (!(depth > 1e-12 * k.size * v3_length(v3(m[0], m[1], m[2])))) continue;
        }
        w /= depth * depth;
        double u = (points[i].x - k.px) / k.s, v = (points[i].y - k.py) / k.s;
        const double factor[4] = {w, w * u, w * v, w * (u * u + v * v)};
        for (int f = 0; f < 4; f++)
            for (int r = 0; r < 4; r++)
                for (int c = r; c < 4; c++) sums[f][r][c] += factor[f] * h[r] * h[c];
    }
    double a[144] = {0}, vector[12];
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            int i = r < c ? r : c, j = r < c ? c : r;
            a[r * 12 + c] = a[(r + 4) * 12 + c + 4] = sums[0][i][j];
            a[r * 12 + c + 8] = a[(c + 8) * 12 + r] = -sums[1][i][j];
            a[(r + 4) * 12 + c + 8] = a[(c + 8) * 12 + r + 4] = -sums[2][i][j];
            a[(r + 8) * 12 + c + 8] = sums[3][i][j];
        }
    if (!solve_smallest(12, a, vector)) return false;
    *out = (projection){.kind = CAMERA_PERSPECTIVE};
    memcpy(out->m, vector, sizeof out->m);
    unscale(&k, out);
    orient(points, weights, count, out);
    return isfinite(out->m[0][3]) && isfinite(out->m[1][3]) && isfinite(out->m[2][3]);
}

static bool fit_affine(const camera_point *points, const double *weights, size_t count, projection *out)
{
    scaling k = scaling_of(points, weights, count);
    double a[16] = {0}, copy[16], b[2][4] = {{0}};
    for (size_t i = 0; i < count; i++) {
        double h[4], w = weights ? weights[i] : 1.0;
        homogeneous(&k, points[i].world, h);
        for (int r = 0; r < 4; r++) {
            for (int c = 0; c < 4; c++) a[r * 4 + c] += w * h[r] * h[c];
            b[0][r] += w * h[r] * (points[i].x - k.px) / k.s;
            b[1][r] += w * h[r] * (points[i].y - k.py) / k.s;
        }
    }
    memcpy(copy, a, sizeof a);
    if (!solve_linear(4, a, b[0]) || !solve_linear(4, copy, b[1])) return false;
    *out = (projection){.kind = CAMERA_ORTHOGRAPHIC};
    memcpy(out->m, b, sizeof b);
    out->m[2][3] = 1.0;
    unscale(&k, out);
    return true;
}

bool projection_fit(camera_kind kind, const camera_point *points, const double *weights, size_t count, const projection *previous,
                    projection *out)
{
    return kind == CAMERA_PERSPECTIVE ? fit_dlt(points, weights, count, previous, out) : fit_affine(points, weights, count, out);
}

double projection_error(const projection *p, const camera_point *point)
{
    vec3 q = point->world;
    double h[3];
    for (int r = 0; r < 3; r++) h[r] = p->m[r][0] * q.x + p->m[r][1] * q.y + p->m[r][2] * q.z + p->m[r][3];
    if (!(h[2] > 0.0)) return 1e30;
    double dx = h[0] / h[2] - point->x, dy = h[1] / h[2] - point->y, distance = sqrt(dx * dx + dy * dy);
    return distance < 1e30 ? distance : 1e30;
}

static vec3 row(const projection *p, int r) { return v3(p->m[r][0], p->m[r][1], p->m[r][2]); }

static mat3 columns(vec3 a, vec3 b, vec3 c) { return (mat3){{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}}}; }

static bool perspective_camera(const projection *p, camera *out)
{
    double scale = v3_length(row(p, 2));
    if (!(scale > 0.0)) return false;
    vec3 m1 = v3_scale(row(p, 0), 1.0 / scale), m2 = v3_scale(row(p, 1), 1.0 / scale), r3 = v3_scale(row(p, 2), 1.0 / scale);
    double t1 = p->m[0][3] / scale, t2 = p->m[1][3] / scale, t3 = p->m[2][3] / scale;
    out->cy = v3_dot(m2, r3);
    m2 = v3_sub(m2, v3_scale(r3, out->cy));
    out->fy = v3_length(m2);
    if (!(out->fy > 0.0)) return false;
    vec3 r2 = v3_scale(m2, 1.0 / out->fy);
    out->cx = v3_dot(m1, r3);
    double skew = v3_dot(m1, r2);
    m1 = v3_sub(v3_sub(m1, v3_scale(r3, out->cx)), v3_scale(r2, skew));
    out->fx = v3_length(m1);
    if (!(out->fx > 0.0)) return false;
    vec3 r1 = v3_scale(m1, 1.0 / out->fx);
    double ty = (t2 - out->cy * t3) / out->fy, tx = (t1 - out->cx * t3 - skew * ty) / out->fx;
    out->world_from_camera = columns(r1, r2, r3);
    out->origin = v3_scale(m3_apply(out->world_from_camera, v3(tx, ty, t3)), -1.0);
    return true;
}

// The two pixel axes are made perpendicular symmetrically: neither is preferred. The direction of view is x cross y: positions
// and pixels cannot tell it from its mirror image.
static bool orthographic_camera(const projection *p, camera *out)
{
    vec3 a = row(p, 0), b = row(p, 1);
    out->fx = v3_length(a), out->fy = v3_length(b);
    if (!(out->fx > 0.0) || !(out->fy > 0.0)) return false;
    a = v3_scale(a, 1.0 / out->fx), b = v3_scale(b, 1.0 / out->fy);
    vec3 plus = v3_normalize(v3_add(a, b)), minus = v3_normalize(v3_sub(a, b));
    if (!(v3_length(plus) > 0.5) || !(v3_length(minus) > 0.5)) return false;
    vec3 r1 = v3_scale(v3_add(plus, minus), sqrt(0.5)), r2 = v3_scale(v3_sub(plus, minus), sqrt(0.5));
    out->world_from_camera = columns(r1, r2, v3_cross(r1, r2));
    out->cx = p->m[0][3], out->cy = p->m[1][3];
    out->origin = v3(0, 0, 0);
    return true;
}

bool projection_to_camera(const projection *p, camera *out)
{
    *out = (camera){.kind = p->kind, .source = CAMERA_FROM_FIT, .has_world = true, .residual = -1.0};
    bool good = p->kind == CAMERA_PERSPECTIVE ? perspective_camera(p, out) : orthographic_camera(p, out);
    return good && isfinite(out->fx) && isfinite(out->fy) && isfinite(out->cx) && isfinite(out->cy) && v3_finite(out->origin);
}
