// Mends passes that went through the picture's reconstruction filter. At an edge their pixels are means of several surfaces, or
// of a surface and the background's zeros; a filter with negative lobes leaves values beyond either. Such a pixel is given one
// surface again.
//
// Each mixed pixel is explained as a mean of two of the sides around it. A clean pixel tells what each side is. With a symmetric
// filter, the pixel's centre belongs to the side with the larger share. The nearer side's normal turns at round outlines, so it
// is computed: the stored normal minus the farther side's share.
#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/build.h"

enum { REACH = 4 };
static const double odd_length = 0.01;    // of a normal: of one surface alone it keeps its length
static const double off_tangent = 0.05;   // of the step between neighbours
static const double most_bend = 0.5;      // second difference of depth over a pixel's size at that depth
static const double most_rest = 0.1;      // of a pixel's values that two surfaces do not explain, squared
static const double turn = 0.2;           // weight of a turn of the normal, squared, that only the pixel itself tells of
static const double odd_angle = 0.035;    // radians that normals are off the surface's
static const double bumped = 0.04;        // a bump map's turn of a normal
static const double least_turn = 0.02;    // of normals a pixel apart, that a round surface is told by
static const double uneven = 0.3;         // second difference of the squared cosines over the first: a fold, no round surface
static const double step_of_depth = 0.05; // of the depth, that counts as much as normals at right angles

typedef struct stored {
    vec3 p;    // camera space; depth alone: (0, 0, what the file's values are linear in)
    vec3 code; // of the normal, as it is stored: what the filter took the mean of
    vec3 n;    // decoded, in camera space, of the length that this gives; 0 without
    double alpha;
    bool clean;  // one surface
    vec3 mended; // normal
} stored;

typedef struct repair {
    build *b;
    stored *pixels;
    stored nothing; // what the background stores
    bool inverse;   // depth alone whose values are linear in 1 / z
    bool radial;    // depth alone: distance from the eye
    bool lengths;   // the normals have a length to go by
} repair;

static bool inside(const build *b, int x, int y) { return x >= 0 && y >= 0 && x < b->g->width && y < b->g->height; }

static double per_depth(const repair *r, int x, int y) { return r->radial ? v3_length(build_ray(&r->b->g->camera, x, y)) : 1.0; }

// The values of a surface at planar depth z on the ray of (x, y).
static vec3 value_at(const repair *r, int x, int y, double z)
{
    if (r->b->position.has_p) return build_point(&r->b->g->camera, x, y, z);
    return v3(0, 0, r->inverse ? 1.0 / z : z * per_depth(r, x, y));
}

// And back; 0 where there is none.
static double depth_of(const repair *r, vec3 p, int x, int y)
{
    if (r->b->position.has_p) return p.z;
    if (r->inverse) return p.z > 0.0 ? 1.0 / p.z : 0.0;
    return p.z / per_depth(r, x, y);
}

static stored read_pixel(const repair *r, int x, int y)
{
    const build *b = r->b;
    stored s = r->nothing;
    double alpha = plane_get(&b->alpha, x, y);
    if (b->position.has_p) {
        vec3 p = camera_from_world(&b->g->camera, build_position(b, x, y));
        if (v3_finite(p)) s.p = p;
    } else {
        double z = build_depth(b, x, y);
        if (z > 0.0 && isfinite(z)) s.p.z = r->inverse ? 1.0 / z : z;
    }
    s.code = normals_code(b, x, y);
    s.n = normals_decode(b, s.code);
    s.alpha = isfinite(alpha) ? alpha : 0.0;
    return s;
}

// Where a pixel's surface lies in camera space.
static vec3 place_of(const repair *r, int x, int y)
{
    const stored *s = &r->pixels[build_index(r->b, x, y)];
    return r->b->position.has_p ? s->p : build_point(&r->b->g->camera, x, y, depth_of(r, s->p, x, y));
}

// Whether the pixel and its neighbour lie on one smooth surface. With normals: the line between them is perpendicular to the mean
// of both normals. Or, because a bump map may have changed the normals: the line through the neighbour and the pixel beyond it
// leads to the pixel.
static bool continues(const repair *r, int x, int y, int dx, int dy)
{
    const build *b = r->b;
    if (!inside(b, x + dx, y + dy)) return false;
    vec3 here = place_of(r, x, y), next = place_of(r, x + dx, y + dy), step = v3_sub(next, here);
    if (!(next.z > 0.0)) return false;
    if (r->lengths) {
        const stored *s = &r->pixels[build_index(b, x, y)], *q = s + (dx + dy * b->g->width);
        if (fabs(v3_length(q->n) - 1.0) > 2.0 * odd_length) return false;
        if (fabs(v3_dot(v3_add(s->n, q->n), step)) < 2.0 * off_tangent * v3_length(step)) return true;
    }
    if (!inside(b, x + 2 * dx, y + 2 * dy)) return false;
    vec3 beyond = place_of(r, x + 2 * dx, y + 2 * dy);
    double pixel = (b->g->camera.kind == CAMERA_PERSPECTIVE ? here.z : 1.0) / b->g->camera.fx;
    return beyond.z > 0.0 && fabs(here.z - 2.0 * next.z + beyond.z) < most_bend * pixel;
}

// A clean pixel shows one surface: its normal has full length, and along each axis at least one neighbour continues it.
static bool is_clean(const repair *r, int x, int y)
{
    const build *b = r->b;
    const stored *s = &r->pixels[build_index(b, x, y)];
    if (!(b->g->depth[build_index(b, x, y)] > 0.0f) || !(place_of(r, x, y).z > 0.0)) return false;
    if (r->lengths && fabs(v3_length(s->n) - 1.0) > odd_length) return false;
    if (b->alpha.data && fabs(s->alpha - 1.0) > odd_length) return false;
    return (continues(r, x, y, -1, 0) || continues(r, x, y, 1, 0)) && (continues(r, x, y, 0, -1) || continues(r, x, y, 0, 1));
}

static vec3 made_normal(const build *b, int x, int y)
{
    const float *n = b->g->normal + 4 * build_index(b, x, y);
    return v3((double)n[0], (double)n[1], (double)n[2]);
}

// Planar depth where the ray of (x, y) meets the plane through pixel (u, v) with the normal n; the pixel's own where that is too
// oblique or leads far away.
static double carried(const build *b, int u, int v, vec3 n, int x, int y)
{
    const camera *c = &b->g->camera;
    vec3 at = build_point(c, u, v, (double)b->g->depth[build_index(b, u, v)]), d = build_ray(c, x, y);
    double cosine = v3_dot(n, d);
    if (fabs(cosine) < 0.02 * v3_length(d)) return at.z;
    double z = v3_dot(n, v3_sub(at, build_point(c, x, y, 0.0))) / cosine;
    return z > 0.5 * at.z && z < 2.0 * at.z ? z : at.z;
}

// What one of the surfaces around a pixel would store there.
typedef struct side {
    vec3 p, code, n;
    double alpha, z; // z: planar depth; 0 the background
    int u, v;        // of the clean pixel
} side;

enum { DIRECTIONS = 8, SIDES = DIRECTIONS + 1 };

// The nearest clean pixel in each direction, and the background if it is near.
static int gather_sides(const repair *r, int x, int y, side list[SIDES])
{
    static const int step[DIRECTIONS][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    const build *b = r->b;
    int count = 0;
    bool open = false;
    for (int k = 0; k < DIRECTIONS; k++)
        for (int d = 1; d <= REACH; d++) {
            int u = x + d * step[k][0], v = y + d * step[k][1];
            if (!inside(b, u, v)) break;
            size_t i = build_index(b, u, v);
            open = open || !(b->g->depth[i] > 0.0f) || (b->alpha.data && r->pixels[i].alpha < 0.5);
            if (!r->pixels[i].clean) continue;
            side s = {.code = r->pixels[i].code, .n = r->pixels[i].n, .alpha = 1.0, .u = u, .v = v};
            s.z = carried(b, u, v, made_normal(b, u, v), x, y);
            s.p = value_at(r, x, y, s.z);
            list[count++] = s;
            break;
        }
    if (open && count > 0) list[count++] = (side){.p = r->nothing.p, .code = r->nothing.code, .n = r->nothing.n};
    return count;
}

// A pixel as a mean of two sides: near, and far behind or beside it.
typedef struct mixture {
    const side *near, *far;
    double share; // of far
    vec3 n;       // of near
    double rest;  // what is not explained, squared
} mixture;

typedef struct values {
    double v[7];
} values;

static values values_of(const repair *r, double scale, vec3 p, vec3 code, double alpha)
{
    double weight = r->b->alpha.data ? 2.0 : 0.0, unit = r->b->normal.encoding == NORMAL_SIGNED ? 1.0 : 2.0;
    return (values){{p.x / scale, p.y / scale, p.z / scale, unit * code.x, unit * code.y, unit * code.z, weight * alpha}};
}

static double pixel_size(const build *b, double z)
{
    return (b->g->camera.kind == CAMERA_PERSPECTIVE ? z : 1.0) / b->g->camera.fx;
}

// The near side's normal if the far one's share is taken out, not normalised.
static vec3 without(const repair *r, const stored *s, const side *far, double share)
{
    return normals_decode(r->b, v3_scale(v3_sub(s->code, v3_scale(far->code, share)), 1.0 / (1.0 - share)));
}

// The far side's share, if the normal of the near one is what makes up the rest: without it, it has length 1. If values are
// stored as they are, or as 0..1, (N - share far) is (1 - share) long; through a curve that is where the search begins.
static double share_by_length(const repair *r, const stored *s, const side *far)
{
    double a = v3_dot(far->n, far->n) - 1.0, b = 1.0 - v3_dot(s->n, far->n), c = v3_dot(s->n, s->n) - 1.0;
    double root = b * b - a * c;
    if (!(root >= 0.0 && b + sqrt(root) > 0.2)) return (double)NAN;
    double share = -c / (b + sqrt(root));
    const double step = 1e-3;
    for (int k = 0; k < 4 && r->b->normal.encoding > NORMAL_UNORM && share > -0.4 && share < 0.9; k++) {
        double off = v3_length(without(r, s, far, share)) - 1.0;
        share -= off * step / (v3_length(without(r, s, far, share + step)) - 1.0 - off);
    }
    return share;
}

static mixture mix(const repair *r, const stored *s, const side *near, const side *far, bool turns)
{
    mixture m = {.near = near, .far = far, .n = near->n, .rest = INFINITY};
    double scale = step_of_depth * near->z, d2 = 0.0;
    if (r->inverse) scale = step_of_depth / near->z;
    values f = values_of(r, scale, s->p, s->code, s->alpha), a = values_of(r, scale, near->p, near->code, near->alpha),
           b = values_of(r, scale, far->p, far->code, far->alpha);
    for (int k = 0; k < 7; k++) m.share += (f.v[k] - a.v[k]) * (b.v[k] - a.v[k]), d2 += (b.v[k] - a.v[k]) * (b.v[k] - a.v[k]);
    m.share = d2 > 1e-4 ? m.share / d2 : 0.0;
    if (far->alpha < 1.0 && r->b->alpha.data)
        m.share = 1.0 - s->alpha;
    else if (turns)
        m.share = share_by_length(r, s, far);
    if (!(m.share > -0.3 && m.share < 1.3)) return m;
    m.rest = 0.0;
    if (turns) {
        if (m.share > 0.8) return m.rest = INFINITY, m;
        vec3 n = without(r, s, far, m.share);
        double odd = (1.0 - m.share) * (v3_length(n) - 1.0);
        m.n = v3_normalize(n);
        m.rest = turn * v3_dot(v3_sub(m.n, near->n), v3_sub(m.n, near->n)) + odd * odd;
    }
    for (int k = 0; k < 7; k++) {
        double off = f.v[k] - (1.0 - m.share) * a.v[k] - m.share * b.v[k];
        if (!turns || k < 3 || k > 5) m.rest += off * off; // the normal's are `odd`
    }
    return m;
}

static mixture best_mixture(const repair *r, const stored *s, const side *list, int count)
{
    mixture best = {.rest = INFINITY};
    for (int i = 0; i < count; i++)
        for (int k = i + 1; k < count; k++) {
            bool swap = list[i].z == 0.0 || (list[k].z > 0.0 && list[k].z < list[i].z);
            const side *near = &list[swap ? k : i], *far = &list[swap ? i : k];
            for (int turns = 0; turns < 1 + r->lengths; turns++) {
                mixture m = mix(r, s, near, far, turns);
                if (m.rest < best.rest) best = m;
            }
        }
    return best;
}

static bool clean_at(const repair *r, int x, int y) { return inside(r->b, x, y) && r->pixels[build_index(r->b, x, y)].clean; }

// How far a bump map turns the normal of a clean pixel away from the surface that the positions around it form. 0 and false where
// there are too few clean pixels to tell.
static bool bump_at(const repair *r, int x, int y, vec3 *bump)
{
    static const int step[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    vec3 at[4];
    *bump = v3(0, 0, 0);
    if (!clean_at(r, x, y)) return false;
    for (int k = 0; k < 4; k++) {
        int u = x + step[k][0], v = y + step[k][1];
        if (!clean_at(r, u, v)) return false;
        at[k] = place_of(r, u, v);
    }
    vec3 as_stored = r->pixels[build_index(r->b, x, y)].n, n = v3_normalize(v3_cross(v3_sub(at[0], at[1]), v3_sub(at[2], at[3])));
    double cosine = v3_dot(n, as_stored);
    if (!(fabs(cosine) > 0.7)) return false;
    *bump = v3_sub(as_stored, v3_scale(n, cosine < 0.0 ? -1.0 : 1.0));
    return true;
}

// At the outline of a round surface the squared cosine between normal and ray is 0. Further inside it grows in proportion to the
// distance from the outline. A pixel's mean normal belongs to a place nearer to the clean pixel than the pixel's centre.
static vec3 normal_at_centre(const build *b, vec3 mean, vec3 clean, const side *own, double share, int x, int y)
{
    vec3 ray = v3_normalize(build_ray(&b->g->camera, x, y)), across = v3_sub(mean, v3_scale(ray, v3_dot(mean, ray)));
    double flat = hypot(across.x, across.y);
    if (flat < 1e-3) return mean;
    double inwards = ((x - own->u) * across.x + (y - own->v) * across.y) / flat; // of the clean pixel, in pixels
    double here = 0.5 - share, seen = 4.0 / 9.0 * (1.0 - share), there = here + inwards;
    double q_seen = v3_dot(mean, ray) * v3_dot(mean, ray), q_there = v3_dot(clean, ray) * v3_dot(clean, ray);
    if (inwards < 0.5 || q_there <= q_seen) return mean;
    double q = fmax(0.0, q_seen + (q_there - q_seen) * (here - seen) / (there - seen));
    double sign = v3_dot(mean, ray) < 0.0 ? -1.0 : 1.0;
    return v3_add(v3_scale(v3_normalize(across), sqrt(1.0 - q)), v3_scale(ray, sign * sqrt(q)));
}

// Planar depth of the near surface at the pixel's centre. There are two estimates. One follows the surface from the clean pixel;
// its error grows with the distance and the curvature. The other takes the far side's share out of the stored depth; its error
// grows with that share and with the distance between the two sides.
static double near_depth(const repair *r, const stored *s, const mixture *m, vec3 at, vec3 clean, double odd, int x, int y)
{
    const build *b = r->b;
    const side *own = m->near, *far = m->far;
    double z = carried(b, own->u, own->v, v3_normalize(v3_add(at, clean)), x, y);
    double by_plane = carried(b, own->u, own->v, clean, x, y);
    vec3 alone = v3_scale(v3_sub(s->p, v3_scale(far->p, m->share)), 1.0 / (1.0 - m->share));
    double seen = depth_of(r, alone, x, y), behind = depth_of(r, far->p, x, y);
    if (r->inverse && !(behind > 0.0)) behind = 2.0 * z;
    if (!(seen > 0.0) || !isfinite(seen)) return z;
    double cosine = fmax(0.1, fabs(v3_dot(at, v3_normalize(build_ray(&b->g->camera, x, y)))));
    double slope = sqrt(1.0 / (cosine * cosine) - 1.0), share = fabs(m->share), pixel = pixel_size(b, z);
    double off_share = far->z == 0.0 && b->alpha.data ? 0.0005 : 0.004 + 0.02 * share;
    double off_seen = pixel * slope * share + off_share * fabs(seen - behind);
    double way = hypot(x - own->u, y - own->v);
    double off_carried = pixel * way * odd * (1.0 + slope * slope) + 0.15 * fabs(z - by_plane);
    double trust = off_carried * off_carried / (off_carried * off_carried + off_seen * off_seen + 1e-12);
    return z + trust * (seen - z);
}

// Two or three clean pixels in a line, the first next to the mixed one, and the step from each to the one further inside.
typedef struct inward {
    int dx, dy;
    vec3 across[2]; // what of the normals is at right angles to the ray, unit
    double q[3];    // squared cosine of the normals with their rays
} inward;

static bool look_inward(const repair *r, const side *own, int x, int y, inward *in)
{
    const build *b = r->b;
    in->dx = (own->u > x) - (own->u < x), in->dy = (own->v > y) - (own->v < y);
    vec3 normals[3];
    for (int k = 0; k < 3; k++) {
        int u = own->u + k * in->dx, v = own->v + k * in->dy;
        if (!clean_at(r, u, v)) return false;
        vec3 ray = v3_normalize(build_ray(&b->g->camera, u, v)), n = v3_normalize(r->pixels[build_index(b, u, v)].n);
        double cosine = v3_dot(n, ray);
        if (k < 2) in->across[k] = v3_normalize(v3_sub(n, v3_scale(ray, cosine)));
        in->q[k] = cosine * cosine, normals[k] = n;
    }
    return v3_length(v3_sub(normals[0], normals[1])) > least_turn &&
           fabs(in->q[0] - 2.0 * in->q[1] + in->q[2]) < uneven * fabs(in->q[1] - in->q[0]);
}

// A round surface is followed from clean pixels to the pixel's centre. The squared cosine between normal and ray changes evenly
// with the distance in the picture, down to 0 at the outline. The far side's share tells where that is, too. A circle's chord is
// at right angles to the mean of the normals at its ends, which gives the depth. False where the surface is not round, or has
// bumps.
static bool follow_round(const repair *r, const mixture *m, int x, int y, double *z, vec3 *n)
{
    const build *b = r->b;
    const side *own = m->share > 0.5 ? m->far : m->near;
    inward in;
    vec3 bump;
    if (own->z == 0.0 || !r->lengths || !look_inward(r, own, x, y, &in)) return false;
    if (!bump_at(r, own->u + in.dx, own->v + in.dy, &bump) && !bump_at(r, own->u + 2 * in.dx, own->v + 2 * in.dy, &bump))
        return false;
    if (v3_length(bump) > bumped) return false;
    double steps = hypot(x - own->u, y - own->v) / hypot(in.dx, in.dy), slope = in.q[1] - in.q[0], q = in.q[0] - slope * steps;
    if (slope > 0.0 && own == m->near) {
        double flat = hypot(in.across[0].x, in.across[0].y); // pixels towards the outline a step
        double towards = fabs(in.dx * in.across[0].x + in.dy * in.across[0].y) / fmax(flat, 1e-3);
        q = 0.5 * (q + slope * fmax(0.5 - m->share, 0.0) / fmax(towards, 0.3));
    }
    q = fmin(fmax(q, 0.0), 1.0);
    vec3 ray = v3_normalize(build_ray(&b->g->camera, x, y)), clean = v3_normalize(own->n);
    vec3 across = v3_add(in.across[0], v3_scale(v3_sub(in.across[0], in.across[1]), steps));
    across = v3_normalize(v3_sub(across, v3_scale(ray, v3_dot(across, ray))));
    double sign = v3_dot(clean, ray) < 0.0 ? -1.0 : 1.0;
    vec3 at = v3_add(v3_scale(across, sqrt(1.0 - q)), v3_scale(ray, sign * sqrt(q)));
    if (!(v3_dot(at, clean) > 0.5)) return false;
    *n = at;
    *z = carried(b, own->u, own->v, v3_normalize(v3_add(at, clean)), x, y);
    return true;
}

// What the pixel's own side is at its centre.
static void settle(const repair *r, const stored *s, const mixture *m, int x, int y, double *z, vec3 *n)
{
    const side *own = m->share > 0.5 ? m->far : m->near;
    if (follow_round(r, m, x, y, z, n)) return;
    *z = own->z, *n = own->n;
    if (own != m->near || !r->lengths || !(v3_dot(m->n, own->n) > 0.0)) return;
    vec3 bump;
    int u = own->u + (own->u > x) - (own->u < x), v = own->v + (own->v > y) - (own->v < y); // one further inside
    double odd = bump_at(r, u, v, &bump) ? 0.003 + 0.3 * v3_length(bump) : odd_angle;
    vec3 clean = v3_normalize(v3_sub(own->n, bump));
    vec3 at = normal_at_centre(r->b, v3_normalize(v3_sub(m->n, bump)), clean, own, fmax(m->share, 0.0), x, y);
    *n = v3_normalize(v3_add(at, bump));
    *z = near_depth(r, s, m, at, clean, odd, x, y);
}

static void mend(repair *r, int x, int y)
{
    build *b = r->b;
    side list[SIDES];
    size_t i = build_index(b, x, y);
    stored *s = &r->pixels[i];
    int count = gather_sides(r, x, y, list);
    double z;
    vec3 n;
    mixture m = best_mixture(r, s, list, count);
    if (!(m.rest <= most_rest)) return; // more than two surfaces, or a detail that no clean pixel shows
    settle(r, s, &m, x, y, &z, &n);
    b->position.raw[i] = (float)z; // read when all are done
    b->surface[i] = 1;
    s->mended = n;
}

// What a pixel of the background stores, well away from surfaces: encoded normals are not 0 there.
static void learn_nothing(repair *r)
{
    const build *b = r->b;
    for (int y = 0; y < b->g->height; y++)
        for (int x = 0; x < b->g->width; x++) {
            vec3 p = b->position.has_p ? build_position(b, x, y) : v3(0, 0, 0);
            double alpha = plane_get(&b->alpha, x, y);
            if (b->g->depth[build_index(b, x, y)] > 0.0f || v3_dot(p, p) != 0.0 || alpha > 0.0) continue;
            r->nothing.code = normals_code(b, x, y);
            r->nothing.n = normals_decode(b, r->nothing.code);
            return;
        }
}

static bool lengths_are_whole(const repair *r)
{
    size_t whole = 0, all = 0;
    for (size_t i = 0; i < r->b->sample.count; i++) {
        double length = v3_length(r->pixels[build_index(r->b, (int)r->b->sample.points[i].x, (int)r->b->sample.points[i].y)].n);
        all++, whole += fabs(length - 1.0) <= odd_length;
    }
    return r->b->normal.there && 2 * whole > all;
}

static void mend_all(repair *r)
{
    build *b = r->b;
    size_t total = (size_t)b->g->width * (size_t)b->g->height, mended = 0;
    for (int y = 0; y < b->g->height; y++)
        for (int x = 0; x < b->g->width; x++) r->pixels[build_index(b, x, y)].clean = is_clean(r, x, y);
    for (size_t i = 0; i < total; i++) b->surface[i] = 0; // from here on: mended
    for (int y = 0; y < b->g->height; y++)
        for (int x = 0; x < b->g->width; x++) {
            const stored *s = &r->pixels[build_index(b, x, y)];
            bool empty = !(b->g->depth[build_index(b, x, y)] > 0.0f) && !(s->alpha > 0.5);
            if (!s->clean && !empty) mend(r, x, y);
        }
    b->g->valid = 0;
    for (size_t i = 0; i < total; i++) {
        if (b->surface[i]) {
            b->g->depth[i] = b->position.raw[i];
            const vec3 n = b->position.raw[i] > 0.0f ? v3_normalize(r->pixels[i].mended) : v3(0, 0, 0);
            b->g->normal[4 * i] = (float)n.x, b->g->normal[4 * i + 1] = (float)n.y, b->g->normal[4 * i + 2] = (float)n.z;
            mended++;
        }
        b->g->valid += b->g->depth[i] > 0.0f;
    }
    if (!b->normal.there) normals_make(b);  // of the mended depths
    atomic_store(&b->defects.positions, 0); // they are among the mended
    build_note(b, "%zu pixels of filtered passes lie between surfaces and were given to the nearest one", mended);
}

bool filtered_mend(build *b)
{
    role depth = b->position.has_p && !b->position.z_wins ? ROLE_POSITION : ROLE_DEPTH;
    if (!(b->filtered & 1u << depth)) return true;
    size_t total = (size_t)b->g->width * (size_t)b->g->height;
    repair r = {.b = b, .pixels = mem_pixels(total, sizeof *r.pixels, b->e)};
    if (!r.pixels) return false;
    const depth_kind k = b->position.code.kind;
    r.inverse = !b->position.has_p && (k == DEPTH_INVERSE || k >= DEPTH_ZBUFFER);
    r.radial = !b->position.has_p && b->g->depth_kind == DEPTH_RADIAL && b->g->camera.kind == CAMERA_PERSPECTIVE;
    if (b->position.has_p)
        r.nothing.p = camera_from_world(&b->g->camera, v3(0, 0, 0));
    else if (depth_needs_range(k))
        r.nothing.p.z = r.inverse ? 1.0 / b->position.code.far : b->position.code.far;
    learn_nothing(&r);
    for (int y = 0; y < b->g->height; y++)
        for (int x = 0; x < b->g->width; x++) r.pixels[build_index(b, x, y)] = read_pixel(&r, x, y);
    r.lengths = lengths_are_whole(&r);
    mend_all(&r);
    free(r.pixels);
    return true;
}
