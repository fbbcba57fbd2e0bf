#include <stdbool.h>
#include <stdlib.h>

#include "base/mem.h"
#include "bench.h"
#include "plugin/embree.h"

struct embree {
    RTCDevice device;
    RTCScene scene;
    vec3 albedo[SCENE_MAX_SHAPES]; // by geometry
};

static const double PLANE_SIZE = 1000.0;

static void attach(embree *m, RTCGeometry g, vec3 albedo)
{
    rtcCommitGeometry(g);
    m->albedo[rtcAttachGeometry(m->scene, g)] = albedo;
    rtcReleaseGeometry(g);
}

static void set_vertex(float *to, vec3 v) { to[0] = (float)v.x, to[1] = (float)v.y, to[2] = (float)v.z; }

static RTCGeometry triangles(embree *m, const vec3 *vertices, int vertex_count, const int (*index)[3], int count)
{
    RTCGeometry g = rtcNewGeometry(m->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *v = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, (size_t)vertex_count);
    unsigned *t = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, (size_t)count);
    for (int i = 0; i < vertex_count; i++) set_vertex(v + 3 * i, vertices[i]);
    for (int i = 0; i < 3 * count; i++) t[i] = (unsigned)index[i / 3][i % 3];
    return g;
}

static void add_parallelogram(embree *m, vec3 corner, vec3 a, vec3 b, vec3 albedo)
{
    static const int index[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const vec3 v[4] = {corner, v3_add(corner, a), v3_add(v3_add(corner, a), b), v3_add(corner, b)};
    attach(m, triangles(m, v, 4, index, 2), albedo);
}

static void add_plane(embree *m, const shape *s)
{
    vec3 n = s->axis[0], helper = fabs(n.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0);
    vec3 a = v3_scale(v3_normalize(v3_cross(n, helper)), PLANE_SIZE), b = v3_cross(n, a);
    add_parallelogram(m, v3_sub(v3_sub(s->at, a), b), v3_scale(a, 2.0), v3_scale(b, 2.0), s->albedo);
}

static void add_box(embree *m, const shape *s)
{
    static const int index[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                     {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
    vec3 v[8];
    for (int i = 0; i < 8; i++) {
        v[i] = s->at;
        for (int k = 0; k < 3; k++) v[i] = v3_add(v[i], v3_scale(s->axis[k], i & 1 << k ? 1.0 : -1.0));
    }
    attach(m, triangles(m, v, 8, index, 12), s->albedo);
}

static void add_sphere(embree *m, const shape *s)
{
    RTCGeometry g = rtcNewGeometry(m->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    float *v = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 16, 1);
    set_vertex(v, s->at);
    v[3] = (float)s->radius;
    attach(m, g, s->albedo);
}

static void add_shape(embree *m, const shape *s)
{
    switch (s->kind) {
    case SHAPE_PLANE:
        add_plane(m, s);
        break;
    case SHAPE_SPHERE:
        add_sphere(m, s);
        break;
    case SHAPE_QUAD:
        add_parallelogram(m, s->at, s->axis[0], s->axis[1], s->albedo);
        break;
    case SHAPE_BOX:
        add_box(m, s);
        break;
    case SHAPE_MESH:
        attach(m, triangles(m, s->mesh.vertices, s->mesh.vertex_count, s->mesh.triangles, s->mesh.triangle_count), s->albedo);
        break;
    case SHAPE_DISC:
        break; // embree_open refuses it
    }
}

static struct RTCRay ray_of(vec3 o, vec3 d, double tmin, double tmax)
{
    return (struct RTCRay){.org_x = (float)o.x,
                           .org_y = (float)o.y,
                           .org_z = (float)o.z,
                           .dir_x = (float)d.x,
                           .dir_y = (float)d.y,
                           .dir_z = (float)d.z,
                           .tnear = (float)tmin,
                           .tfar = (float)tmax,
                           .mask = ~0u};
}

static bool closest(const void *data, vec3 o, vec3 d, double tmin, double tmax, hit *out)
{
    const embree *m = data;
    struct RTCRayHit r = {.ray = ray_of(o, d, tmin, tmax), .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    embree_nearest(m->scene, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    vec3 n = v3_normalize(v3((double)r.hit.Ng_x, (double)r.hit.Ng_y, (double)r.hit.Ng_z));
    if (v3_dot(n, d) > 0.0) n = v3_scale(n, -1.0);
    double t = (double)r.ray.tfar;
    *out = (hit){t, v3_add(o, v3_scale(d, t)), n, m->albedo[r.hit.geomID]};
    return true;
}

static bool blocked(const void *data, vec3 o, vec3 d, double tmin, double tmax)
{
    const embree *m = data;
    return embree_blocked(m->scene, ray_of(o, d, tmin, tmax));
}

embree *embree_open(const scene *s, error *e)
{
    for (int i = 0; i < s->shape_count; i++)
        if (s->shapes[i].kind == SHAPE_DISC) {
            err_set(e, ERR_INPUT, NULL, NULL, "the Embree tracer knows no discs; use scene_tracer for this scene");
            return NULL;
        }
    embree *m = mem_zero(1, sizeof *m, e);
    if (!m) return NULL;
    m->device = rtcNewDevice("threads=1");
    m->scene = m->device ? rtcNewScene(m->device) : NULL;
    if (!m->scene) {
        err_set(e, ERR_MEMORY, NULL, NULL, "Embree cannot be started; the truth of generated scenes needs it");
        embree_close(m);
        return NULL;
    }
    rtcSetSceneFlags(m->scene, RTC_SCENE_FLAG_ROBUST);
    for (int i = 0; i < s->shape_count; i++) add_shape(m, &s->shapes[i]);
    rtcCommitScene(m->scene);
    return m;
}

tracer embree_tracer(const embree *m) { return (tracer){closest, blocked, m}; }

void embree_close(embree *m)
{
    if (!m) return;
    if (m->scene) rtcReleaseScene(m->scene);
    if (m->device) rtcReleaseDevice(m->device);
    free(m);
}
