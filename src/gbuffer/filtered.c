// Mends passes that went through the picture's reconstruction filter. At an edge their pixels are means of several surfaces, or
// of a surface and the background's zeros; a filter with negative lobes leaves values beyond either. Such a pixel is given one
// surface again.
//
// Each mixed pixel is explained as a mean of two of the sides around it, or of three. A clean pixel tells what each side is. With
// a symmetric filter, the pixel's centre belongs to the side with the larger share. The nearer side's normal turns at round
// outlines, so it is computed: the stored normal minus the farther side's share.
#include "gbuffer/filtered.h"

#include <stdlib.h>

#include "base/mem.h"

enum { BLOCK = 4096 };
static const double odd_length = 0.01; // of a normal: of one surface alone it keeps its length
static const double most_rest = 0.1;   // of a pixel's values that two surfaces do not explain, squared

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

stored filtered_read(const repair *r, int x, int y)
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

stored *filtered_at(repair *r, int x, int y)
{
    int *place = &r->place[build_index(r->b, x, y)];
    if (*place == 0) {
        stored **block = &r->read[r->count / BLOCK];
        if (!*block) *block = mem_pixels(BLOCK, sizeof **block, r->b->e);
        if (!*block) {
            r->failed = true;
            return &r->nothing;
        }
        (*block)[r->count % BLOCK] = filtered_read(r, x, y);
        *place = ++r->count;
    }
    return &r->read[(*place - 1) / BLOCK][(*place - 1) % BLOCK];
}

vec3 filtered_place(const repair *r, const stored *s, int x, int y)
{
    return r->b->position.has_p ? s->p : build_point(&r->b->g->camera, x, y, filtered_depth(r, s->p, x, y));
}

size_t filtered_clean_of(const repair *r, const side *s) { return s->z > 0.0 ? build_index(r->b, s->u, s->v) : NO_PIXEL; }

void filtered_take(repair *r, const stored *s, const mixture *m, mended *out)
{
    const size_t width = (size_t)r->b->g->width;
    double z;
    if (!(m->rest <= most_rest)) return;
    out->settled = filtered_settle(r, s, m, (int)(out->pixel % width), (int)(out->pixel / width), &z, &out->n);
    out->z = (float)z, out->rest = m->rest;
    out->near = filtered_clean_of(r, m->near), out->far = filtered_clean_of(r, m->far);
}

static mended mend(repair *r, int x, int y)
{
    side sides[SIDES];
    const stored *s = filtered_at(r, x, y);
    mixture m = filtered_mixture(r, s, sides, 0, filtered_sides(r, x, y, sides));
    mended out = {.pixel = build_index(r->b, x, y), .near = NO_PIXEL, .far = NO_PIXEL, .rest = m.rest};
    filtered_take(r, s, &m, &out);
    return out;
}

// What a pixel of the background stores, well away from surfaces: encoded normals are not 0 there.
static void learn_nothing(repair *r)
{
    const build *b = r->b;
    for (int y = 0; y < b->g->height; y++)
        for (int x = 0; x < b->g->width; x++) {
            if (b->g->depth[build_index(b, x, y)] > 0.0f || plane_get(&b->alpha, x, y) > 0.0) continue;
            vec3 p = b->position.has_p ? build_position(b, x, y) : v3(0, 0, 0);
            if (v3_dot(p, p) != 0.0) continue;
            r->nothing.code = normals_code(b, x, y);
            r->nothing.n = normals_decode(b, r->nothing.code);
            return;
        }
}

static bool lengths_are_whole(const build *b)
{
    size_t whole = 0;
    for (size_t i = 0; i < b->sample.count; i++) {
        vec3 code = normals_code(b, (int)b->sample.points[i].x, (int)b->sample.points[i].y);
        whole += fabs(v3_length(normals_decode(b, code)) - 1.0) <= odd_length;
    }
    return b->normal.there && 2 * whole > b->sample.count;
}

// How many pixels were changed.
static size_t put(build *b, const mended_list *list)
{
    size_t count = 0;
    for (const mended *m = list->items; m < list->items + list->count; m++) {
        if (!(m->rest <= most_rest)) continue; // more than three surfaces, or a detail that no clean pixel shows
        float *depth = &b->g->depth[m->pixel], *normal = b->g->normal + 4 * m->pixel;
        const vec3 n = m->z > 0.0f ? v3_normalize(m->n) : v3(0, 0, 0);
        b->g->valid -= *depth > 0.0f;
        *depth = m->z, normal[0] = (float)n.x, normal[1] = (float)n.y, normal[2] = (float)n.z;
        b->g->valid += *depth > 0.0f;
        count++;
    }
    return count;
}

static bool mend_all(repair *r)
{
    build *b = r->b;
    mended_list list = {0};
    bool ok = filtered_find_clean(r) && (list.items = mem_pixels(r->mixed_count, sizeof *list.items, b->e)) != NULL;
    if (ok) filtered_measure(r);
    for (size_t k = 0; ok && k < r->mixed_count; k++) {
        const size_t i = r->mixed[k], width = (size_t)b->g->width;
        const int x = (int)(i % width), y = (int)(i / width);
        list.items[list.count++] = mend(r, x, y);
        filtered_at(r, x, y)->mended = (int)list.count;
        ok = !r->failed;
    }
    if (ok) filtered_again(r, &list);
    ok = ok && !r->failed;
    if (ok) {
        const size_t count = put(b, &list);
        if (!b->normal.there) normals_make(b);  // of the mended depths; the lengths are no longer needed
        atomic_store(&b->defects.positions, 0); // they are among the mended
        build_note(b, "%zu pixels of filtered passes lie between surfaces and were given to one, with its own values", count);
    }
    free(list.items);
    return ok;
}

static void describe(repair *r)
{
    const build *b = r->b;
    const depth_kind k = b->position.code.kind;
    r->inverse = !b->position.has_p && (k == DEPTH_INVERSE || k >= DEPTH_ZBUFFER);
    r->radial = !b->position.has_p && b->g->depth_kind == DEPTH_RADIAL && b->g->camera.kind == CAMERA_PERSPECTIVE;
    if (b->position.has_p)
        r->nothing.p = camera_from_world(&b->g->camera, v3(0, 0, 0));
    else if (depth_needs_range(k))
        r->nothing.p.z = r->inverse ? 1.0 / b->position.code.far : b->position.code.far;
    learn_nothing(r);
    r->lengths = lengths_are_whole(b);
}

bool filtered_asked(const build *b)
{
    role depth = b->position.has_p && !b->position.z_wins ? ROLE_POSITION : ROLE_DEPTH;
    return b->filtered & 1u << depth;
}

bool filtered_mend(build *b)
{
    if (!filtered_asked(b)) return true;
    size_t total = (size_t)b->g->width * (size_t)b->g->height, blocks = total / BLOCK + 1;
    repair r = {.b = b,
                .state = b->normal.lengths,
                .place = mem_zero(total, sizeof *r.place, b->e),
                .read = mem_zero(blocks, sizeof *r.read, b->e)};
    bool ok = r.place && r.read;
    if (ok) describe(&r);
    ok = ok && mend_all(&r);
    for (size_t i = 0; r.read && i < blocks; i++) free(r.read[i]);
    free(r.read);
    free(r.mixed);
    free(r.place);
    return ok;
}
