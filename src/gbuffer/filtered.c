// Passes that went through the picture's reconstruction filter: at an edge their pixels are means of several surfaces, or of a
// surface and the background's zeros, or, by negative lobes, lie beyond either. Such a pixel is given one surface again.
//
// What a pixel stores (position or depth, normal, alpha) is, if the filter is symmetric, nearest to what the surface at its
// centre stores. So each mixed pixel takes the plane of the clean pixel around it whose stored values, carried to its own ray,
// are nearest to its own; or becomes background, if that is nearest.
#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/build.h"

enum { REACH = 4 };
static const double odd_length = 0.01;    // of a normal: of one surface alone it keeps its length
static const double off_tangent = 0.05;   // of the step between neighbours
static const double most_bend = 0.5;      // second difference of depth over a pixel's size at that depth
static const double most_rest = 0.1;      // of a pixel's values that two surfaces do not explain, squared
static const double step_of_depth = 0.05; // of the depth, that counts as much as normals at right angles

typedef struct stored {
    vec3 p; // camera space; depth alone: (0, 0, z or 1 / z)
    vec3 n; // as long as it is stored; 0 without
    double alpha;
    bool clean;  // one surface
    vec3 mended; // normal
} stored;

typedef struct repair {
    build *b;
    stored *pixels;
    stored nothing; // what the background stores
    bool inverse;   // depth alone whose values are linear in 1 / z
    bool lengths;   // the normals have a length to go by
} repair;

static bool inside(const build *b, int x, int y) { return x >= 0 && y >= 0 && x < b->g->width && y < b->g->height; }

// The values of a surface at depth z on the ray of (x, y).
static vec3 value_at(const repair *r, int x, int y, double z)
{
    if (r->b->has_position) return build_point(&r->b->g->camera, x, y, z);
    return v3(0, 0, r->inverse ? 1.0 / z : z);
}

static stored read_pixel(const repair *r, int x, int y)
{
    const build *b = r->b;
    stored s = r->nothing;
    double alpha = plane_get(&b->alpha, x, y);
    if (b->has_position) {
        vec3 p = camera_from_world(&b->g->camera, build_position(b, x, y));
        if (v3_finite(p)) s.p = p;
    } else {
        double z = build_depth(b, x, y);
        if (z > 0.0 && isfinite(z)) s.p.z = r->inverse ? 1.0 / z : z;
    }
    s.n = normals_stored(b, x, y);
    s.alpha = isfinite(alpha) ? alpha : 0.0;
    return s;
}

static double depth_of(const repair *r, const stored *s)
{
    return r->b->has_position || !r->inverse ? s->p.z : s->p.z > 0.0 ? 1.0 / s->p.z : 0.0;
}

// Where a pixel's surface lies in camera space.
static vec3 place_of(const repair *r, int x, int y)
{
    const stored *s = &r->pixels[build_index(r->b, x, y)];
    return r->b->has_position ? s->p : build_point(&r->b->g->camera, x, y, depth_of(r, s));
}

// Whether the pixel and its neighbour lie on one smooth surface. With normals: their connection is tangential to it, on a curved
// surface by the mean of both normals. Or, whatever normals a bump map made: the neighbour and the one beyond it lead to the
// pixel.
static bool continues(const repair *r, int x, int y, int dx, int dy)
{
    const build *b = r->b;
    if (!inside(b, x + dx, y + dy) || !(depth_of(r, &r->pixels[build_index(b, x + dx, y + dy)]) > 0.0)) return false;
    vec3 here = place_of(r, x, y), next = place_of(r, x + dx, y + dy), step = v3_sub(next, here);
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

// A pixel of one surface: its normal is whole, and along either axis it continues to at least one side.
static bool is_clean(const repair *r, int x, int y)
{
    const build *b = r->b;
    const stored *s = &r->pixels[build_index(b, x, y)];
    if (!(b->g->depth[build_index(b, x, y)] > 0.0f) || !(depth_of(r, s) > 0.0)) return false;
    if (r->lengths && fabs(v3_length(s->n) - 1.0) > odd_length) return false;
    if (b->alpha.data && fabs(s->alpha - 1.0) > odd_length) return false;
    return (continues(r, x, y, -1, 0) || continues(r, x, y, 1, 0)) && (continues(r, x, y, 0, -1) || continues(r, x, y, 0, 1));
}

// How far apart what two pixels store is.
static double apart(const repair *r, const stored *a, vec3 p, vec3 n, double alpha, double z)
{
    double scale = step_of_depth * (r->inverse && !r->b->has_position ? 1.0 / z : z);
    double by_p = v3_length(v3_sub(a->p, p)) / scale, by_n = v3_length(v3_sub(a->n, n));
    double by_alpha = r->b->alpha.data ? 2.0 * (a->alpha - alpha) : 0.0;
    return by_p * by_p + by_n * by_n + by_alpha * by_alpha;
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
    vec3 p, n;
    double alpha, z; // z: planar depth; 0 the background
    int u, v;        // of the clean pixel
} side;

enum { SIDES = (2 * REACH + 1) * (2 * REACH + 1) + 1 };

// The surfaces of the clean pixels around, nearest to what the pixel stores first, and the background if it is near.
static int gather_sides(const repair *r, int x, int y, side list[SIDES])
{
    const build *b = r->b;
    const stored *s = &r->pixels[build_index(b, x, y)];
    double least = INFINITY;
    int count = 0;
    bool open = false;
    for (int v = y - REACH; v <= y + REACH; v++)
        for (int u = x - REACH; u <= x + REACH; u++) {
            if (!inside(b, u, v)) continue;
            size_t i = build_index(b, u, v);
            open = open || !(b->g->depth[i] > 0.0f) || (b->alpha.data && r->pixels[i].alpha < 0.5);
            if (!r->pixels[i].clean) continue;
            side k = {.n = r->pixels[i].n, .alpha = 1.0, .z = carried(b, u, v, made_normal(b, u, v), x, y), .u = u, .v = v};
            k.p = value_at(r, x, y, k.z);
            double d = apart(r, s, k.p, k.n, 1.0, k.z) + 1e-4 * ((u - x) * (u - x) + (v - y) * (v - y)); // of equals the nearest
            list[count++] = k;
            if (!(d < least)) continue;
            least = d;
            list[count - 1] = list[0], list[0] = k;
        }
    if (!open || count == 0) return count;
    side nothing = {.p = r->nothing.p, .n = r->nothing.n};
    list[count++] = nothing;
    if (apart(r, s, nothing.p, nothing.n, 0.0, list[0].z) < least) list[count - 1] = list[0], list[0] = nothing;
    return count;
}

// The share of the other side in the pixel, and how much that leaves unexplained.
static double share_of(const repair *r, const stored *s, const side *own, const side *other, double *rest)
{
    double scale = step_of_depth * (own->z > 0.0 ? own->z : other->z);
    if (r->inverse && !r->b->has_position) scale = step_of_depth / (own->z > 0.0 ? own->z : other->z);
    double weight = r->b->alpha.data ? 2.0 : 0.0, f[7], d[7], along = 0.0, length = 0.0;
    vec3 fp = v3_scale(v3_sub(s->p, own->p), 1.0 / scale), dp = v3_scale(v3_sub(other->p, own->p), 1.0 / scale);
    vec3 fn = v3_sub(s->n, own->n), dn = v3_sub(other->n, own->n);
    const double fs[7] = {fp.x, fp.y, fp.z, fn.x, fn.y, fn.z, weight * (s->alpha - own->alpha)};
    const double ds[7] = {dp.x, dp.y, dp.z, dn.x, dn.y, dn.z, weight * (other->alpha - own->alpha)};
    for (int k = 0; k < 7; k++) f[k] = fs[k], d[k] = ds[k], along += f[k] * d[k], length += d[k] * d[k];
    double share = length > 1e-4 ? fmax(-0.3, fmin(0.5, along / length)) : 0.0;
    *rest = 0.0;
    for (int k = 0; k < 7; k++) *rest += (f[k] - share * d[k]) * (f[k] - share * d[k]);
    return share;
}

// The pixel's own normal, when the other's share is taken out of what it stores; only where that is about the clean pixel's. The
// surface between two points of known normals runs along the mean of both.
static void unmix(const repair *r, const stored *s, side *own, const side *other, double share, int x, int y)
{
    vec3 n = v3_normalize(v3_sub(s->n, v3_scale(other->n, share)));
    if (!r->lengths || !(v3_dot(n, own->n) > 0.7)) return;
    own->z = carried(r->b, own->u, own->v, v3_normalize(v3_add(n, v3_normalize(own->n))), x, y);
    own->n = n;
    // In front of another surface what is seen of the own one lies inside its outline: a third of the other's share of a pixel
    // nearer.
    double pixel = (r->b->g->camera.kind == CAMERA_PERSPECTIVE ? own->z : 1.0) / r->b->g->camera.fx;
    if (other->z > 0.0 && other->z < own->z + pixel) return;
    double cosine = fmax(fabs(v3_dot(n, v3_normalize(build_ray(&r->b->g->camera, x, y)))), 0.1);
    own->z += 0.3 * fmax(share, 0.0) * pixel * sqrt(1.0 / (cosine * cosine) - 1.0);
}

static void mend(repair *r, int x, int y)
{
    build *b = r->b;
    side list[SIDES];
    stored *s = &r->pixels[build_index(b, x, y)];
    int count = gather_sides(r, x, y, list), best = 0;
    if (count == 0) return; // nothing to go by
    size_t i = build_index(b, x, y);
    double least = INFINITY, share = 0.0;
    for (int k = 1; k < count; k++) {
        double rest, part = share_of(r, s, &list[0], &list[k], &rest);
        if (rest < least) least = rest, best = k, share = part;
    }
    if (least > most_rest) return; // more than two surfaces, or a detail that no clean pixel shows
    side own = list[0];
    if (own.z > 0.0 && best > 0) unmix(r, s, &own, &list[best], share, x, y);
    b->raw[i] = (float)own.z; // read when all are done
    b->surface[i] = 1;
    s->mended = own.n;
}

// What a pixel of the background stores, well away from surfaces: encoded normals are not 0 there.
static void learn_nothing(repair *r)
{
    const build *b = r->b;
    for (int y = 0; y < b->g->height; y++)
        for (int x = 0; x < b->g->width; x++) {
            vec3 p = b->has_position ? build_position(b, x, y) : v3(0, 0, 0);
            double alpha = plane_get(&b->alpha, x, y);
            if (b->g->depth[build_index(b, x, y)] > 0.0f || v3_dot(p, p) != 0.0 || alpha > 0.0) continue;
            r->nothing.n = normals_stored(b, x, y);
            return;
        }
}

static bool lengths_are_whole(const repair *r)
{
    size_t whole = 0, all = 0;
    for (size_t i = 0; i < r->b->point_count; i++) {
        double length = v3_length(r->pixels[build_index(r->b, (int)r->b->points[i].x, (int)r->b->points[i].y)].n);
        all++, whole += fabs(length - 1.0) <= odd_length;
    }
    return r->b->has_normal && 2 * whole > all;
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
            b->g->depth[i] = b->raw[i];
            const vec3 n = b->raw[i] > 0.0f ? v3_normalize(r->pixels[i].mended) : v3(0, 0, 0);
            b->g->normal[4 * i] = (float)n.x, b->g->normal[4 * i + 1] = (float)n.y, b->g->normal[4 * i + 2] = (float)n.z;
            mended++;
        }
        b->g->valid += b->g->depth[i] > 0.0f;
    }
    atomic_store(&b->bad_positions, 0); // they are among the mended
    build_note(b, "%zu pixels of filtered passes lie between surfaces and were given to the nearest one", mended);
}

bool filtered_mend(build *b)
{
    role depth = b->has_position && !b->depth_wins ? ROLE_POSITION : ROLE_DEPTH;
    if (!(b->filtered & 1u << depth)) return true;
    size_t total = (size_t)b->g->width * (size_t)b->g->height;
    repair r = {.b = b, .pixels = mem_pixels(total, sizeof *r.pixels, b->e)};
    if (!r.pixels) return false;
    const depth_kind k = b->depth_code.kind;
    r.inverse = k == DEPTH_INVERSE || k == DEPTH_ZBUFFER || k == DEPTH_REVERSED;
    if (b->has_position)
        r.nothing.p = camera_from_world(&b->g->camera, v3(0, 0, 0));
    else if (depth_needs_range(k))
        r.nothing.p.z = r.inverse ? 1.0 / b->depth_code.far : b->depth_code.far;
    learn_nothing(&r);
    for (int y = 0; y < b->g->height; y++)
        for (int x = 0; x < b->g->width; x++) r.pixels[build_index(b, x, y)] = read_pixel(&r, x, y);
    r.lengths = lengths_are_whole(&r);
    mend_all(&r);
    free(r.pixels);
    return true;
}
