// The estimators that work in slices around the view vector: horizon and bitmask (reference.h).
//
// A slice is the half plane pair through the view ray of P that holds a direction D across it. It contains the eye, so it shows
// as a straight line on the screen, and what the layer records along that line is a chain of straight segments, one a pixel: the
// pixel's tangent plane cut by the slice. Both methods look at these segments only; or, where the options say so, at the points
// in the middle of the pixels.
#include <stdlib.h>

#include "reference.h"

enum { MAX_ARCS = 16384 }; // a line crosses at most width + height pixels

typedef struct arc {
    double from, to; // signed angles from V, from <= to
} arc;

typedef struct slice {
    const layer *layer;
    const reference_slice_options *options;
    vec3 position, to_eye, across; // P, V, D
    vec3 normal;
    pixel start;
    double n;         // signed angle of the projected normal from V
    double weight;    // length of the projected normal
    double low, high; // horizons: the open arc, as far as the hemisphere reaches
    arc *arcs;        // bitmask: what is blocked; NULL for horizon
    int arc_count;
} slice;

double reference_slice_measure(double t, double n)
{
    double f = 0.25 * (-cos(2.0 * t - n) + cos(n) + 2.0 * t * sin(n));
    return t < 0.0 ? -f : f;
}

static double measure(double from, double to, double n)
{
    return reference_slice_measure(to, n) - reference_slice_measure(from, n);
}

static double angle_of(const slice *s, vec3 point)
{
    vec3 w = v3_sub(point, s->position);
    return atan2(v3_dot(w, s->across), v3_dot(w, s->to_eye));
}

// Cuts the segment a-b to the ball of radius R around P; false if nothing is left.
static bool clip_to_ball(const slice *s, vec3 *a, vec3 *b)
{
    double radius = s->options->radius;
    if (isinf(radius)) return true;
    vec3 d = v3_sub(*b, *a), from = v3_sub(*a, s->position);
    double dd = v3_dot(d, d), middle = dd > 0.0 ? -v3_dot(from, d) / dd : 0.0;
    vec3 nearest = v3_add(from, v3_scale(d, middle));
    double inside = radius * radius - v3_dot(nearest, nearest);
    if (inside < 0.0) return false;
    double half = dd > 0.0 ? sqrt(inside / dd) : INFINITY;
    double u0 = fmax(0.0, middle - half), u1 = fmin(1.0, middle + half);
    if (u0 > u1) return false;
    vec3 origin = *a;
    *a = v3_add(origin, v3_scale(d, u0));
    *b = v3_add(origin, v3_scale(d, u1));
    return true;
}

// The point `thickness` behind a surface point on its view ray, as an angle; for an infinite thickness the ray's own direction,
// which an orthographic camera has in common with the other side: pi or -pi.
static double back_angle(const slice *s, int side, vec3 point)
{
    vec3 away = v3_scale(layer_to_eye(s->layer, point), -1.0);
    if (isinf(s->options->thickness)) return side * fabs(angle_of(s, v3_add(s->position, away)));
    return angle_of(s, v3_add(point, v3_scale(away, s->options->thickness)));
}

static void add_horizon(slice *s, int side, double t0, double t1)
{
    if (side > 0) s->high = fmin(s->high, fmin(t0, t1));
    if (side < 0) s->low = fmax(s->low, fmax(t0, t1));
}

// A segment swept along its view rays is one connected piece, so the arc it blocks is the hull of its corners' angles.
static void add_arc(slice *s, int side, vec3 a, vec3 b, double t0, double t1)
{
    double k0 = back_angle(s, side, a), k1 = back_angle(s, side, b);
    double from = fmax(fmin(fmin(t0, t1), fmin(k0, k1)), s->n - M_PI_2),
           to = fmin(fmax(fmax(t0, t1), fmax(k0, k1)), s->n + M_PI_2);
    if (from < to && s->arc_count < MAX_ARCS) s->arcs[s->arc_count++] = (arc){from, to};
}

static void add_segment(slice *s, int side, const surfel *surface, double x0, double y0, double x1, double y1)
{
    vec3 a = layer_surface(s->layer, surface, x0, y0), b = layer_surface(s->layer, surface, x1, y1);
    if (!clip_to_ball(s, &a, &b)) return;
    double t0 = angle_of(s, a), t1 = angle_of(s, b);
    if (s->arcs)
        add_arc(s, side, a, b, t0, t1);
    else
        add_horizon(s, side, t0, t1);
}

// Where the slice's line runs on the screen: the derivative of the projection of P along D.
static void screen_direction(const slice *s, double side, double *dx, double *dy)
{
    const camera *c = &s->layer->camera;
    vec3 p = s->position, d = v3_scale(s->across, side);
    bool perspective = c->kind == CAMERA_PERSPECTIVE;
    *dx = c->fx * (perspective ? d.x * p.z - p.x * d.z : d.x);
    *dy = c->fy * (perspective ? d.y * p.z - p.y * d.z : d.y);
    double length = hypot(*dx, *dy);
    *dx /= length;
    *dy /= length;
}

// True if the view ray through (x, y) passes the ball around P, so that no surface on it or beyond can lie within R.
static bool out_of_reach(const slice *s, double x, double y)
{
    const camera *c = &s->layer->camera;
    double radius = s->options->radius;
    if (c->kind == CAMERA_ORTHOGRAPHIC)
        return hypot((x - c->cx) / c->fx - s->position.x, (y - c->cy) / c->fy - s->position.y) > radius;
    vec3 ray = v3_normalize(v3((x - c->cx) / c->fx, (y - c->cy) / c->fy, 1.0));
    double along = v3_dot(ray, s->position);
    return along > 0.0 && v3_length(v3_sub(s->position, v3_scale(ray, along))) > radius;
}

// Distance along the line to the next border of pixel index i.
static double next_border(double from, double direction, int i)
{
    if (direction == 0.0) return INFINITY;
    return ((direction > 0.0 ? i + 1 : i) - from) / direction;
}

// ---- pixels as points

// The signed angle from V of a point (x, y) of the slice: x outwards along the tangent of P, y along the projected normal. What
// would lie behind V on the other side counts as V.
static double angle_over_tangent(const slice *s, int side, double x, double y)
{
    double t = s->n + side * atan2(x, y);
    return side > 0 ? fmax(t, 0.0) : fmin(t, 0.0);
}

// The point of a pixel may lie beside the slice. It is put into it such that its distance from the tangent plane of P is kept: a
// plane then stays a plane.
static void add_point(slice *s, int side, vec3 point)
{
    const reference_slice_options *o = s->options;
    vec3 w = v3_sub(point, s->position);
    if (v3_length(w) >= o->radius) return;
    double sine = sin(s->n), cosine = cos(s->n);
    vec3 tangent = v3_scale(v3_sub(v3_scale(s->across, cosine), v3_scale(s->to_eye, sine)), side);
    double x = v3_dot(w, tangent), y = v3_dot(w, s->normal) / s->weight, front = angle_over_tangent(s, side, x, y);
    if (y <= 0.0) return;
    if (!s->arcs) {
        add_horizon(s, side, front, front);
        return;
    }
    bool perspective = s->layer->camera.kind == CAMERA_PERSPECTIVE;
    double eye = perspective ? v3_length(s->position) : 1.0, ex = -side * sine * eye, ey = cosine * eye;
    double ax = perspective ? x - ex : -ex, ay = perspective ? y - ey : -ey, length = hypot(ax, ay);
    double depth = fmin(o->thickness, 1e9 * o->radius);
    double back = angle_over_tangent(s, side, x + depth * ax / length, y + depth * ay / length);
    if (y + depth * ay / length <= 0.0) back = s->n + side * M_PI_2;
    if (s->arc_count < MAX_ARCS)
        s->arcs[s->arc_count++] = (arc){fmax(fmin(front, back), s->n - M_PI_2), fmin(fmax(front, back), s->n + M_PI_2)};
}

// The points of the pixels that lie a whole number of pixels from P along the line.
static void march_points(slice *s, int side)
{
    double x = s->start.x + 0.5, y = s->start.y + 0.5, dx, dy;
    screen_direction(s, side, &dx, &dy);
    for (int i = 1;; i++) {
        double px = x + i * dx, py = y + i * dy;
        if (!(px >= 0.0 && py >= 0.0 && px < s->layer->width && py < s->layer->height) || out_of_reach(s, px, py)) return;
        const surfel *surface = layer_at(s->layer, (int)px, (int)py);
        if (surface) add_point(s, side, surface->position);
    }
}

// ---- pixels as pieces of surface

// Visits every pixel the line crosses, from P's own (which holds only P's tangent, the limit already set) to the frame's edge.
static void march(slice *s, int side)
{
    double x = s->start.x + 0.5, y = s->start.y + 0.5, dx, dy, at = 0.0;
    int ix = s->start.x, iy = s->start.y;
    screen_direction(s, side, &dx, &dy);
    while (ix >= 0 && iy >= 0 && ix < s->layer->width && iy < s->layer->height) {
        if (out_of_reach(s, x + at * dx, y + at * dy)) return;
        double bx = next_border(x, dx, ix), by = next_border(y, dy, iy), end = fmin(bx, by);
        const surfel *surface = layer_at(s->layer, ix, iy);
        if (surface && at > 0.0) add_segment(s, side, surface, x + at * dx, y + at * dy, x + end * dx, y + end * dy);
        if (bx <= by) ix += dx > 0.0 ? 1 : -1;
        if (by <= bx) iy += dy > 0.0 ? 1 : -1;
        at = end;
    }
}

static int by_start(const void *a, const void *b)
{
    double d = ((const arc *)a)->from - ((const arc *)b)->from;
    return d < 0.0 ? -1 : d > 0.0;
}

// Weight of what no arc covers between low and high.
static double open_weight(slice *s)
{
    double reached = s->low, open = 0.0;
    if (s->arc_count) qsort(s->arcs, (size_t)s->arc_count, sizeof *s->arcs, by_start);
    for (int i = 0; i < s->arc_count; i++) {
        if (s->arcs[i].from > reached) open += measure(reached, s->arcs[i].from, s->n);
        reached = fmax(reached, s->arcs[i].to);
    }
    return open + (reached < s->high ? measure(reached, s->high, s->n) : 0.0);
}

static void aim(slice *s, vec3 normal, vec3 a, vec3 b, double phi)
{
    s->across = v3_add(v3_scale(a, cos(phi)), v3_scale(b, sin(phi)));
    double up = v3_dot(normal, s->to_eye), sideways = v3_dot(normal, s->across);
    s->n = atan2(sideways, up);
    s->weight = hypot(sideways, up);
    s->low = s->n - M_PI_2;
    s->high = s->n + M_PI_2;
    s->arc_count = 0;
}

// The ratio of open weight to the weight of the empty hemisphere, over all slices.
static double integrate(const layer *l, pixel p, const reference_slice_options *o, arc *arcs)
{
    const surfel *centre = layer_at(l, p.x, p.y);
    slice s = {.layer = l, .options = o, .position = centre->position, .normal = centre->normal, .start = p, .arcs = arcs};
    s.to_eye = layer_to_eye(l, centre->position);
    vec3 a = v3_normalize(v3_cross(s.to_eye, fabs(s.to_eye.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0))), b = v3_cross(s.to_eye, a);
    int slices = o->slices > 0 ? o->slices : 128;
    double open = 0.0, empty = 0.0;
    for (int i = 0; i < slices; i++) {
        aim(&s, centre->normal, a, b, M_PI * (i + 0.5) / slices);
        empty += s.weight * measure(s.low, s.high, s.n);
        for (int side = 1; side >= -1; side -= 2) (o->points ? march_points : march)(&s, side);
        if (s.high > s.low) open += s.weight * open_weight(&s);
    }
    return empty > 0.0 ? open / empty : 1.0;
}

double reference_horizon(const layer *l, pixel p, const reference_slice_options *o) { return integrate(l, p, o, NULL); }

double reference_bitmask(const layer *l, pixel p, const reference_slice_options *o)
{
    arc arcs[MAX_ARCS];
    return integrate(l, p, o, arcs);
}
