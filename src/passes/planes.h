// The large planes of a frame, which stand in for what the camera does not see of them (shaders/README.md, Planes).
//
// Found on the CPU from depth and normals: every hypothesis is one surface sample's own tangent plane (so one point suffices, and
// no random triple is wasted), scored on a few thousand evenly spaced samples, refined by least squares. Deterministic: the same
// gbuffer gives the same planes.
#ifndef SSDO_PASSES_PLANES_H
#define SSDO_PASSES_PLANES_H

#include "gbuffer/gbuffer.h"

enum { PLANES_MAX = 12, PLANE_CELLS = 16 };

// normal . x = offset in camera space; the normal is unit and faces the eye. The support is the rectangle of least area that
// holds all samples: |axis[i] . x - centre[i]| <= half[i], the axes unit and perpendicular to the normal. It is divided into
// PLANE_CELLS x PLANE_CELLS cells; bit x of row y says that the picture does not show the plane to be absent there (a hole, the
// corner beside a disc).
typedef struct plane {
    vec3 normal, axis[2];
    double offset, centre[2], half[2];
    double share; // of the frame's surfaces
    double room;  // how far off its plane a surface may lie: times its depth, with an orthographic camera a length
    unsigned short cells[PLANE_CELLS];
} plane;

typedef struct plane_set {
    plane planes[PLANES_MAX + 1];
    int count, uneven; // planes[count] is uneven ground if uneven is 1
    bool found;        // looked for
    double samples;    // surface samples that were looked at
} plane_set;

// Largest first, each holding at least 2 % of the surfaces. Of what they leave, uneven ground: what lies within 5 % of its depth
// of one plane and within 37 degrees of its normal, if that is a fifth of the surfaces.
bool planes_find(const gbuffer *gb, plane_set *out, error *e);

#endif
