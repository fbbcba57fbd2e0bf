#include "scene.h"

#include <assert.h>

static vec3 faced(vec3 normal, vec3 direction) { return v3_dot(normal, direction) > 0.0 ? v3_scale(normal, -1.0) : normal; }

static bool plane_t(vec3 at, vec3 normal, vec3 o, vec3 d, double *t)
{
    double facing = v3_dot(normal, d);
    if (facing == 0.0) return false;
    *t = v3_dot(normal, v3_sub(at, o)) / facing;
    return true;
}

static bool hit_plane(const shape *s, vec3 o, vec3 d, double tmin, double tmax, hit *h)
{
    h->normal = s->axis[0];
    return plane_t(s->at, s->axis[0], o, d, &h->t) && h->t > tmin && h->t < tmax;
}

static bool hit_disc(const shape *s, vec3 o, vec3 d, double tmin, double tmax, hit *h)
{
    if (!hit_plane(s, o, d, tmin, tmax, h)) return false;
    vec3 r = v3_sub(v3_add(o, v3_scale(d, h->t)), s->at);
    return v3_dot(r, r) <= s->radius * s->radius;
}

static bool hit_quad(const shape *s, vec3 o, vec3 d, double tmin, double tmax, hit *h)
{
    vec3 a = s->axis[0], b = s->axis[1], n = v3_cross(a, b);
    h->normal = v3_normalize(n);
    if (!plane_t(s->at, n, o, d, &h->t) || h->t <= tmin || h->t >= tmax) return false;
    vec3 r = v3_sub(v3_add(o, v3_scale(d, h->t)), s->at);
    double nn = v3_dot(n, n);
    double u = v3_dot(v3_cross(r, b), n) / nn, v = v3_dot(v3_cross(a, r), n) / nn;
    return u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0;
}

// From the point of the ray nearest to the centre: no cancellation, however far away the sphere is.
static bool hit_sphere(const shape *s, vec3 o, vec3 d, double tmin, double tmax, hit *h)
{
    double dd = v3_dot(d, d), middle = v3_dot(v3_sub(s->at, o), d) / dd;
    vec3 off = v3_sub(v3_add(o, v3_scale(d, middle)), s->at);
    double inside = s->radius * s->radius - v3_dot(off, off);
    if (inside < 0.0) return false;
    double half = sqrt(inside / dd);
    h->t = middle - half > tmin ? middle - half : middle + half;
    if (h->t <= tmin || h->t >= tmax) return false;
    h->normal = v3_scale(v3_add(off, v3_scale(d, h->t - middle)), 1.0 / s->radius);
    return true;
}

// Slabs in the box's own axes; from inside, the far face is the hit.
static bool hit_box(const shape *s, vec3 o, vec3 d, double tmin, double tmax, hit *h)
{
    double enter = -INFINITY, leave = INFINITY;
    int enter_axis = 0, leave_axis = 0;
    vec3 rel = v3_sub(o, s->at);
    for (int i = 0; i < 3; i++) {
        double size = v3_dot(s->axis[i], s->axis[i]); // squared: both projections below carry the half length too
        double p = v3_dot(rel, s->axis[i]), q = v3_dot(d, s->axis[i]);
        if (q == 0.0) {
            if (fabs(p) > size) return false;
            continue;
        }
        double t0 = (-copysign(size, q) - p) / q, t1 = (copysign(size, q) - p) / q;
        if (t0 > enter) enter = t0, enter_axis = i;
        if (t1 < leave) leave = t1, leave_axis = i;
    }
    if (enter > leave) return false;
    bool outside = enter > tmin;
    h->t = outside ? enter : leave;
    h->normal = v3_normalize(s->axis[outside ? enter_axis : leave_axis]);
    return h->t > tmin && h->t < tmax;
}

static bool hit_triangle(vec3 a, vec3 b, vec3 c, vec3 o, vec3 d, double tmin, double tmax, hit *h)
{
    vec3 ab = v3_sub(b, a), ac = v3_sub(c, a), p = v3_cross(d, ac);
    double det = v3_dot(ab, p);
    if (det == 0.0) return false;
    vec3 s = v3_sub(o, a), q = v3_cross(s, ab);
    double u = v3_dot(s, p) / det, v = v3_dot(d, q) / det, t = v3_dot(ac, q) / det;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || t <= tmin || t >= tmax) return false;
    h->t = t;
    h->normal = v3_normalize(v3_cross(ab, ac));
    return true;
}

static bool hit_mesh(const shape *s, vec3 o, vec3 d, double tmin, double tmax, hit *h)
{
    vec3 off = v3_sub(s->at, o);
    off = v3_sub(off, v3_scale(d, v3_dot(off, d) / v3_dot(d, d)));
    if (v3_dot(off, off) > s->radius * s->radius) return false;
    bool found = false;
    for (int i = 0; i < s->mesh.triangle_count; i++) {
        const int *v = s->mesh.triangles[i];
        hit one;
        if (!hit_triangle(s->mesh.vertices[v[0]], s->mesh.vertices[v[1]], s->mesh.vertices[v[2]], o, d, tmin, tmax, &one))
            continue;
        *h = one;
        tmax = one.t;
        found = true;
    }
    return found;
}

static bool hit_shape(const shape *s, vec3 o, vec3 d, double tmin, double tmax, hit *h)
{
    switch (s->kind) {
    case SHAPE_PLANE:
        return hit_plane(s, o, d, tmin, tmax, h);
    case SHAPE_SPHERE:
        return hit_sphere(s, o, d, tmin, tmax, h);
    case SHAPE_DISC:
        return hit_disc(s, o, d, tmin, tmax, h);
    case SHAPE_QUAD:
        return hit_quad(s, o, d, tmin, tmax, h);
    case SHAPE_BOX:
        return hit_box(s, o, d, tmin, tmax, h);
    case SHAPE_MESH:
        return hit_mesh(s, o, d, tmin, tmax, h);
    }
    return false;
}

static bool scene_closest(const void *data, vec3 o, vec3 d, double tmin, double tmax, hit *out)
{
    const scene *s = data;
    bool found = false;
    for (int i = 0; i < s->shape_count; i++) {
        hit h;
        if (!hit_shape(&s->shapes[i], o, d, tmin, tmax, &h)) continue;
        found = true;
        tmax = h.t;
        *out = (hit){h.t, v3_add(o, v3_scale(d, h.t)), faced(h.normal, d), s->shapes[i].albedo};
    }
    return found;
}

static bool scene_blocked(const void *data, vec3 o, vec3 d, double tmin, double tmax)
{
    const scene *s = data;
    hit h;
    for (int i = 0; i < s->shape_count; i++)
        if (hit_shape(&s->shapes[i], o, d, tmin, tmax, &h)) return true;
    return false;
}

tracer scene_tracer(const scene *s) { return (tracer){scene_closest, scene_blocked, s}; }

static shape *add(scene *s, shape_kind kind, vec3 at, vec3 albedo)
{
    assert(s->shape_count < SCENE_MAX_SHAPES);
    shape *n = &s->shapes[s->shape_count++];
    *n = (shape){.kind = kind, .at = at, .albedo = albedo};
    return n;
}

void scene_add_plane(scene *s, vec3 point, vec3 normal, vec3 albedo)
{
    add(s, SHAPE_PLANE, point, albedo)->axis[0] = v3_normalize(normal);
}

void scene_add_sphere(scene *s, vec3 centre, double radius, vec3 albedo)
{
    add(s, SHAPE_SPHERE, centre, albedo)->radius = radius;
}

void scene_add_disc(scene *s, vec3 centre, vec3 normal, double radius, vec3 albedo)
{
    shape *n = add(s, SHAPE_DISC, centre, albedo);
    n->axis[0] = v3_normalize(normal);
    n->radius = radius;
}

void scene_add_quad(scene *s, vec3 corner, vec3 edge_a, vec3 edge_b, vec3 albedo)
{
    shape *n = add(s, SHAPE_QUAD, corner, albedo);
    n->axis[0] = edge_a;
    n->axis[1] = edge_b;
}

void scene_add_box(scene *s, vec3 centre, vec3 half_size, double turn_degrees, vec3 albedo)
{
    shape *n = add(s, SHAPE_BOX, centre, albedo);
    mat3 turn = rotation_about(v3(0, 0, 1), turn_degrees);
    n->axis[0] = m3_apply(turn, v3(half_size.x, 0, 0));
    n->axis[1] = m3_apply(turn, v3(0, half_size.y, 0));
    n->axis[2] = v3(0, 0, half_size.z);
}

static void bound_mesh(shape *s)
{
    s->at = v3(0, 0, 0);
    for (int i = 0; i < s->mesh.vertex_count; i++)
        s->at = v3_add(s->at, v3_scale(s->mesh.vertices[i], 1.0 / s->mesh.vertex_count));
    s->radius = 0.0;
    for (int i = 0; i < s->mesh.vertex_count; i++)
        s->radius = fmax(s->radius, v3_length(v3_sub(s->mesh.vertices[i], s->at)) * (1.0 + 1e-9));
}

void scene_add_mesh(scene *s, mesh m, vec3 albedo)
{
    shape *n = add(s, SHAPE_MESH, v3(0, 0, 0), albedo);
    n->mesh = m;
    bound_mesh(n);
}

mat3 rotation_about(vec3 axis, double degrees)
{
    double a = degrees * (M_PI / 180.0), c = cos(a), s = sin(a), k = 1.0 - c;
    return (mat3){{{c + axis.x * axis.x * k, axis.x * axis.y * k - axis.z * s, axis.x * axis.z * k + axis.y * s},
                   {axis.y * axis.x * k + axis.z * s, c + axis.y * axis.y * k, axis.y * axis.z * k - axis.x * s},
                   {axis.z * axis.x * k - axis.y * s, axis.z * axis.y * k + axis.x * s, c + axis.z * axis.z * k}}};
}

static vec3 placed(vec3 p, double scale, mat3 rotation, vec3 offset)
{
    return v3_add(m3_apply(rotation, v3_scale(p, scale)), offset);
}

static void place_shape(shape *s, double scale, mat3 rotation, vec3 offset)
{
    bool unit_axis = s->kind == SHAPE_PLANE || s->kind == SHAPE_DISC;
    s->at = placed(s->at, scale, rotation, offset);
    for (int i = 0; i < 3; i++) s->axis[i] = m3_apply(rotation, v3_scale(s->axis[i], unit_axis ? 1.0 : scale));
    s->radius *= scale;
    for (int i = 0; i < s->mesh.vertex_count; i++) s->mesh.vertices[i] = placed(s->mesh.vertices[i], scale, rotation, offset);
    if (s->kind == SHAPE_MESH) bound_mesh(s);
}

void scene_place(scene *s, double scale, mat3 rotation, vec3 offset)
{
    for (int i = 0; i < s->shape_count; i++) place_shape(&s->shapes[i], scale, rotation, offset);
    s->eye = placed(s->eye, scale, rotation, offset);
    s->target = placed(s->target, scale, rotation, offset);
    s->point = placed(s->point, scale, rotation, offset);
    s->radius *= scale;
}
