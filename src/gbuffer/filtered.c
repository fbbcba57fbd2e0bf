// Mends passes that went through the picture's reconstruction filter. At an edge their pixels are means of several surfaces, or
// of a surface and the background's zeros; a filter with negative lobes leaves values beyond either. Such a pixel is given one
// surface again.
//
// Each mixed pixel is explained as a mean of two of the sides around it. A clean pixel tells what each side is. With a symmetric
// filter, the pixel's centre belongs to the side with the larger share. The nearer side's normal turns at round outlines, so it
// is computed: the stored normal minus the farther side's share.
#include "gbuffer/filtered.h"

#include <stdlib.h>

#include "base/mem.h"

static const double odd_length = 0.01;  // of a normal: of one surface alone it keeps its length
static const double off_tangent = 0.05; // of the step between neighbours
static const double most_bend = 0.5;    // second difference of depth over a pixel's size at that depth
static const double most_rest = 0.1;    // of a pixel's values that two surfaces do not explain, squared

static double per_depth(const repair *r, int x, int y) { return r->radial ? v3_length(build_ray(&r->b->g->camera, x, y)) : 1.0; }

// The values of a surface at planar depth z on the ray of (x, y).
vec3 filtered_values(const repair *r, int x, int y, double z)
{
    if (r->b->position.has_p) return build_point(&r->b->g->camera, x, y, z);
    return v3(0, 0, r->inverse ? 1.0 / z : z * per_depth(r, x, y));
}

// And back; 0 where there is none.
double filtered_depth(const repair *r, vec3 p, int x, int y)
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
vec3 filtered_place(const repair *r, int x, int y)
{
    const stored *s = &r->pixels[build_index(r->b, x, y)];
    return r->b->position.has_p ? s->p : build_point(&r->b->g->camera, x, y, filtered_depth(r, s->p, x, y));
}

// Whether the pixel and its neighbour lie on one smooth surface. With normals: the line between them is perpendicular to the mean
// of both normals. Or, because a bump map may have changed the normals: the line through the neighbour and the pixel beyond it
// leads to the pixel.
static bool continues(const repair *r, int x, int y, int dx, int dy)
{
    const build *b = r->b;
    if (!filtered_inside(b, x + dx, y + dy)) return false;
    vec3 here = filtered_place(r, x, y), next = filtered_place(r, x + dx, y + dy), step = v3_sub(next, here);
    if (!(next.z > 0.0)) return false;
    if (r->lengths) {
        const stored *s = &r->pixels[build_index(b, x, y)], *q = s + (dx + dy * b->g->width);
        if (fabs(v3_length(q->n) - 1.0) > 2.0 * odd_length) return false;
        if (fabs(v3_dot(v3_add(s->n, q->n), step)) < 2.0 * off_tangent * v3_length(step)) return true;
    }
    if (!filtered_inside(b, x + 2 * dx, y + 2 * dy)) return false;
    vec3 beyond = filtered_place(r, x + 2 * dx, y + 2 * dy);
    double pixel = (b->g->camera.kind == CAMERA_PERSPECTIVE ? here.z : 1.0) / b->g->camera.fx;
    return beyond.z > 0.0 && fabs(here.z - 2.0 * next.z + beyond.z) < most_bend * pixel;
}

// A clean pixel shows one surface: its normal has full length, and along each axis at least one neighbour continues it.
static bool is_clean(const repair *r, int x, int y)
{
    const build *b = r->b;
    const stored *s = &r->pixels[build_index(b, x, y)];
    if (!(b->g->depth[build_index(b, x, y)] > 0.0f) || !(filtered_place(r, x, y).z > 0.0)) return false;
    if (r->lengths && fabs(v3_length(s->n) - 1.0) > odd_length) return false;
    if (b->alpha.data && fabs(s->alpha - 1.0) > odd_length) return false;
    return (continues(r, x, y, -1, 0) || continues(r, x, y, 1, 0)) && (continues(r, x, y, 0, -1) || continues(r, x, y, 0, 1));
}

static void mend(repair *r, int x, int y)
{
    build *b = r->b;
    side list[SIDES];
    size_t i = build_index(b, x, y);
    stored *s = &r->pixels[i];
    int count = filtered_sides(r, x, y, list);
    double z;
    vec3 n;
    mixture m = filtered_mixture(r, s, list, count);
    if (!(m.rest <= most_rest)) return; // more than two surfaces, or a detail that no clean pixel shows
    filtered_settle(r, s, &m, x, y, &z, &n);
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
    filtered_measure(r);
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
