// The camera in the header's worldToNDC matrix. Internal to the room.
#ifndef SSDO_GBUFFER_CAMERA_HEADER_H
#define SSDO_GBUFFER_CAMERA_HEADER_H

#include "gbuffer/camera.h"

// m: worldToNDC as stored (row vectors). Renderers differ (facts/ecosystem.md 1.2): 0..1 with y down, the standard's; -1..1 with
// y up; w = -z; transposed; mirrored. With points, the reading that puts them at their pixels is taken, and none is if the median
// error stays above half a pixel. Without points only the first two readings are tried, and the one whose principal point lies
// nearest the centre of the display window is taken, if that is within a quarter of its width. Its lens can be relied on then;
// its pose only if it makes a right-handed world, else has_world is false: a negated and a mirrored matrix look alike without
// points.
bool camera_from_ndc(double m[4][4], box2 data, box2 display, const camera_point *points, size_t count, camera *out);

#endif
