// The parts camera_fit and camera_fit_plane are made of. Internal to the room.
#ifndef SSDO_GBUFFER_CAMERA_SOLVE_H
#define SSDO_GBUFFER_CAMERA_SOLVE_H

#include "gbuffer/camera.h"

// A 3x4 matrix from (world, 1) to homogeneous data-window pixels; the last row is (0,0,0,1) for an orthographic camera. For a
// perspective one it is known up to a positive factor: the third component is positive in front of the eye.
typedef struct projection {
    camera_kind kind;
    double m[3][4];
} projection;

// Weighted linear fit. Perspective: the normalised DLT (Hartley and Zisserman 2004, 7.1), with each homogeneous point at unit
// length, so that far points do not outweigh near ones. Orthographic: affine least squares. Perspective weights refer to squared
// pixels: `previous` (or NULL) gives the depths that turn the algebraic error into pixels. False when the points leave the matrix
// undetermined.
bool projection_fit(camera_kind kind, const camera_point *points, const double *weights, size_t count, const projection *previous,
                    projection *out);

// Distance in pixels between the point's projection and where it was seen; 1e30 for a point behind the eye or not finite.
double projection_error(const projection *p, const camera_point *point);

// Intrinsics and pose (Gram-Schmidt from the last row up); skew is dropped. False when it is no camera.
bool projection_to_camera(const projection *p, camera *out);

// Reprojection error of a point in pixels; 1e30 behind the eye.
double camera_point_error(const camera *c, const camera_point *point);

// What camera_refine may change.
enum camera_free {
    FREE_FX = 1 << 0,
    FREE_FY = 1 << 1,
    FREE_F_TIED = 1 << 2, // fx and fy by one common factor
    FREE_CENTRE = 1 << 3,
    FREE_POSE = 1 << 4,
};

// Levenberg-Marquardt on the weighted squared reprojection error, plus, where planar_depth is given, the squared error of z
// expressed in pixels (relative error times the focal length; orthographic: error times pixels per unit, up to a common offset,
// which the origin takes up). *focal_spread (may be NULL) receives the relative standard deviation of fx for an error of one
// pixel a point: infinite where the points leave it open.
bool camera_refine(camera *c, const camera_point *points, const double *planar_depth, const double *weights, size_t count,
                   unsigned free_mask, double *focal_spread);

// Moves the origin of an orthographic camera back along its axis until the nearest of the z values lies at a twentieth of their
// range (at least a pixel) in front of it. lowest, highest: camera-space z with the origin as it is.
void camera_move_back(camera *c, double lowest, double highest);

#endif
