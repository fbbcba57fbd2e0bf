#include "gbuffer/camera.h"

#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/camera_solve.h"
#include "gbuffer/solve.h"

static const double pi = 3.14159265358979323846;

double camera_point_error(const camera *c, const camera_point *point)
{
    double x, y;
    if (!camera_project(c, camera_from_world(c, point->world), &x, &y)) return 1e30;
    x -= point->x, y -= point->y;
    double distance = sqrt(x * x + y * y);
    return distance < 1e30 ? distance : 1e30;
}

void camera_residual(const camera *c, const camera_point *points, size_t count, double *median, double *share)
{
    *median = -1.0;
    *share = 0.0;
    if (count == 0) return;
    error ignored = {0};
    double *errors = mem_pixels(count, sizeof *errors, &ignored);
    if (!errors) return;
    size_t near = 0;
    for (size_t i = 0; i < count; i++) {
        errors[i] = camera_point_error(c, &points[i]);
        near += errors[i] < 0.5;
    }
    *median = solve_median(errors, count);
    *share = (double)near / (double)count;
    free(errors);
}

void camera_move_back(camera *c, double lowest, double highest)
{
    double margin = fmax(0.05 * (highest - lowest), 1.0 / c->fx);
    double back = margin - lowest;
    mat3 r = c->world_from_camera;
    c->origin = v3_sub(c->origin, v3_scale(v3(r.m[0][2], r.m[1][2], r.m[2][2]), back));
}

// The centre of the display window in pixels of the data window.
static void centred(box2 data, box2 display, camera *out)
{
    out->cx = (double)display.x0 - data.x0 + 0.5 * box2_width(display);
    out->cy = (double)display.y0 - data.y0 + 0.5 * box2_height(display);
    out->source = CAMERA_FROM_FLAG;
    out->world_from_camera = m3_identity();
    out->residual = -1.0;
}

void camera_from_fov(double fov_degrees, box2 data, box2 display, double pixel_aspect, camera *out)
{
    *out = (camera){.kind = CAMERA_PERSPECTIVE};
    centred(data, display, out);
    out->fx = 0.5 * box2_width(display) / tan(fov_degrees * pi / 360.0);
    out->fy = out->fx * pixel_aspect;
}

void camera_from_ortho(double width, box2 data, box2 display, double pixel_aspect, camera *out)
{
    *out = (camera){.kind = CAMERA_ORTHOGRAPHIC};
    centred(data, display, out);
    out->fx = box2_width(display) / width;
    out->fy = out->fx * pixel_aspect;
}
