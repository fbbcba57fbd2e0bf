// The C++ side of plugin/trace.h: Embree.
#include <cstdio>
#include <cstring>
#include <new>
#include <string>

#include "plugin/embree.h"
#include "plugin/trace_abi.h"

#define EXPORT extern "C" __attribute__((visibility("default")))

namespace
{
struct scene {
    RTCDevice device = nullptr;
    RTCScene traced = nullptr;
    ~scene()
    {
        if (traced) rtcReleaseScene(traced);
        if (device) rtcReleaseDevice(device);
    }
};

bool fill(scene &s, const float *vertices, size_t vertex_count, const uint32_t *triangles, size_t triangle_count)
{
    RTCGeometry g = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void *v = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertex_count);
    void *t = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangle_count);
    if (v && t) {
        std::memcpy(v, vertices, 12 * vertex_count);
        std::memcpy(t, triangles, 12 * triangle_count);
        rtcCommitGeometry(g);
        rtcAttachGeometry(s.traced, g);
        rtcCommitScene(s.traced);
    }
    rtcReleaseGeometry(g);
    return v && t && rtcGetDeviceError(s.device) == RTC_ERROR_NONE;
}

RTCRay ray_of(const trace_ray &r)
{
    RTCRay ray = {};
    ray.org_x = r.origin[0], ray.org_y = r.origin[1], ray.org_z = r.origin[2];
    ray.dir_x = r.direction[0], ray.dir_y = r.direction[1], ray.dir_z = r.direction[2];
    ray.tnear = 0.0f, ray.tfar = r.reach, ray.mask = ~0u;
    return ray;
}

trace_hit nearest(RTCScene s, const trace_ray &r)
{
    RTCRayHit q = {};
    q.ray = ray_of(r);
    q.hit.geomID = q.hit.primID = q.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree_nearest(s, &q);
    if (q.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {TRACE_FAR, TRACE_MISS};
    return {q.ray.tfar, q.hit.primID};
}

trace_hit blocked(RTCScene s, const trace_ray &r)
{
    return embree_blocked(s, ray_of(r)) ? trace_hit{0.0f, 0} : trace_hit{TRACE_FAR, TRACE_MISS};
}
} // namespace

EXPORT void *ssdo_trace_open(const float *vertices, size_t vertex_count, const uint32_t *triangles, size_t triangle_count,
                             int threads, char *message, size_t size)
{
    scene *s = new (std::nothrow) scene;
    const std::string config = "threads=" + std::to_string(threads);
    if (s) s->device = rtcNewDevice(config.c_str());
    if (s && s->device) s->traced = rtcNewScene(s->device);
    if (s && s->traced) {
        rtcSetSceneFlags(s->traced, RTC_SCENE_FLAG_ROBUST); // no ray slips through between two triangles
        if (fill(*s, vertices, vertex_count, triangles, triangle_count)) return s;
    }
    delete s;
    std::snprintf(message, size, "Embree cannot hold the mesh of %zu triangles; free some memory or use --trace gpu",
                  triangle_count);
    return nullptr;
}

EXPORT void ssdo_trace_rays(const void *data, const trace_ray *rays, trace_hit *hits, size_t count)
{
    const scene *s = static_cast<const scene *>(data);
    for (size_t i = 0; i < count; i++) {
        if (rays[i].reach < 0.0f)
            hits[i] = {0.0f, TRACE_NO_RAY};
        else
            hits[i] = rays[i].any != 0.0f ? blocked(s->traced, rays[i]) : nearest(s->traced, rays[i]);
    }
}

EXPORT void ssdo_trace_close(void *data) { delete static_cast<scene *>(data); }
