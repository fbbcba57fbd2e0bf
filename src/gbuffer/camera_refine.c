// Levenberg-Marquardt refinement of a camera.
#include <string.h>

#include "gbuffer/camera_solve.h"
#include "gbuffer/solve.h"

// Parameters: fx, fy, cx, cy, three rotation angles about the camera's axes, the translation of camera_from_world.
enum { PARAMETERS = 10 };

typedef struct state {
    camera_kind kind;
    double fx, fy, cx, cy;
    mat3 rotation; // camera_from_world
    vec3 translation;
} state;

typedef struct sums {
    double jtj[PARAMETERS][PARAMETERS], jtr[PARAMETERS], cost;
} sums;

static state state_of(const camera *c)
{
    state s = {.kind = c->kind, .fx = c->fx, .fy = c->fy, .cx = c->cx, .cy = c->cy};
    s.rotation = m3_transpose(c->world_from_camera);
    s.translation = v3_scale(m3_apply(s.rotation, c->origin), -1.0);
    return s;
}

static void camera_of(const state *s, camera *c)
{
    c->fx = s->fx, c->fy = s->fy, c->cx = s->cx, c->cy = s->cy;
    c->world_from_camera = m3_transpose(s->rotation);
    c->origin = v3_scale(m3_apply(c->world_from_camera, s->translation), -1.0);
}

// Rotation by |w| about w (Rodrigues).
static mat3 rotation_by(vec3 w)
{
    double angle = v3_length(w);
    mat3 r = m3_identity();
    if (!(angle > 0.0)) return r;
    vec3 a = v3_scale(w, 1.0 / angle);
    double s = sin(angle), c = 1.0 - cos(angle);
    const double k[3][3] = {{0, -a.z, a.y}, {a.z, 0, -a.x}, {-a.y, a.x, 0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double kk = k[i][0] * k[0][j] + k[i][1] * k[1][j] + k[i][2] * k[2][j];
            r.m[i][j] += s * k[i][j] + c * kk;
        }
    return r;
}

// Rows of the unit vectors again, keeping the handedness: repeated small rotations drift.
static mat3 orthonormal(mat3 r)
{
    double hand = m3_det(r) < 0.0 ? -1.0 : 1.0;
    vec3 a = v3_normalize(v3(r.m[0][0], r.m[0][1], r.m[0][2])), b = v3(r.m[1][0], r.m[1][1], r.m[1][2]);
    b = v3_normalize(v3_sub(b, v3_scale(a, v3_dot(a, b))));
    vec3 c = v3_scale(v3_cross(a, b), hand);
    return (mat3){{{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}}};
}

// d(value)/d(parameters) for a value whose gradient by the camera-space position is `g`.
static void pose_part(vec3 g, vec3 rotated, double j[PARAMETERS])
{
    vec3 w = v3_cross(rotated, g); // g . (w x rotated) = w . (rotated x g)
    j[4] = w.x, j[5] = w.y, j[6] = w.z;
    j[7] = g.x, j[8] = g.y, j[9] = g.z;
}

static void accumulate(sums *s, const double j[PARAMETERS], double residual, double w, bool derivatives)
{
    s->cost += w * residual * residual;
    if (!derivatives) return;
    for (int r = 0; r < PARAMETERS; r++) {
        if (j[r] == 0.0) continue;
        s->jtr[r] += w * j[r] * residual;
        for (int c = r; c < PARAMETERS; c++) s->jtj[r][c] += w * j[r] * j[c];
    }
}

static void add_pixel(sums *s, const state *k, const camera_point *point, vec3 rotated, vec3 p, double w, bool derivatives)
{
    double scale = k->kind == CAMERA_PERSPECTIVE ? 1.0 / p.z : 1.0;
    double u = p.x * scale, v = p.y * scale;
    bool perspective = k->kind == CAMERA_PERSPECTIVE;
    double jx[PARAMETERS] = {[0] = u, [2] = 1.0}, jy[PARAMETERS] = {[1] = v, [3] = 1.0};
    pose_part(v3(k->fx * scale, 0.0, perspective ? -k->fx * u * scale : 0.0), rotated, jx);
    pose_part(v3(0.0, k->fy * scale, perspective ? -k->fy * v * scale : 0.0), rotated, jy);
    accumulate(s, jx, k->cx + k->fx * u - point->x, w, derivatives);
    accumulate(s, jy, k->cy + k->fy * v - point->y, w, derivatives);
}

static void add_depth(sums *s, const state *k, double depth, vec3 rotated, vec3 p, double w, bool derivatives)
{
    double scale = k->kind == CAMERA_PERSPECTIVE ? k->fx / depth : k->fx, j[PARAMETERS] = {0};
    pose_part(v3(0.0, 0.0, scale), rotated, j);
    accumulate(s, j, (p.z - depth) * scale, w, derivatives);
}

// A point that falls behind the eye makes the step unacceptable: infinite cost.
static sums evaluate(const state *k, const camera_point *points, const double *planar_depth, const double *weights, size_t count,
                     bool derivatives)
{
    sums s = {.cost = 0.0};
    for (size_t i = 0; i < count; i++) {
        double w = weights ? weights[i] : 1.0;
        if (!(w > 0.0)) continue;
        vec3 rotated = m3_apply(k->rotation, points[i].world), p = v3_add(rotated, k->translation);
        if (k->kind == CAMERA_PERSPECTIVE && !(p.z > 0.0)) {
            s.cost = INFINITY;
            return s;
        }
        add_pixel(&s, k, &points[i], rotated, p, w, derivatives);
        if (planar_depth) add_depth(&s, k, planar_depth[i], rotated, p, w, derivatives);
    }
    for (int r = 0; r < PARAMETERS; r++)
        for (int c = 0; c < r; c++) s.jtj[r][c] = s.jtj[c][r];
    return s;
}

// The indices of the free parameters; -1 ends the list. With tied focal lengths fy's derivatives are folded into fx's.
static int free_list(const state *k, unsigned mask, bool depth, sums *s, int list[PARAMETERS])
{
    int n = 0;
    if (mask & FREE_F_TIED) {
        double ratio = k->fy / k->fx;
        for (int i = 0; i < PARAMETERS; i++) s->jtj[0][i] += ratio * s->jtj[1][i];
        for (int i = 0; i < PARAMETERS; i++) s->jtj[i][0] += ratio * s->jtj[i][1];
        s->jtr[0] += ratio * s->jtr[1];
    }
    if (mask & (FREE_FX | FREE_F_TIED)) list[n++] = 0;
    if (mask & FREE_FY) list[n++] = 1;
    bool perspective = k->kind == CAMERA_PERSPECTIVE;
    if ((mask & FREE_CENTRE) && perspective) list[n++] = 2, list[n++] = 3;
    // Orthographic: the centre is the translation's double, and z has no effect unless depth is observed.
    for (int i = 4; i < PARAMETERS && (mask & FREE_POSE); i++)
        if (perspective || depth || i != 9) list[n++] = i;
    return n;
}

static state step(const state *k, unsigned mask, const int *list, int n, const double *delta)
{
    double d[PARAMETERS] = {0};
    for (int i = 0; i < n; i++) d[list[i]] = delta[i];
    if (mask & FREE_F_TIED) d[1] = d[0] * k->fy / k->fx;
    state next = *k;
    next.fx += d[0], next.fy += d[1], next.cx += d[2], next.cy += d[3];
    next.rotation = orthonormal(m3_mul(rotation_by(v3(d[4], d[5], d[6])), k->rotation));
    next.translation = v3_add(k->translation, v3(d[7], d[8], d[9]));
    // The rotation acts on R X alone, so the translation stays as it is.
    return next;
}

static bool solve_step(const sums *s, const int *list, int n, double lambda, double *delta)
{
    double a[PARAMETERS * PARAMETERS];
    for (int r = 0; r < n; r++) {
        for (int c = 0; c < n; c++) a[r * n + c] = s->jtj[list[r]][list[c]] * (r == c ? 1.0 + lambda : 1.0);
        delta[r] = -s->jtr[list[r]];
    }
    return solve_linear(n, a, delta);
}

// Relative standard deviation of fx (list[0]) for unit noise, from the inverse of the scaled normal matrix.
static double spread_of(const state *k, const sums *s, const int *list, int n)
{
    double a[PARAMETERS * PARAMETERS], b[PARAMETERS] = {1.0}, scale[PARAMETERS];
    for (int i = 0; i < n; i++) {
        scale[i] = sqrt(s->jtj[list[i]][list[i]]);
        if (!(scale[i] > 0.0)) return INFINITY;
    }
    for (int r = 0; r < n; r++)
        for (int c = 0; c < n; c++) a[r * n + c] = s->jtj[list[r]][list[c]] / (scale[r] * scale[c]);
    if (n == 0 || !solve_linear(n, a, b) || !(b[0] > 0.0)) return INFINITY;
    return sqrt(b[0]) / scale[0] / k->fx;
}

bool camera_refine(camera *c, const camera_point *points, const double *planar_depth, const double *weights, size_t count,
                   unsigned free_mask, double *focal_spread)
{
    state k = state_of(c);
    sums s = evaluate(&k, points, planar_depth, weights, count, true);
    if (!isfinite(s.cost)) return false;
    double lambda = 1e-4;
    int list[PARAMETERS], n = free_list(&k, free_mask, planar_depth != NULL, &s, list);
    for (int iteration = 0; iteration < 60 && lambda < 1e12; iteration++) {
        double delta[PARAMETERS];
        state next;
        sums trial = {.cost = INFINITY};
        if (solve_step(&s, list, n, lambda, delta)) {
            next = step(&k, free_mask, list, n, delta);
            if (next.fx > 0.0 && next.fy > 0.0) trial = evaluate(&next, points, planar_depth, weights, count, false);
        }
        if (!(trial.cost <= s.cost)) {
            lambda *= 10.0;
            continue;
        }
        double gain = s.cost - trial.cost;
        k = next;
        s = evaluate(&k, points, planar_depth, weights, count, true);
        n = free_list(&k, free_mask, planar_depth != NULL, &s, list);
        lambda *= 0.1;
        if (gain <= 1e-13 * s.cost || s.cost <= 1e-26 * (double)count) break;
    }
    if (focal_spread) *focal_spread = spread_of(&k, &s, list, n);
    camera_of(&k, c);
    return true;
}
