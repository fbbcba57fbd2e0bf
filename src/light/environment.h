// The environment light: a lat-long map, prepared once in double on the CPU.
//
// Texel (i, j) has its centre at ((i + 0.5) / width, (j + 0.5) / height). Two mappings of direction to (u, v), v from the top:
//   up z (Blender's equirectangular):  u = 0.5 - atan2(y, x) / (2 pi),  v = acos(z) / pi
//   up y (OpenEXR's latlong):          longitude = atan2(x, z), u = 0.5 - longitude / (2 pi),  v = acos(y) / pi
// Inside the program there is ONE mapping, "up z"; `map_from_world` turns a world direction into it, so shaders know only
//     u = 0.5 - atan2(y, x) / (2 pi), v = acos(z) / pi   of   d = map_from_world * world_direction.
// (OpenEXR's header puts the centres of the first and last column at longitudes +pi and -pi; renderers, and this program, put the
// map's edges there.) Blender's mapping is its Environment Texture node's "Equirectangular".
// rotate: the environment turns by `rotate` degrees about the up axis, counter-clockwise seen from above: what was seen towards d
// is now seen towards d turned by `rotate`. Blender: a Mapping node of type Point with rotation Z = -rotate.
// Values: NaN and negative become 0 (counted), +inf becomes the largest finite value of the map; after --env-scale nothing
// exceeds 1e30, so that sums of floats stay finite.
#ifndef SSDO_LIGHT_ENVIRONMENT_H
#define SSDO_LIGHT_ENVIRONMENT_H

#include "base/error.h"
#include "base/log.h"
#include "light/env_map.h"

typedef struct env_options {
    const char *path; // NULL: the white environment of radiance 1 (a 1x1 map)
    bool up_z;
    double rotate_degrees;   // 0
    const char *colorspace;  // the map's, converted to scene linear by OpenColorIO; NULL: it is linear already
    const double *primaries; // the picture's chromaticities; a map that has others is converted to them. NULL: as it is
    const char *ocio;        // config file; NULL: the one $OCIO names
    double scale;            // 1; multiplies the white environment too
    int threads;
} env_options;

// Reads options->path and prepares it. EXR is read by exr/file.h (the first R G B of the first part that has them, else a single
// Y; a data window smaller than a 2:1 display window is completed with black), all else by the OpenImageIO module.
bool environment_load(const env_options *options, environment *out, log_t *log, error *e);
// The same from memory: 3 floats a texel, row-major, top row first; rgb is borrowed. options->path only names the map in
// messages.
bool environment_prepare(const float *rgb, int width, int height, const env_options *options, environment *out, log_t *log,
                         error *e);

// E / pi for a unit normal, by summing every texel of level 0: the slow reference. Texels above the horizon count exactly, those
// that the horizon cuts are subdivided down to 0.1 degrees.
vec3 environment_irradiance_over_pi(const environment *env, vec3 map_normal);

#endif
