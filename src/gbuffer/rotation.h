// Rotations between two sets of directions. Internal to the room.
#ifndef SSDO_GBUFFER_ROTATION_H
#define SSDO_GBUFFER_ROTATION_H

#include <stdbool.h>

#include "base/vec.h"

// Orthogonal Procrustes: the orthogonal matrix R of the wanted determinant (+1 or -1) that makes the sum of w target . (R source)
// largest, from the correlation = sum of w target source^T over a total weight of 1. *second receives the second singular value
// over the first: where it is small all directions lie on one line, and a turn about that line is open. False for a correlation
// without any direction.
bool rotation_between(mat3 correlation, double determinant, mat3 *rotation, double *second);

// The angle in degrees by which a rotation turns; 180 for a reflection.
double rotation_angle(mat3 r);

// The signed permutation of the axes nearest to an orthogonal matrix, and how many degrees it is away.
mat3 rotation_nearest_axes(mat3 r, double *degrees);

#endif
