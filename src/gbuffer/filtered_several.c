// Pixels that two of the sides around them do not explain. A side's clean pixels may lie further away, where the pixels around
// lead: they are means of it, too. Three sides may meet in the pixel. Or one is too narrow to have a clean pixel; then the purest
// of its pixels stands for it.
#include <stdlib.h>

#include "gbuffer/filtered.h"

enum { AROUND = 2 };
static const double weak = 0.005;     // what is not explained, squared, from which a better explanation is looked for
static const double better = 0.3;     // of it, that a better one leaves
static const double one_depth = 0.05; // of the depth, and
static const double one_normal = 0.9; // the cosine between normals, that two clean pixels of one surface differ by
static const double purest = 0.97;    // of the length of its neighbours' normals, that an anchor's has at least
static const double least_pure = 0.7; // length of its normal
static const double beyond = 0.1;     // of a share, below 0 or above 1
static const double apart = 1e-3;     // squared sine between the ways to two sides, in what is stored

static const mended *find(repair *r, const mended_list *list, int x, int y)
{
    if (!filtered_inside(r->b, x, y) || r->place[build_index(r->b, x, y)] == 0) return NULL;
    const int place = filtered_at(r, x, y)->mended;
    return place > 0 ? &list->items[place - 1] : NULL;
}

// Two clean pixels of one surface. What a pixel further on would see of it differs much where the surface is round.
static bool alike(const repair *r, const side *a, const side *b)
{
    if (!(a->z > 0.0) || !(b->z > 0.0)) return a->z == b->z;
    const float *depth = r->b->g->depth;
    double za = (double)depth[build_index(r->b, a->u, a->v)], zb = (double)depth[build_index(r->b, b->u, b->v)];
    return fabs(za - zb) < one_depth * za && v3_dot(a->n, b->n) > one_normal;
}

static int add(repair *r, int x, int y, size_t pixel, side sides[MOST_SIDES], int count)
{
    const size_t width = (size_t)r->b->g->width;
    if (count == MOST_SIDES) return count;
    const bool open = pixel == NO_PIXEL;
    const int u = open ? 0 : (int)(pixel % width), v = open ? 0 : (int)(pixel / width);
    for (int k = 0; k < count; k++)
        if (open ? sides[k].z == 0.0 : sides[k].u == u && sides[k].v == v && sides[k].z > 0.0) return count;
    if (!open) return filtered_add_side(r, x, y, u, v, sides, count);
    sides[count] = filtered_background(r);
    return count + 1;
}

// The sides around the pixel, those that the pixels around it are means of, and the anchors among these.
static int gather(repair *r, const mended_list *list, int x, int y, side sides[MOST_SIDES], int *own)
{
    int count = *own = filtered_sides(r, x, y, sides);
    for (int reach = 1; reach <= AROUND; reach++)
        for (int v = y - reach; v <= y + reach; v++)
            for (int u = x - reach; u <= x + reach; u++) {
                if (abs(u - x) < reach && abs(v - y) < reach) continue;
                const mended *m = u == x && v == y ? NULL : find(r, list, u, v);
                if (!m) continue;
                if (m->anchor) count = add(r, x, y, m->pixel, sides, count);
                if (!(m->rest <= weak)) continue;
                count = add(r, x, y, m->near, sides, count);
                count = add(r, x, y, m->far, sides, count);
            }
    return count;
}

typedef struct three {
    int side[3];
    double share[3], rest;
} three;

// Products of what the sides store less what the pixel stores; and which sides are one surface.
typedef struct products {
    double of[MOST_SIDES][MOST_SIDES];
    bool same[MOST_SIDES][MOST_SIDES];
} products;

static void multiply(const repair *r, const stored *s, const side *sides, int count, products *out)
{
    difference off[MOST_SIDES];
    const side *nearest = NULL;
    for (int i = 0; i < count; i++)
        if (sides[i].z > 0.0 && (!nearest || sides[i].z < nearest->z)) nearest = &sides[i];
    const metric w = filtered_metric(r, nearest);
    for (int i = 0; i < count; i++) {
        off[i] =
            filtered_minus(sides[i].p, sides[i].code, sides[i].alpha, &(side){.p = s->p, .code = s->code, .alpha = s->alpha});
        for (int k = 0; k <= i; k++) {
            out->of[i][k] = out->of[k][i] = filtered_dot(&w, &off[i], &off[k]);
            out->same[i][k] = out->same[k][i] = alike(r, &sides[i], &sides[k]);
        }
    }
}

// Shares of three sides that leave least of the pixel, if it is less than the best leaves.
static void mix(const products *p, int a, int b, int c, three *best)
{
    const double(*of)[MOST_SIDES] = p->of;
    double bb = of[b][b] - 2.0 * of[a][b] + of[a][a], cc = of[c][c] - 2.0 * of[a][c] + of[a][a];
    double bc = of[b][c] - of[a][b] - of[a][c] + of[a][a], ab = of[a][a] - of[a][b], ac = of[a][a] - of[a][c];
    double all = bb * cc - bc * bc;
    if (!(all > apart * bb * cc)) return;
    double u = (ab * cc - ac * bc) / all, v = (ac * bb - ab * bc) / all;
    if (u < -beyond || v < -beyond || u + v > 1.0 + beyond) return;
    double rest = of[a][a] - u * ab - v * ac;
    if (rest < best->rest) *best = (three){{a, b, c}, {1.0 - u - v, u, v}, fmax(rest, 0.0)};
}

static three mix_three(const repair *r, const stored *s, const side *sides, int count)
{
    products p;
    three best = {.rest = INFINITY};
    multiply(r, s, sides, count, &p);
    for (int i = 0; i < count; i++)
        for (int k = i + 1; k < count; k++)
            for (int l = k + 1; l < count && !p.same[i][k]; l++)
                if (!p.same[i][l] && !p.same[k][l]) mix(&p, i, k, l, &best);
    return best;
}

// Looks for a better explanation of a pixel, of two sides or of three.
static void explain(repair *r, const mended_list *list, mended *m)
{
    side sides[MOST_SIDES];
    const int x = (int)(m->pixel % (size_t)r->b->g->width), y = (int)(m->pixel / (size_t)r->b->g->width);
    int own_count;
    const int count = gather(r, list, x, y, sides, &own_count);
    if (count == m->sides) return;
    const stored *s = filtered_at(r, x, y);
    mixture two = filtered_mixture(r, s, sides, m->sides == 0 ? own_count : 0, count);
    m->sides = count;
    if (two.rest < better * m->rest && !alike(r, two.near, two.far)) filtered_take(r, s, &two, m);
    if (m->rest <= weak || count < 3) return;
    three best = mix_three(r, s, sides, count);
    if (!(best.rest < better * m->rest && best.rest <= weak)) return;
    int most = 0;
    for (int k = 1; k < 3; k++)
        if (best.share[k] > best.share[most]) most = k;
    const side *own = &sides[best.side[most]];
    m->z = (float)own->z, m->n = own->n, m->rest = best.rest;
    m->near = m->far = filtered_clean_of(r, own);
}

// What a side leaves unexplained because its surface bends between its clean pixel and this one, squared. A bent surface turns
// from each clean pixel to the next; from facet to facet it turns once.
static double bend(repair *r, size_t pixel, int x, int y)
{
    if (pixel == NO_PIXEL) return 0.0;
    const int u = (int)(pixel % (size_t)r->b->g->width), v = (int)(pixel / (size_t)r->b->g->width);
    const int dx = (u > x) - (u < x), dy = (v > y) - (v < y);
    if (!filtered_clean(r, u + dx, v + dy) || !filtered_clean(r, u + 2 * dx, v + 2 * dy)) return 0.0;
    const vec3 n = filtered_at(r, u + dx, v + dy)->n;
    const vec3 first = v3_sub(filtered_at(r, u, v)->n, n), second = v3_sub(n, filtered_at(r, u + 2 * dx, v + 2 * dy)->n);
    const double way = (double)((u - x) * (u - x) + (v - y) * (v - y));
    return fmin(v3_dot(first, first), v3_dot(second, second)) * way;
}

static bool is_weak(const mended *m) { return m->rest > weak && !m->settled; }

// Near round surfaces a rest is to be expected.
static void settle_bent(repair *r, mended_list *list)
{
    for (mended *m = list->items; m < list->items + list->count; m++) {
        const int x = (int)(m->pixel % (size_t)r->b->g->width), y = (int)(m->pixel / (size_t)r->b->g->width);
        if (is_weak(m)) m->settled = m->rest <= weak + fmax(bend(r, m->near, x, y), bend(r, m->far, x, y));
    }
}

static void set_anchors(repair *r, mended_list *list)
{
    for (mended *m = list->items; m < list->items + list->count; m++) {
        const int x = (int)(m->pixel % (size_t)r->b->g->width), y = (int)(m->pixel / (size_t)r->b->g->width);
        if (!is_weak(m) || !(r->b->g->depth[m->pixel] > 0.0f)) continue;
        double length = v3_length(filtered_at(r, x, y)->n), most = least_pure / purest;
        for (int k = 0; k < DIRECTIONS; k++) {
            const int u = x + filtered_step[k][0], v = y + filtered_step[k][1];
            const mended *beside = find(r, list, u, v);
            if (beside && is_weak(beside)) most = fmax(most, v3_length(filtered_at(r, u, v)->n));
        }
        m->anchor = length >= purest * most;
    }
}

void filtered_again(repair *r, mended_list *list)
{
    if (!r->lengths) return; // depths alone tell of no more than two
    settle_bent(r, list);
    for (int sweep = 0; sweep < 3; sweep++) {
        if (sweep == 2) set_anchors(r, list);
        for (mended *m = list->items; m < list->items + list->count; m++)
            if (is_weak(m) && !m->anchor) explain(r, list, m);
    }
}
