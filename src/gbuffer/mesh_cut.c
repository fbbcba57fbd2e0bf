// Cutting polygons into triangles by clipping ears: a corner whose triangle holds no other corner.
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "gbuffer/mesh.h"

enum { SMALL = 64 }; // corners up to which looking at all of them is fastest

typedef struct point2 {
    double x, y;
} point2;

static double turn(point2 a, point2 b, point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// A corner seen along the axis the polygon faces most, so that its area is positive.
static point2 flatten(vec3 v, vec3 normal)
{
    double ax = fabs(normal.x), ay = fabs(normal.y), az = fabs(normal.z);
    if (ax >= ay && ax >= az) return normal.x > 0 ? (point2){v.y, v.z} : (point2){v.z, v.y};
    if (ay >= az) return normal.y > 0 ? (point2){v.z, v.x} : (point2){v.x, v.z};
    return normal.z > 0 ? (point2){v.x, v.y} : (point2){v.y, v.x};
}

// Newell: the sum over the edges, good for polygons that are not quite flat.
static vec3 polygon_normal(const vec3 *v, const unsigned *c, size_t n)
{
    vec3 sum = v3(0, 0, 0);
    for (size_t i = 0; i < n; i++) sum = v3_add(sum, v3_cross(v3_sub(v[c[i]], v[c[0]]), v3_sub(v[c[(i + 1) % n]], v[c[0]])));
    return sum;
}

static bool is_ear(const vec3 *v, const unsigned *c, size_t n, size_t i, vec3 normal)
{
    size_t before = (i + n - 1) % n, after = (i + 1) % n;
    point2 a = flatten(v[c[before]], normal), b = flatten(v[c[i]], normal), d = flatten(v[c[after]], normal);
    if (turn(a, b, d) <= 0.0) return false;
    for (size_t k = 0; k < n; k++) {
        point2 p = flatten(v[c[k]], normal);
        bool corner = c[k] == c[before] || c[k] == c[i] || c[k] == c[after];
        if (!corner && turn(a, b, p) >= 0.0 && turn(b, d, p) >= 0.0 && turn(d, a, p) >= 0.0) return false;
    }
    return true;
}

static void cut_small(const vec3 *v, unsigned *c, size_t n, vec3 normal, unsigned (*out)[3])
{
    for (size_t at = 0; n > 3; n--) {
        size_t ear = 0;
        while (ear < n && !is_ear(v, c, n, (at + ear) % n, normal)) ear++;
        size_t i = (at + (ear < n ? ear : 0)) % n; // no ear: it crosses itself or has no area, so any will do
        unsigned *t = *out++;
        t[0] = c[(i + n - 1) % n], t[1] = c[i], t[2] = c[(i + 1) % n];
        memmove(c + i, c + i + 1, (n - i - 1) * sizeof *c);
        at = i < n - 1 ? i : 0;
    }
    memcpy(*out, c, 3 * sizeof *c);
}

// ---- large ones
//
// Only corners that turn inwards can lie in an ear, so those are kept, in a list and in the cells of a grid, and an ear looks at
// the fewer of the two: as good as O(n log n) for outlines that people draw. What takes more than that is given up.

typedef struct corner {
    point2 at;
    size_t before, after; // its neighbours among those that are left
    size_t cell;
    size_t place, listed; // in `cells` and, if it turns inwards, in `inward`
    bool inwards, waits, gone;
} corner;

typedef struct cutter {
    const unsigned *c;
    corner *k; // by number in c
    size_t left;
    size_t *inward, inward_count;
    size_t *queue, first, waiting; // corners that may be ears, in a ring of n
    size_t *cells;                 // the numbers, cell by cell; in each those that turn inwards come first
    size_t *start, *cell_inward;   // of each cell
    size_t side;
    point2 low, step;
    double work; // steps that may still be taken
} cutter;

static void swap_in_cell(cutter *t, size_t a, size_t b)
{
    size_t pa = t->k[a].place, pb = t->k[b].place;
    t->cells[pa] = b, t->k[b].place = pa;
    t->cells[pb] = a, t->k[a].place = pb;
}

static void set_inwards(cutter *t, size_t i, bool inwards)
{
    corner *k = &t->k[i];
    if (k->inwards == inwards) return;
    size_t *count = &t->cell_inward[k->cell], first = t->start[k->cell];
    if (inwards) {
        swap_in_cell(t, i, t->cells[first + (*count)++]);
        k->listed = t->inward_count;
        t->inward[t->inward_count++] = i;
    } else {
        swap_in_cell(t, i, t->cells[first + --*count]);
        size_t last = t->inward[--t->inward_count];
        t->inward[k->listed] = last;
        t->k[last].listed = k->listed;
    }
    k->inwards = inwards;
}

static double turn_at(const cutter *t, size_t i)
{
    const corner *k = &t->k[i];
    return turn(t->k[k->before].at, k->at, t->k[k->after].at);
}

static size_t cell_along(double v, double low, double step, size_t side)
{
    double i = step > 0.0 ? (v - low) / step : 0.0;
    return i >= (double)side ? side - 1 : i > 0.0 ? (size_t)i : 0;
}

static bool blocks(const cutter *t, size_t ear, size_t i)
{
    const corner *k = &t->k[ear];
    unsigned id = t->c[i];
    if (id == t->c[k->before] || id == t->c[ear] || id == t->c[k->after]) return false;
    point2 a = t->k[k->before].at, b = k->at, d = t->k[k->after].at, p = t->k[i].at;
    return turn(a, b, p) >= 0.0 && turn(b, d, p) >= 0.0 && turn(d, a, p) >= 0.0;
}

typedef struct cell_box {
    size_t x0, x1, y0, y1;
} cell_box;

static cell_box cells_of(const cutter *t, size_t ear)
{
    const corner *k = &t->k[ear];
    point2 a = t->k[k->before].at, b = k->at, d = t->k[k->after].at;
    double x0 = fmin(a.x, fmin(b.x, d.x)), x1 = fmax(a.x, fmax(b.x, d.x)), y0 = fmin(a.y, fmin(b.y, d.y)),
           y1 = fmax(a.y, fmax(b.y, d.y));
    return (cell_box){cell_along(x0, t->low.x, t->step.x, t->side), cell_along(x1, t->low.x, t->step.x, t->side),
                      cell_along(y0, t->low.y, t->step.y, t->side), cell_along(y1, t->low.y, t->step.y, t->side)};
}

static bool is_large_ear(cutter *t, size_t i)
{
    t->work -= 1.0;
    if (turn_at(t, i) <= 0.0) return false;
    cell_box b = cells_of(t, i);
    size_t cells = (b.x1 - b.x0 + 1) * (b.y1 - b.y0 + 1);
    if (t->inward_count <= cells) {
        t->work -= (double)t->inward_count;
        for (size_t j = 0; j < t->inward_count; j++)
            if (blocks(t, i, t->inward[j])) return false;
        return true;
    }
    t->work -= (double)cells;
    for (size_t y = b.y0; y <= b.y1; y++)
        for (size_t x = b.x0; x <= b.x1; x++) {
            size_t cell = y * t->side + x;
            t->work -= (double)t->cell_inward[cell];
            for (size_t j = 0; j < t->cell_inward[cell]; j++)
                if (blocks(t, i, t->cells[t->start[cell] + j])) return false;
        }
    return true;
}

static void enqueue(cutter *t, size_t n, size_t i)
{
    if (t->k[i].waits || t->k[i].inwards) return;
    t->k[i].waits = true;
    t->queue[(t->first + t->waiting++) % n] = i;
}

// Every corner that turns outwards: whether it is an ear may have changed with a corner that is gone.
static void enqueue_all(cutter *t, size_t n, size_t from)
{
    size_t i = from;
    for (size_t j = 0; j < t->left; j++, i = t->k[i].after) enqueue(t, n, i);
    t->work -= (double)t->left;
}

// The next ear. Where there is none the polygon crosses itself or has no area, and any corner will do.
static size_t next_ear(cutter *t, size_t n, size_t from)
{
    for (int pass = 0; pass < 2 && t->work > 0.0; pass++) {
        while (t->waiting > 0) {
            size_t i = t->queue[t->first];
            t->first = (t->first + 1) % n, t->waiting--;
            t->k[i].waits = false;
            if (!t->k[i].gone && is_large_ear(t, i)) return i;
        }
        if (pass == 0) enqueue_all(t, n, from);
    }
    return from;
}

static bool open_cutter(cutter *t, size_t n, error *e)
{
    t->side = 1;
    while (t->side * t->side < n) t->side++;
    t->k = mem_zero(n, sizeof *t->k, e);
    t->inward = mem_zero(n, sizeof *t->inward, e);
    t->queue = mem_zero(n, sizeof *t->queue, e);
    t->cells = mem_zero(n, sizeof *t->cells, e);
    t->start = mem_zero(t->side * t->side + 1, sizeof *t->start, e);
    t->cell_inward = mem_zero(t->side * t->side, sizeof *t->cell_inward, e);
    return t->k && t->inward && t->queue && t->cells && t->start && t->cell_inward;
}

static void close_cutter(cutter *t)
{
    free(t->k);
    free(t->inward);
    free(t->queue);
    free(t->cells);
    free(t->start);
    free(t->cell_inward);
}

static void fill_cutter(cutter *t, const vec3 *v, size_t n, vec3 normal)
{
    point2 high = {-INFINITY, -INFINITY};
    t->low = (point2){INFINITY, INFINITY};
    for (size_t i = 0; i < n; i++) {
        point2 p = flatten(v[t->c[i]], normal);
        t->k[i] = (corner){.at = p, .before = (i + n - 1) % n, .after = (i + 1) % n};
        t->low = (point2){fmin(t->low.x, p.x), fmin(t->low.y, p.y)};
        high = (point2){fmax(high.x, p.x), fmax(high.y, p.y)};
    }
    t->step = (point2){(high.x - t->low.x) / (double)t->side, (high.y - t->low.y) / (double)t->side};
    for (size_t i = 0; i < n; i++) {
        corner *k = &t->k[i];
        k->cell = cell_along(k->at.y, t->low.y, t->step.y, t->side) * t->side + cell_along(k->at.x, t->low.x, t->step.x, t->side);
        t->start[k->cell + 1]++;
    }
    for (size_t i = 0; i < t->side * t->side; i++) t->start[i + 1] += t->start[i];
    for (size_t i = 0; i < n; i++) { // cell_inward counts what is filled meanwhile
        corner *k = &t->k[i];
        k->place = t->start[k->cell] + t->cell_inward[k->cell]++;
        t->cells[k->place] = i;
    }
    memset(t->cell_inward, 0, t->side * t->side * sizeof *t->cell_inward);
    for (size_t i = 0; i < n; i++) set_inwards(t, i, turn_at(t, i) <= 0.0);
}

static void remove_corner(cutter *t, size_t n, size_t i)
{
    size_t beside[2] = {t->k[i].before, t->k[i].after};
    set_inwards(t, i, false);
    t->k[i].gone = true;
    t->k[beside[0]].after = beside[1];
    t->k[beside[1]].before = beside[0];
    t->left--;
    for (int s = 0; s < 2; s++) {
        set_inwards(t, beside[s], turn_at(t, beside[s]) <= 0.0);
        enqueue(t, n, beside[s]);
    }
}

static bool cut_large(const vec3 *v, const unsigned *c, size_t n, vec3 normal, unsigned (*out)[3], error *e)
{
    cutter t = {.c = c, .left = n, .work = 1e7 + 1000.0 * (double)n};
    bool ok = open_cutter(&t, n, e);
    if (ok) fill_cutter(&t, v, n, normal);
    for (size_t at = 0; ok; out++) {
        size_t i = t.left > 3 ? next_ear(&t, n, at) : at;
        (*out)[0] = c[t.k[i].before], (*out)[1] = c[i], (*out)[2] = c[t.k[i].after];
        if (t.left == 3) break;
        at = t.k[i].after;
        remove_corner(&t, n, i);
        ok = t.work > 0.0;
    }
    close_cutter(&t);
    return ok;
}

bool mesh_cut_polygon(const vec3 *v, unsigned *c, size_t n, unsigned (*out)[3], error *e)
{
    vec3 normal = polygon_normal(v, c, n);
    if (n > SMALL) return cut_large(v, c, n, normal, out, e);
    cut_small(v, c, n, normal, out);
    return true;
}
