// The camera in the header: worldToNDC, and the attributes of the convention table's rows. Internal to the room.
#ifndef SSDO_GBUFFER_CAMERA_HEADER_H
#define SSDO_GBUFFER_CAMERA_HEADER_H

#include "gbuffer/camera.h"
#include "gbuffer/conventions.h"

// m: worldToNDC as stored (row vectors). Renderers write it in different ways: 0..1 with y down (the standard's); -1..1 with y
// up; w = -z; transposed; mirrored. With points, the reading that puts them at their pixels is taken; none is taken if the median
// error stays above half a pixel. Without points, only the first two readings are tried. The one whose principal point lies
// nearest the centre of the display window is taken, if that distance is at most a quarter of the window's width. Its lens is
// then reliable. Its pose is reliable only if it makes a right-handed world, because without points a negated and a mirrored
// matrix look alike; otherwise has_world is false.
bool camera_from_ndc(double m[4][4], box2 data, box2 display, const camera_point *points, size_t count, camera *out);

// An attribute's number, finite: one, or a text that begins with one.
bool camera_number(const exrio_file *file, int part, const char *name, double *value);

// The lens of a row's field of view attribute; no pose. False when there is none or it is not between 0 and 180 degrees.
bool camera_from_lens(const exrio_file *file, int part, const header_camera *where, box2 data, box2 display, double pixel_aspect,
                      camera *out);

// The pose of a row, or else of worldToCamera.
typedef struct header_pose {
    mat3 axes;             // columns: the header camera's axes in the world, unit length
    mat3 from_ours;        // takes our camera axes to the header's, as the row says
    vec3 eye, inverse_eye; // in the world; if the matrix was the inverse of what the row says
} header_pose;

// False when there is none or it is no rotation or reflection.
bool camera_header_pose(const exrio_file *file, int part, const header_camera *where, header_pose *out);

#endif
