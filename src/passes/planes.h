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
// holds all samples: |axis[i] . x - centre[i]| <= extent[i], the axes unit and perpendicular to the normal. It is divided into
// PLANE_CELLS x PLANE_CELLS cells. Bit x of row y is clear where the picture shows that the plane is absent (a hole, the corner
// beside a disc).
typedef struct plane {
    vec3 normal, axis[2];
    double offset, centre[2], extent[2];
    double share;  // of the frame's surfaces
    double belief; // 0 .. 1; the plane blocks this share of the directions that it meets
    double margin; // how far off the plane a surface may lie: a share of its depth; with an orthographic camera a length
    unsigned short cells[PLANE_CELLS];
} plane;

typedef struct plane_set {
    plane planes[PLANES_MAX + 1];
    int count, uneven; // planes[count] is uneven ground if uneven is 1
    bool found;        // looked for
    double samples;    // surface samples that were looked at
} plane_set;

// Finds the planes, largest first. Then looks for uneven ground among the other surfaces: those within 5 % of their depth of one
// plane and within 37 degrees of its normal. Belief in a plane is none at 1.25 % of the surfaces and full at 3 % (uneven ground:
// 20 and 30 %), and less where the picture shows other surfaces through it. Planes without belief are left out.
bool planes_find(const gbuffer *gb, plane_set *out, error *e);

#endif
