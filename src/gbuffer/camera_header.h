// The camera in the header's worldToNDC matrix. Internal to the room.
#ifndef SSDO_GBUFFER_CAMERA_HEADER_H
#define SSDO_GBUFFER_CAMERA_HEADER_H

#include "gbuffer/camera.h"

// m: worldToNDC as stored (row vectors). Renderers differ (facts/ecosystem.md 1.2): 0..1 with y down, the standard's; -1..1 with
// y up; w = -z; transposed. With points, the reading that puts them at their pixels is taken, and none is if the median error
// stays above half a pixel. Without points, the reading with the principal point nearest the centre of the display window and a
// right-handed world is taken, if the point lies within a quarter of the window's width of it.
bool camera_from_ndc(double m[4][4], box2 data, box2 display, const camera_point *points, size_t count, camera *out);

#endif
