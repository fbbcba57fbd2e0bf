// Round surfaces at their outlines. There a surface turns ever faster over the pixels, but evenly over the square root of the
// distance from the outline: a circle's angle is proportional to it near the outline, so that the normal, with the bumps on it,
// and the depth are smooth functions of that root. They are interpolated as polynomials of it, between the mixed pixel's mean and
// clean pixels further inside.
//
// The far side's share tells how far the outline is from the pixel's centre, if the filter is known. It counts as a box of one
// pixel or as a Gauss, whichever fits better where a line over an outline tells both.
#include "base/sort.h"
#include "gbuffer/filtered.h"

enum { CLEAN = 3, TERMS = 3, MOST_MEASURED = 256, LEAST_MEASURED = 8, MOST_TRIED = 4096 };
static const double BOX = 0.0; // no Gauss: all of a pixel counts alike
static const double least_width = 0.15, most_width = 1.0;
static const double telling = 0.1;     // 1 - cosine between both sides' normals, from which a mean's length tells the share
static const double steepest = 0.25;   // squared cosine between normal and ray, above which an outline is an edge
static const double grows = 0.4;       // of the growth of the squared cosine that a circle has
static const double even = 0.5;        // change of the turning, over itself
static const double turning = 0.02;    // of normals a pixel apart, that a round surface has
static const double aligned = 0.6;     // cosine between a step and the way inwards
static const double like = 0.8;        // cosine between normals of one surface a few pixels apart
static const double odd_normal = 0.05; // of the far side's normal: what a bump map adds from pixel to pixel
static const double most_odd = 4.0;    // of the deviation that is expected, by which two estimates differ at most
static const double near_by = 0.05;    // of the depth, that one surface may change in a few pixels

// The way inwards from a mixed pixel.
typedef struct way {
    int dx, dy;   // a step
    int first;    // the step that leads to the first of three clean pixels
    double along; // what a step goes inwards, in pixels
    double q[2];  // squared cosine between normal and ray at the first two
} way;

static const stored *clean_pixel(repair *r, const way *w, int k, int x, int y)
{
    int steps = w->first + k;
    return filtered_at(r, x + steps * w->dx, y + steps * w->dy);
}

static double clean_depth(repair *r, const way *w, int k, int x, int y)
{
    int steps = w->first + k;
    int u = x + steps * w->dx, v = y + steps * w->dy;
    return filtered_place(r, filtered_at(r, u, v), u, v).z;
}

static double squared_cosine(const repair *r, vec3 n, int x, int y)
{
    double c = v3_dot(v3_normalize(n), v3_normalize(build_ray(&r->b->g->camera, x, y)));
    return c * c;
}

static bool leads_to_clean(repair *r, const side *own, way *w, int x, int y)
{
    w->first = 1;
    while (w->first <= FILTER_REACH && !filtered_clean(r, x + w->first * w->dx, y + w->first * w->dy)) w->first++;
    for (int k = 0; k < CLEAN; k++)
        if (!filtered_clean(r, x + (w->first + k) * w->dx, y + (w->first + k) * w->dy)) return false;
    return v3_dot(clean_pixel(r, w, 0, x, y)->n, own->n) > like && fabs(clean_depth(r, w, 0, x, y) - own->z) < near_by * own->z;
}

// Of the steps that lead to clean pixels of the near surface the one that goes inwards most directly.
static bool find_way(repair *r, const mixture *m, int x, int y, way *out)
{
    vec3 ray = v3_normalize(build_ray(&r->b->g->camera, x, y)), across = v3_sub(m->n, v3_scale(ray, v3_dot(m->n, ray)));
    double flat = hypot(across.x, across.y), best = aligned;
    for (int k = 0; k < DIRECTIONS && flat > 0.3; k++) {
        way w = {.dx = filtered_step[k][0], .dy = filtered_step[k][1]};
        w.along = -(across.x * w.dx + across.y * w.dy) / flat;
        double cosine = w.along / hypot(w.dx, w.dy);
        if (cosine > best && leads_to_clean(r, m->near, &w, x, y)) best = cosine, *out = w;
    }
    if (!(best > aligned)) return false;
    for (int k = 0; k < 2; k++) {
        int steps = out->first + k;
        out->q[k] = squared_cosine(r, clean_pixel(r, out, k, x, y)->n, x + steps * out->dx, y + steps * out->dy);
    }
    return true;
}

// Whether the surface is round along the way: it faces the eye less towards the outline, and its normals turn evenly.
static bool is_round(repair *r, const mixture *m, const way *w, int x, int y)
{
    double d = 0.5 - m->share, s = d + w->first * w->along, q = squared_cosine(r, m->n, x, y), t[CLEAN];
    if (q > steepest || w->q[0] < q || !(s > 0.0)) return false;
    if (w->q[1] - w->q[0] < grows * w->q[0] * w->along / s) return false;
    vec3 n[CLEAN];
    for (int k = 0; k < CLEAN; k++) n[k] = clean_pixel(r, w, k, x, y)->n, t[k] = sqrt(s + k * w->along);
    vec3 outer = v3_scale(v3_sub(n[0], n[1]), 1.0 / (t[1] - t[0])), inner = v3_scale(v3_sub(n[1], n[2]), 1.0 / (t[2] - t[1]));
    if (v3_length(v3_sub(n[0], n[1])) < turning) return false;
    return v3_length(v3_sub(outer, inner)) <= even * fmax(v3_length(outer), v3_length(inner));
}

// The mixture with the share that the mean's length tells, where it does: that the near side turns does not mislead it.
static bool refine(const repair *r, const stored *s, mixture *m)
{
    bool by_alpha = m->far->z == 0.0 && r->b->alpha.data;
    if (!r->lengths || m->near->z == 0.0) return false;
    if (!by_alpha && 1.0 - v3_dot(m->n, m->far->n) > telling) m->share = filtered_share(r, s, m->far);
    if (!(m->share > -0.3 && m->share <= 0.5)) return false;
    m->n = filtered_without(r, s, m->far, m->share);
    return v3_length(m->n) > 0.5;
}

// Where a normal distribution leaves so much below it (Abramowitz and Stegun 26.2.23).
static double quantile(double p)
{
    if (p > 0.5) return -quantile(1.0 - p);
    double t = sqrt(-2.0 * log(fmax(p, 0.01)));
    return (2.515517 + 0.802853 * t + 0.010328 * t * t) / (1.0 + 1.432788 * t + 0.189269 * t * t + 0.001308 * t * t * t) - t;
}

// How far inwards from the outline the pixel's centre is.
static double distance_of(double width, double share) { return width == BOX ? 0.5 - share : width * quantile(1.0 - share); }

// Means of 1, root and square of the root of the distance from the outline, over what the filter sees of the surface around a
// distance.
static void means(const repair *r, double distance, double out[TERMS])
{
    const double width = r->width;
    if (width == BOX) {
        double from = fmax(distance - 0.5, 0.0), to = fmax(distance + 0.5, 1e-3);
        out[0] = 1.0, out[1] = 2.0 / 3.0 * (pow(to, 1.5) - pow(from, 1.5)) / (to - from), out[2] = 0.5 * (from + to);
        return;
    }
    double sum = 0.0, root = 0.0, square = 0.0;
    for (int k = 0; k <= QUADRATURE; k++) {
        double x = 6.0 * k / QUADRATURE - 3.0, s = distance + width * x, weight = r->bell[k];
        if (s > 0.0) sum += weight, root += weight * sqrt(s), square += weight * s;
    }
    out[0] = 1.0, out[1] = sum > 0.0 ? root / sum : 0.0, out[2] = sum > 0.0 ? square / sum : 0.0;
}

static double determinant(const double *a, const double *b, const double *c)
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) + c[0] * (a[1] * b[2] - a[2] * b[1]);
}

// Weights of three means by which a polynomial with these means has the mean `at`.
static bool weigh(double means_of[TERMS][TERMS], const double at[TERMS], double out[TERMS])
{
    const double *a = means_of[0], *b = means_of[1], *c = means_of[2];
    double all = determinant(a, b, c);
    if (!(fabs(all) > 1e-6)) return false;
    out[0] = determinant(at, b, c) / all, out[1] = determinant(a, at, c) / all, out[2] = determinant(a, b, at) / all;
    return true;
}

// Its value at the root.
static bool interpolate(double means_of[TERMS][TERMS], double root, double out[TERMS])
{
    const double at[TERMS] = {1.0, root, root * root};
    return weigh(means_of, at, out);
}

static void means_along(const repair *r, const way *w, double distance, double out[1 + CLEAN][TERMS])
{
    for (int k = 0; k <= CLEAN; k++) means(r, distance + (k ? w->first + k - 1 : 0) * w->along, out[k]);
}

// The stored depth tells the far side's share, too, once the depth of the near side's part is known. The less the normals of both
// sides differ, the less their length tells; the less the depths differ, the less these do. False where the share is left.
static bool weigh_depths(repair *r, const stored *s, const way *w, double known[1 + CLEAN][TERMS], int x, int y, mixture *m)
{
    double weights[TERMS], z = 0.0;
    if (m->far->z == 0.0 || !weigh(known + 1, known[0], weights)) return false;
    for (int k = 0; k < CLEAN; k++) z += weights[k] * clean_depth(r, w, k, x, y);
    if (!(fabs(z - m->near->z) < near_by * z) || !(m->far->z > z)) return false;
    const camera *c = &r->b->g->camera;
    vec3 near = filtered_values(r, x, y, z), gap = v3_sub(m->far->p, near);
    double share = v3_dot(v3_sub(s->p, near), gap) / v3_dot(gap, gap);
    double odd = (c->kind == CAMERA_PERSPECTIVE ? z : 1.0) / c->fx / (m->far->z - z); // a depth off by a pixel's size
    double odd_length = odd_normal / (1.0 - v3_dot(m->n, m->far->n));
    if (!(fabs(share - m->share) < most_odd * hypot(odd, odd_length))) return false;
    m->share += (share - m->share) * odd_length * odd_length / (odd_length * odd_length + odd * odd);
    return true;
}

bool filtered_outline(repair *r, const stored *s, const mixture *mixed, int x, int y, double *z, vec3 *n)
{
    mixture m = *mixed;
    way w;
    if (!r->has_width || !refine(r, s, &m) || !find_way(r, &m, x, y, &w) || !is_round(r, &m, &w, x, y)) return false;
    double known[1 + CLEAN][TERMS], weights[TERMS];
    double distance = distance_of(r->width, m.share);
    means_along(r, &w, distance, known);
    if (weigh_depths(r, s, &w, known, x, y, &m)) {
        if (!(m.share <= 0.5)) return false;
        m.n = filtered_without(r, s, m.far, m.share);
        distance = distance_of(r->width, m.share);
        means_along(r, &w, distance, known);
    }
    double root = sqrt(fmax(distance, 0.0));
    if (!interpolate(known, root, weights)) return false;
    vec3 at = v3_scale(m.n, weights[0]);
    for (int k = 0; k < 2; k++) at = v3_add(at, v3_scale(clean_pixel(r, &w, k, x, y)->n, weights[1 + k]));
    if (!(v3_dot(at, m.n) > 0.5) || !interpolate(known + 1, root, weights)) return false;
    *z = 0.0;
    for (int k = 0; k < CLEAN; k++) *z += weights[k] * clean_depth(r, &w, k, x, y);
    *n = v3_normalize(at);
    return fabs(*z - m.near->z) < near_by * m.near->z;
}

// The near side's share of a pixel beside the mixed one, of whose two sides it is a mean too; NaN if it is not.
static double share_beside(repair *r, const mixture *m, int x, int y)
{
    side list[SIDES];
    if (!filtered_inside(r->b, x, y)) return (double)NAN;
    const stored *s = filtered_at(r, x, y);
    if (filtered_clean(r, x, y)) return v3_dot(s->n, m->near->n) > v3_dot(s->n, m->far->n) ? 1.0 : 0.0;
    mixture beside = filtered_mixture(r, s, list, 0, filtered_sides(r, x, y, list));
    if (!isfinite(beside.rest)) return (double)NAN;
    bool same = (beside.far->z == 0.0) == (m->far->z == 0.0) && v3_dot(beside.near->n, m->near->n) > like;
    refine(r, s, &beside);
    return same ? 1.0 - beside.share : (double)NAN;
}

// What a pixel tells of the filter: the far side's share, and how far inwards from the outline the pixel's centre is.
typedef struct crossing {
    double share, distance;
} crossing;

// Along a line over the outline all shares of the near side add up to where the outline is, whatever the filter.
static bool cross(repair *r, int x, int y, crossing *out)
{
    side list[SIDES];
    way w;
    const stored *s = filtered_at(r, x, y);
    mixture m = filtered_mixture(r, s, list, 0, filtered_sides(r, x, y, list));
    if (!isfinite(m.rest) || !refine(r, s, &m) || m.share < 0.1 || m.share > 0.4) return false;
    if (!find_way(r, &m, x, y, &w) || !is_round(r, &m, &w, x, y) || (w.dx != 0 && w.dy != 0)) return false;
    double sum = 0.5 - m.share;
    for (int k = 1; k < w.first; k++) sum += share_beside(r, &m, x + k * w.dx, y + k * w.dy) - 1.0;
    for (int k = 1; k <= FILTER_REACH; k++) {
        double share = share_beside(r, &m, x - k * w.dx, y - k * w.dy);
        if (share == 0.0) break;
        sum += share;
    }
    *out = (crossing){m.share, sum * w.along};
    return isfinite(sum);
}

// The median of what the crossings say, or how far they are from a width, in the median.
static double median_of(const crossing *list, size_t count, const double *width)
{
    double v[MOST_MEASURED];
    for (size_t i = 0; i < count; i++)
        v[i] = width ? fabs(list[i].distance - distance_of(*width, list[i].share))
                     : list[i].distance / quantile(1.0 - list[i].share);
    sort_doubles(v, count);
    return v[count / 2];
}

void filtered_measure(repair *r)
{
    const build *b = r->b;
    const double box = BOX;
    crossing found[MOST_MEASURED];
    size_t seen = 0, count = 0, at = 0, width_in = (size_t)b->g->width;
    for (size_t k = 0; k < r->mixed_count; k++) seen += b->g->depth[r->mixed[k]] > 0.0f;
    size_t stride = seen / MOST_TRIED + 1;
    for (size_t k = 0; r->lengths && k < r->mixed_count && count < MOST_MEASURED; k++) {
        const size_t i = r->mixed[k];
        if (!(b->g->depth[i] > 0.0f) || at++ % stride != 0) continue;
        count += cross(r, (int)(i % width_in), (int)(i / width_in), &found[count]);
    }
    if (count < LEAST_MEASURED) return;
    double width = fmin(fmax(median_of(found, count, NULL), least_width), most_width);
    r->has_width = true;
    for (int k = 0; k <= QUADRATURE; k++) r->bell[k] = exp(-0.5 * (6.0 * k / QUADRATURE - 3.0) * (6.0 * k / QUADRATURE - 3.0));
    r->width = median_of(found, count, &box) <= median_of(found, count, &width) ? box : width;
}
