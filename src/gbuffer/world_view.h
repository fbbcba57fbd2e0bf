// What a G-buffer shows of the world, whatever camera it was rendered with: points in world space and directions without a
// surface. A lat-long (360 degree) G-buffer is recognised by its positions.
#ifndef SSDO_GBUFFER_WORLD_VIEW_H
#define SSDO_GBUFFER_WORLD_VIEW_H

#include "gbuffer/gbuffer.h"

typedef struct world_view {
    vec3 eye;
    bool latlong;
    double pixel;  // angle of a pixel, radians
    float *points; // x y z in world space; owned
    float *albedo; // r g b of each point; NULL: the file has none. Owned
    size_t point_count;
    float *empty; // unit world directions in which the eye sees no surface; owned
    size_t empty_count;
    // Of a perspective picture, else NULL: depth (0 nothing known, -1 no surface) and normal in its own camera space, width x
    // height x 4; owned. `camera` is that of these pixels, its world known.
    float *surface;
    int width, height;
    camera camera;
} world_view;

// From a file whose channels are loaded and resolved: position, and depth, normal or albedo where there are any. At most `most`
// pixels are taken, evenly. ERR_INPUT where the file has no positions in world space or its camera cannot be found from them.
// Free with world_view_free.
bool world_view_read(const exrio_file *file, const resolution *r, const gbuffer_options *options, size_t most, world_view *out,
                     log_t *log, error *e);
// The same of a frame whose perspective camera is known in the world; `out` comes zeroed. False only for want of memory.
bool world_view_of_frame(const gbuffer *gb, size_t most, world_view *out, error *e);
void world_view_free(world_view *v);

// Whether a pixel shows that there is nothing: it is part of an opening of at least 3 x 3 empty pixels. What is narrower may be a
// crack between two surfaces. Beyond the picture's border all counts as empty.
typedef bool (*pixel_empty_fn)(const void *picture, int x, int y);
bool shows_nothing(pixel_empty_fn is_empty, const void *picture, int x, int y);
// pixel_empty_fn of a gbuffer: no surface, and none that covers the pixel in part.
bool gbuffer_pixel_empty(const void *gb, int x, int y);

// The eye of a lat-long picture and how its columns turn, from its positions (NaN or all 0: none), width x height x 3: the top
// row looks along the up axis (2: z, 1: y), the first column at `start` radians about it, the rest by a full turn,
// counter-clockwise seen from above if `sense` is 1, clockwise if -1. False if the positions are not those of a lat-long camera
// that stands upright.
typedef struct latlong_camera {
    vec3 eye;
    int up;
    double start;
    int sense;
    double error; // median angle between a position and its pixel's direction, in pixels
} latlong_camera;
bool latlong_fit(const float *positions, int width, int height, latlong_camera *out);
vec3 latlong_direction(const latlong_camera *c, int width, int height, double x, double y);

#endif
