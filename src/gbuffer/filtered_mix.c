// Each pixel of a filtered pass as a mean of two of the sides around it.
#include "gbuffer/filtered.h"

static const double turn = 0.2;           // weight of a turn of the normal, squared, that only the pixel itself tells of
static const double same_plane = 1e-5;    // of the depth, and of the normal, that pixels of one plane differ by
static const double step_of_depth = 0.05; // of the depth, that counts as much as normals at right angles

const int filtered_step[DIRECTIONS][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};

static vec3 made_normal(const build *b, int x, int y)
{
    const float *n = b->g->normal + 4 * build_index(b, x, y);
    return v3((double)n[0], (double)n[1], (double)n[2]);
}

double filtered_carried(const build *b, int u, int v, vec3 n, int x, int y)
{
    const camera *c = &b->g->camera;
    vec3 at = build_point(c, u, v, (double)b->g->depth[build_index(b, u, v)]), d = build_ray(c, x, y);
    double cosine = v3_dot(n, d);
    if (fabs(cosine) < 0.02 * v3_length(d)) return at.z;
    double z = v3_dot(n, v3_sub(at, build_point(c, x, y, 0.0))) / cosine;
    return z > 0.5 * at.z && z < 2.0 * at.z ? z : at.z;
}

static bool transparent(const repair *r, int u, int v)
{
    const size_t i = build_index(r->b, u, v);
    if (r->state[i] & PIXEL_WHOLE) return false;
    return !(r->b->g->depth[i] > 0.0f) || (r->b->alpha.data && !(plane_get(&r->b->alpha, u, v) >= 0.5));
}

int filtered_add_side(repair *r, int x, int y, int u, int v, side *list, int count)
{
    const stored *at = filtered_at(r, u, v);
    side s = {.code = at->code, .n = at->n, .alpha = 1.0, .u = u, .v = v};
    s.z = filtered_carried(r->b, u, v, made_normal(r->b, u, v), x, y);
    for (int k = 0; k < count; k++) {
        vec3 turned = v3_sub(list[k].n, s.n);
        if (fabs(list[k].z - s.z) > same_plane * s.z || v3_dot(turned, turned) > same_plane * same_plane) continue;
        if (hypot(u - x, v - y) >= hypot(list[k].u - x, list[k].v - y)) return count;
        s.p = filtered_values(r, x, y, s.z);
        list[k] = s;
        return count;
    }
    s.p = filtered_values(r, x, y, s.z);
    list[count] = s;
    return count + 1;
}

side filtered_background(const repair *r) { return (side){.p = r->nothing.p, .code = r->nothing.code, .n = r->nothing.n}; }

int filtered_sides(repair *r, int x, int y, side list[SIDES])
{
    const int(*step)[2] = filtered_step;
    int count = 0;
    bool open = false;
    for (int k = 0; k < DIRECTIONS; k++)
        for (int d = 1; d <= FILTER_REACH; d++) {
            int u = x + d * step[k][0], v = y + d * step[k][1];
            if (!filtered_inside(r->b, u, v)) break;
            open = open || transparent(r, u, v);
            if (!filtered_clean(r, u, v)) continue;
            count = filtered_add_side(r, x, y, u, v, list, count);
            break;
        }
    if (open && count > 0) list[count++] = filtered_background(r);
    return count;
}

vec3 filtered_without(const repair *r, const stored *s, const side *far, double share)
{
    return normals_decode(r->b, v3_scale(v3_sub(s->code, v3_scale(far->code, share)), 1.0 / (1.0 - share)));
}

// If values are stored as they are, or as 0..1, (N - share far) is (1 - share) long; through a curve that is where the search
// begins.
double filtered_share(const repair *r, const stored *s, const side *far)
{
    double a = v3_dot(far->n, far->n) - 1.0, b = 1.0 - v3_dot(s->n, far->n), c = v3_dot(s->n, s->n) - 1.0;
    double root = b * b - a * c;
    if (!(root >= 0.0 && b + sqrt(root) > 0.2)) return (double)NAN;
    double share = -c / (b + sqrt(root));
    const double step = 1e-3;
    for (int k = 0; k < 4 && r->b->normal.encoding > NORMAL_UNORM && share > -0.4 && share < 0.9; k++) {
        double off = v3_length(filtered_without(r, s, far, share)) - 1.0;
        share -= off * step / (v3_length(filtered_without(r, s, far, share + step)) - 1.0 - off);
    }
    return share;
}

metric filtered_metric(const repair *r, const side *near)
{
    const double scale = r->inverse ? step_of_depth / near->z : step_of_depth * near->z;
    return (metric){1.0 / (scale * scale), r->b->normal.encoding == NORMAL_SIGNED ? 1.0 : 4.0, r->b->alpha.data ? 4.0 : 0.0};
}

// `turned`: the share by the normal's length, NULL if the near side's is as it is. rest stays INFINITY where it would not be less
// than `most`.
static mixture mix(const repair *r, const stored *s, const side *near, const side *far, const double *turned, double most)
{
    mixture m = {.near = near, .far = far, .n = near->n, .rest = INFINITY};
    const metric w = filtered_metric(r, near);
    const difference at = filtered_minus(s->p, s->code, s->alpha, near),
                     way = filtered_minus(far->p, far->code, far->alpha, near);
    if (far->alpha < 1.0 && r->b->alpha.data) {
        m.share = 1.0 - s->alpha;
    } else if (turned) {
        m.share = *turned;
    } else {
        double d2 = filtered_dot(&w, &way, &way);
        m.share = d2 > 1e-4 ? filtered_dot(&w, &at, &way) / d2 : 0.0;
    }
    if (!(m.share > -0.3 && m.share < (turned ? 0.8 : 1.3))) return m;
    const vec3 off = v3_sub(at.p, v3_scale(way.p, m.share)), code = v3_sub(at.code, v3_scale(way.code, m.share));
    const double alpha = at.alpha - way.alpha * m.share, rest = w.p * v3_dot(off, off) + w.alpha * alpha * alpha;
    if (!(rest < most)) return m;
    m.rest = rest;
    if (turned) {
        vec3 n = filtered_without(r, s, far, m.share);
        double odd = (1.0 - m.share) * (v3_length(n) - 1.0);
        m.n = v3_normalize(n);
        m.rest += turn * v3_dot(v3_sub(m.n, near->n), v3_sub(m.n, near->n)) + odd * odd;
    } else {
        m.rest += w.code * v3_dot(code, code);
    }
    return m;
}

mixture filtered_mixture(const repair *r, const stored *s, const side *list, int first, int count)
{
    mixture best = {.rest = INFINITY};
    double turned[MOST_SIDES];
    for (int i = 0; i < count && r->lengths; i++) turned[i] = filtered_share(r, s, &list[i]);
    for (int i = 0; i < count; i++)
        for (int k = i + 1 > first ? i + 1 : first; k < count; k++) {
            const bool swap = list[i].z == 0.0 || (list[k].z > 0.0 && list[k].z < list[i].z);
            const int near = swap ? k : i, far = swap ? i : k;
            for (int turns = 0; turns < 1 + r->lengths; turns++) {
                mixture m = mix(r, s, &list[near], &list[far], turns ? &turned[far] : NULL, best.rest);
                if (m.rest < best.rest) best = m;
            }
        }
    return best;
}
