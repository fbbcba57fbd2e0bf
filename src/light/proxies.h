// Spheres that stand for occluders the camera does not see (--proxies).
//
// The file is JSON: {"spheres": [{"centre": [x, y, z], "radius": r, "albedo": [r, g, b]}, ...]}, in world space and scene units.
// An albedo may be one number for all channels; without one it is 0.5. Other members are ignored.
#ifndef SSDO_LIGHT_PROXIES_H
#define SSDO_LIGHT_PROXIES_H

#include <stdbool.h>

#include "base/error.h"
#include "base/vec.h"

enum { PROXIES_MAX = 64 };

typedef struct sphere_proxy {
    vec3 centre; // world space
    double radius;
    double albedo[3];
} sphere_proxy;

typedef struct proxy_set {
    sphere_proxy *spheres;
    int count;
} proxy_set;

// ERR_USAGE names the file and the sphere that is wrong. Free with proxies_free.
bool proxies_load(const char *path, proxy_set *out, error *e);
void proxies_free(proxy_set *set);

#endif
