// What the surface that has a mixed pixel is at the pixel's centre: depth and normal.
#include "gbuffer/filtered.h"

static const double odd_angle = 0.035; // radians that normals are off the surface's
static const double bumped = 0.04;     // a bump map's turn of a normal
static const double least_turn = 0.02; // of normals a pixel apart, that a round surface is told by
static const double uneven = 0.3;      // second difference of the squared cosines over the first: a fold, no round surface

static double pixel_size(const build *b, double z)
{
    return (b->g->camera.kind == CAMERA_PERSPECTIVE ? z : 1.0) / b->g->camera.fx;
}

// How far a bump map turns the normal of a clean pixel away from the surface that the positions around it form. 0 and false where
// there are too few clean pixels to tell.
static bool bump_at(repair *r, int x, int y, vec3 *bump)
{
    static const int step[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    vec3 at[4];
    *bump = v3(0, 0, 0);
    if (!filtered_clean(r, x, y)) return false;
    for (int k = 0; k < 4; k++) {
        int u = x + step[k][0], v = y + step[k][1];
        if (!filtered_clean(r, u, v)) return false;
        at[k] = filtered_place(r, filtered_at(r, u, v), u, v);
    }
    vec3 as_stored = filtered_at(r, x, y)->n, n = v3_normalize(v3_cross(v3_sub(at[0], at[1]), v3_sub(at[2], at[3])));
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
    double z = filtered_carried(b, own->u, own->v, v3_normalize(v3_add(at, clean)), x, y);
    double by_plane = filtered_carried(b, own->u, own->v, clean, x, y);
    vec3 alone = v3_scale(v3_sub(s->p, v3_scale(far->p, m->share)), 1.0 / (1.0 - m->share));
    double seen = filtered_depth(r, alone, x, y), behind = filtered_depth(r, far->p, x, y);
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

static bool look_inward(repair *r, const side *own, int x, int y, inward *in)
{
    const build *b = r->b;
    in->dx = (own->u > x) - (own->u < x), in->dy = (own->v > y) - (own->v < y);
    vec3 normals[3];
    for (int k = 0; k < 3; k++) {
        int u = own->u + k * in->dx, v = own->v + k * in->dy;
        if (!filtered_clean(r, u, v)) return false;
        vec3 ray = v3_normalize(build_ray(&b->g->camera, u, v)), n = v3_normalize(filtered_at(r, u, v)->n);
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
static bool follow_round(repair *r, const mixture *m, int x, int y, double *z, vec3 *n)
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
    *z = filtered_carried(b, own->u, own->v, v3_normalize(v3_add(at, clean)), x, y);
    return true;
}

bool filtered_settle(repair *r, const stored *s, const mixture *m, int x, int y, double *z, vec3 *n)
{
    const side *own = m->share > 0.5 ? m->far : m->near;
    if (filtered_outline(r, s, m, x, y, z, n) || follow_round(r, m, x, y, z, n)) return true;
    *z = own->z, *n = own->n;
    if (own != m->near || !r->lengths || !(v3_dot(m->n, own->n) > 0.0)) return false;
    vec3 bump;
    int u = own->u + (own->u > x) - (own->u < x), v = own->v + (own->v > y) - (own->v < y); // one further inside
    double odd = bump_at(r, u, v, &bump) ? 0.003 + 0.3 * v3_length(bump) : odd_angle;
    vec3 clean = v3_normalize(v3_sub(own->n, bump));
    vec3 at = normal_at_centre(r->b, v3_normalize(v3_sub(m->n, bump)), clean, own, fmax(m->share, 0.0), x, y);
    *n = v3_normalize(v3_add(at, bump));
    *z = near_depth(r, s, m, at, clean, odd, x, y);
    return false;
}
