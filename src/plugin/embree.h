// Embree 3 and 4 by one set of calls, for C and C++. 4 is taken where both are installed, as the Makefile links it.
//
// embree_nearest fills hit and ray.tfar as rtcIntersect1 does; embree_blocked returns whether anything is on the ray, as
// rtcOccluded1 tells by a negative tfar. Both may be called by many threads on one committed scene.
#ifndef SSDO_PLUGIN_EMBREE_H
#define SSDO_PLUGIN_EMBREE_H

#include <stdbool.h>
#include <stddef.h>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

static inline void embree_nearest(RTCScene in, struct RTCRayHit *ray)
{
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(in, ray, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(in, &context, ray);
#endif
}

static inline bool embree_blocked(RTCScene in, struct RTCRay ray)
{
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(in, &ray, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(in, &context, &ray);
#endif
    return ray.tfar < 0.0f;
}

#endif
