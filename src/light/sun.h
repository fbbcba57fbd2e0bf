// Small bright sources of an environment: the sun, lamps. Sampled by a few directions they would be noise; so they are taken out
// of the map, each to be treated as a direction of its own.
#ifndef SSDO_LIGHT_SUN_H
#define SSDO_LIGHT_SUN_H

#include "light/environment.h"

enum { SUNS_MAX = 4 };

typedef struct sun {
    vec3 direction;     // map space, unit: the flux-weighted centre
    double flux[3];     // integral of the radiance taken out of the map, over solid angle
    double solid_angle; // of the texels it was taken from
} sun;

typedef struct sun_set {
    sun suns[SUNS_MAX];
    int count; // 0 under an overcast sky
} sun_set;

// Connected texels brighter than 10 times the mean, of less than 0.02 sr and holding at least 1 % of all flux, become suns,
// brightest first; what is left of their texels is 10 times the mean. `rest` is a complete environment without them: its flux and
// the suns' sum to the map's. Without suns `rest` stays empty (level_count 0).
bool sun_split(const environment *env, int threads, sun_set *suns, environment *rest, log_t *log, error *e);

#endif
