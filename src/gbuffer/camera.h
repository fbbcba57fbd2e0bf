// The camera of a frame.
//
// Camera space is right-handed: x right, y DOWN (the way pixel rows run), z forward, the eye at the origin. So pixel and ray
// share signs:
//     perspective   P = z * ((x - cx) / fx, (y - cy) / fy, 1)
//     orthographic  P = ((x - cx) / fx, (y - cy) / fy, z)
// x, y in pixels of the data window: its top left corner is (0, 0), the centre of its first pixel (0.5, 0.5). Scene units
// throughout. A mirrored world (left-handed) gives world_from_camera a determinant of -1; every estimator is indifferent to that.
// For an orthographic camera the origin is moved back so that every surface has z > 0.
#ifndef SSDO_GBUFFER_CAMERA_H
#define SSDO_GBUFFER_CAMERA_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"
#include "base/vec.h"
#include "exr/file.h"

typedef enum camera_kind { CAMERA_PERSPECTIVE, CAMERA_ORTHOGRAPHIC } camera_kind;
typedef enum camera_source { CAMERA_FROM_FLAG, CAMERA_FROM_FIT, CAMERA_FROM_HEADER, CAMERA_FROM_PLANE } camera_source;

typedef struct camera {
    camera_kind kind;
    camera_source source;
    double fx, fy;          // perspective: focal length in pixels; orthographic: pixels per scene unit
    double cx, cy;          // principal point in data-window pixels
    bool has_world;         // world_from_camera and origin are known
    bool has_rotation;      // world_from_camera is known, and so it is with has_world
    mat3 world_from_camera; // columns: camera x, y, z in world space
    vec3 origin;            // the eye in world space
    double residual;        // median reprojection error in pixels; negative when nothing was measured
    double inliers;         // share of valid pixels within half a pixel of their place, 0..1
} camera;

// One observation: a world position and the data-window pixel position where it was seen.
typedef struct camera_point {
    vec3 world;
    double x, y;
} camera_point;

// Fits a camera to points (Hartley and Zisserman 2004, algorithm 7.1). A normalised DLT in double gives the first estimate; at
// least 30 % of the points may be bad. Levenberg-Marquardt then minimises the reprojection error over focal length, centre and
// pose, with zero skew. The residual decides between perspective and orthographic; the simpler camera (orthographic) wins ties.
// Deterministic.
// Returns false with ERR_INPUT naming --fov, --ortho and --camera when the points do not determine a camera (coplanar, too few).
// A file whose points all lie on one plane can still be solved with camera_fit_plane.
bool camera_fit(const camera_point *points, size_t count, camera *out, error *e);

// One plane: homography plus planar depth z per point, assuming square pixels (fy = fx * pixel_aspect) and the principal point at
// (cx, cy).
bool camera_fit_plane(const camera_point *points, const double *planar_depth, size_t count, double pixel_aspect, double cx,
                      double cy, camera *out, error *e);

// From flags: horizontal field of view in degrees (perspective) or width in scene units (orthographic), over the display window.
// No world pose.
void camera_from_fov(double fov_degrees, box2 data, box2 display, double pixel_aspect, camera *out);
void camera_from_ortho(double width, box2 data, box2 display, double pixel_aspect, camera *out);

// From a JSON file: {"fov": .. | "focal_px": [fx, fy] | "ortho_width": .., "principal": [x, y] (display-window pixels, optional),
// "world_from_camera": 4x4 row major, column vectors, camera axes x right, y up, z backwards (the convention of Blender and
// OpenGL), optional}.
bool camera_from_json(const char *path, box2 data, box2 display, double pixel_aspect, camera *out, error *e);

// World position to camera space. Here, and the transpose's product written out: this runs for every pixel of a frame.
static inline vec3 camera_from_world(const camera *c, vec3 world)
{
    const double(*m)[3] = c->world_from_camera.m;
    vec3 d = v3_sub(world, c->origin);
    return v3(m[0][0] * d.x + m[1][0] * d.y + m[2][0] * d.z, m[0][1] * d.x + m[1][1] * d.y + m[2][1] * d.z,
              m[0][2] * d.x + m[1][2] * d.y + m[2][2] * d.z);
}

// Camera-space position to data-window pixel; behind the eye false, and NaN.
static inline bool camera_project(const camera *c, vec3 p, double *x, double *y)
{
    double scale = 1.0;
    *x = *y = (double)NAN;
    if (c->kind == CAMERA_PERSPECTIVE) {
        if (!(p.z > 0.0)) return false;
        scale = 1.0 / p.z;
    }
    *x = c->cx + c->fx * p.x * scale;
    *y = c->cy + c->fy * p.y * scale;
    return true;
}

// Median of the reprojection errors in pixels, and the share below half a pixel.
void camera_residual(const camera *c, const camera_point *points, size_t count, double *median, double *share);

#endif
