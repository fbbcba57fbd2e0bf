#include "passes/planes.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/mem.h"

enum { SAMPLES = 4096, HYPOTHESES = 64, SCORED = 1024, REFINEMENTS = 2, TURNS = 18 };

// A sample lies on a plane if it is nearer to it than DISTANCE (a share of its depth) and if the cosine between the normals is at
// least COSINE (8 degrees). Uneven ground has limits of its own (37 degrees).
static const double DISTANCE = 0.002, UNEVEN_DISTANCE = 0.05;
static const double COSINE = 0.9902681, UNEVEN_COSINE = 0.8;

// Belief in a plane goes from none to full over a range: at a limit, a plane would come and go from one frame of a shot to the
// next.
typedef struct range {
    double from, to;
} range;

static const double THINNEST = 1e-3; // width over length of the support

static const range HELD = {0.0125, 0.03}, UNEVEN_HELD = {0.2, 0.3}; // share of all surfaces that the plane holds: more is better
static const range THROUGH = {2.0, 4.0};                            // samples seen through it over samples on it: less is better

static double along(range r, double x) { return fmin(fmax((x - r.from) / (r.to - r.from), 0.0), 1.0); }

typedef struct surface {
    vec3 p, n;
    double size; // unit of its distance from a plane: its depth; with an orthographic camera the frame's extent
} surface;

typedef struct finder {
    surface *s; // the `count` samples that no plane has taken come first
    int count, total;
    bool orthographic;
    double distance, cosine; // limits for a sample on a plane
} finder;

static vec3 normal_of(const gbuffer *gb, size_t i)
{
    const float *n = gb->normal + 4 * i;
    return v3((double)n[0], (double)n[1], (double)n[2]);
}

// Takes SAMPLES surfaces, or up to twice as many, on a square grid over the whole frame.
static void take_samples(const gbuffer *gb, finder *f)
{
    int step = (int)sqrt((double)gb->width * gb->height / SAMPLES);
    if (step < 1) step = 1;
    while ((gb->width / step + 1) * (gb->height / step + 1) > 2 * SAMPLES) step++;
    for (int y = step / 2; y < gb->height; y += step)
        for (int x = step / 2; x < gb->width; x += step) {
            size_t i = (size_t)y * (size_t)gb->width + (size_t)x;
            if (gb->depth[i] <= 0.0f) continue;
            double z = (double)gb->depth[i];
            f->s[f->count++] = (surface){gbuffer_position(gb, x, y), normal_of(gb, i), f->orthographic ? gb->extent : z};
        }
    f->total = f->count;
}

static bool holds(const finder *f, const plane *p, const surface *s)
{
    return fabs(v3_dot(p->normal, s->p) - p->offset) <= f->distance * s->size && v3_dot(p->normal, s->n) >= f->cosine;
}

// A different sample for every hypothesis, spread over the remaining ones.
static int pick(int i, int count) { return (int)(((uint32_t)i * 2654435769u >> 8) % (uint32_t)count); }

static plane best_hypothesis(const finder *f)
{
    plane best = {0};
    int most = -1, stride = f->count / SCORED + 1;
    for (int h = 0; h < HYPOTHESES; h++) {
        const surface *s = &f->s[pick(h, f->count)];
        plane p = {.normal = s->n, .offset = v3_dot(s->n, s->p)};
        int n = 0;
        for (int i = h % stride; i < f->count; i += stride) n += holds(f, &p, &f->s[i]);
        if (n > most) most = n, best = p;
    }
    return best;
}

// Eigenvector of the smallest eigenvalue of a symmetric matrix, by cyclic Jacobi rotations.
static vec3 smallest_axis(double a[3][3])
{
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int sweep = 0; sweep < 12; sweep++)
        for (int p = 0; p < 2; p++)
            for (int q = p + 1; q < 3; q++) {
                if (a[p][q] == 0.0) continue;
                double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                double t = copysign(1.0, theta) / (fabs(theta) + sqrt(theta * theta + 1.0)), c = 1.0 / sqrt(t * t + 1.0),
                       s = t * c;
                for (int k = 0; k < 3; k++) {
                    double x = a[k][p], y = a[k][q];
                    a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
                }
                for (int k = 0; k < 3; k++) {
                    double x = a[p][k], y = a[q][k];
                    a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
                    x = v[k][p], y = v[k][q];
                    v[k][p] = c * x - s * y, v[k][q] = s * x + c * y;
                }
            }
    int least = a[1][1] < a[0][0] ? 1 : 0;
    if (a[2][2] < a[least][least]) least = 2;
    return v3(v[0][least], v[1][least], v[2][least]);
}

// Least squares over what the plane holds.
static void refine(const finder *f, plane *p)
{
    vec3 mean = v3(0, 0, 0);
    int n = 0;
    for (int i = 0; i < f->count; i++)
        if (holds(f, p, &f->s[i])) mean = v3_add(mean, f->s[i].p), n++;
    if (n < 3) return;
    mean = v3_scale(mean, 1.0 / n);
    double a[3][3] = {{0}};
    for (int i = 0; i < f->count; i++) {
        if (!holds(f, p, &f->s[i])) continue;
        vec3 d = v3_sub(f->s[i].p, mean);
        const double k[3] = {d.x, d.y, d.z};
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) a[r][c] += k[r] * k[c];
    }
    vec3 normal = smallest_axis(a);
    if (v3_dot(normal, p->normal) < 0.0) normal = v3_scale(normal, -1.0);
    if (v3_dot(normal, p->normal) < f->cosine) return; // samples on a line say nothing
    p->normal = normal;
    p->offset = v3_dot(normal, mean);
}

static void support(const finder *f, plane *p)
{
    vec3 u = v3_normalize(v3_cross(p->normal, fabs(p->normal.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0))), v = v3_cross(p->normal, u);
    double least = INFINITY;
    for (int t = 0; t < TURNS; t++) {
        double angle = 0.5 * M_PI * t / TURNS, low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
        vec3 axis[2] = {v3_add(v3_scale(u, cos(angle)), v3_scale(v, sin(angle))),
                        v3_sub(v3_scale(v, cos(angle)), v3_scale(u, sin(angle)))};
        for (int i = 0; i < f->count; i++)
            for (int k = 0; k < 2 && holds(f, p, &f->s[i]); k++) {
                double x = v3_dot(axis[k], f->s[i].p);
                low[k] = fmin(low[k], x), high[k] = fmax(high[k], x);
            }
        double area = (high[0] - low[0]) * (high[1] - low[1]);
        if (!(area < least)) continue;
        least = area;
        for (int k = 0; k < 2; k++) {
            p->axis[k] = axis[k];
            p->centre[k] = 0.5 * (low[k] + high[k]), p->extent[k] = 0.5 * (high[k] - low[k]);
        }
    }
    // Samples on one line leave a strip without width, by which nothing can be divided.
    for (int k = 0; k < 2; k++) p->extent[k] = fmax(p->extent[k], THINNEST * p->extent[1 - k]);
}

// Moves the samples that the plane holds behind the remaining ones. Returns their number.
static int take(finder *f, const plane *p)
{
    int kept = 0, before = f->count;
    for (int i = 0; i < before; i++) {
        if (holds(f, p, &f->s[i])) continue;
        surface s = f->s[i];
        f->s[i] = f->s[kept];
        f->s[kept++] = s;
    }
    f->count = kept;
    return before - kept;
}

// Where a sample's view ray meets the plane; false behind the eye.
static bool meets(const finder *f, const plane *p, const surface *s, vec3 *hit)
{
    double along = f->orthographic ? p->normal.z : v3_dot(p->normal, s->p), off = p->offset - v3_dot(p->normal, s->p);
    *hit = f->orthographic ? v3(s->p.x, s->p.y, s->p.z + off / along) : v3_scale(s->p, p->offset / along);
    return hit->z > 0.0;
}

static int cell_of(const plane *p, int axis, vec3 at)
{
    double x = (v3_dot(p->axis[axis], at) - p->centre[axis]) / p->extent[axis]; // -1 .. 1
    return fabs(x) <= 1.0 ? (int)fmin((x + 1.0) * 0.5 * PLANE_CELLS, PLANE_CELLS - 1) : -1;
}

// Marks the cells of the support where the plane may be. A sample on the plane speaks for its cell. A sample that is seen through
// the plane speaks against its cell. Returns the number of samples seen through: it is large where uneven ground merely has many
// samples near one plane.
static int fill_cells(const finder *f, plane *p)
{
    int balance[PLANE_CELLS][PLANE_CELLS] = {{0}}, through = 0;
    for (int i = 0; i < f->total; i++) {
        const surface *s = &f->s[i];
        vec3 hit;
        bool on = holds(f, p, s);
        if (!meets(f, p, s, &hit) || (!on && hit.z > s->p.z - 2.0 * f->distance * s->size)) continue;
        int x = cell_of(p, 0, hit), y = cell_of(p, 1, hit);
        if (x < 0 || y < 0) continue;
        balance[y][x] += on ? 1 : -1;
        through += !on;
    }
    for (int y = 0; y < PLANE_CELLS; y++)
        for (int x = 0; x < PLANE_CELLS; x++) p->cells[y] = (unsigned short)(p->cells[y] | (balance[y][x] >= 0 ? 1u << x : 0u));
    return through;
}

// Finds the next plane among the samples that no plane has taken. Returns how many it takes; 0 if they are too few to be
// believed.
static int find_plane(finder *f, range held, plane *p)
{
    if (f->count <= held.from * f->total || f->count < 8) return 0;
    *p = best_hypothesis(f);
    for (int i = 0; i < REFINEMENTS; i++) refine(f, p);
    support(f, p);
    int n = take(f, p);
    p->margin = f->distance;
    p->share = (double)n / f->total;
    p->belief = along(held, p->share);
    if (p->belief > 0.0) p->belief *= 1.0 - along(THROUGH, (double)fill_cells(f, p) / n);
    return p->share > held.from ? n : 0;
}

bool planes_find(const gbuffer *gb, plane_set *out, error *e)
{
    *out = (plane_set){0};
    finder f = {.orthographic = gb->camera.kind == CAMERA_ORTHOGRAPHIC,
                .distance = DISTANCE,
                .cosine = COSINE,
                .s = mem_zero(2 * SAMPLES, sizeof *f.s, e)};
    if (!f.s) return false;
    take_samples(gb, &f);
    plane p;
    int n = 1;
    for (int tried = 0; n > 0 && tried < 2 * PLANES_MAX && out->count < PLANES_MAX; tried++) {
        n = find_plane(&f, HELD, &p);
        if (n > 0 && p.belief > 0.0) out->planes[out->count++] = p;
    }
    // Uneven ground is looked for among all samples that no accepted plane holds. Samples of refused planes are among them.
    f.count = f.total;
    for (int i = 0; i < out->count; i++) take(&f, &out->planes[i]);
    f.distance = UNEVEN_DISTANCE;
    f.cosine = UNEVEN_COSINE;
    n = find_plane(&f, UNEVEN_HELD, &p);
    if (n > 0 && p.belief > 0.0) out->planes[out->count] = p, out->uneven = 1;
    out->samples = f.total;
    out->found = true;
    if (f.orthographic)
        for (int i = 0; i < out->count + out->uneven; i++) out->planes[i].margin *= gb->extent;
    free(f.s);
    return true;
}
