#include "gbuffer/camera_header.h"

#include "gbuffer/camera_solve.h"

static const double most_error = 0.5; // pixels

// The projection for one reading. reading: bit 0 transposed, bit 1 -1..1 instead of 0..1, bit 2 y the other way, bit 3 x the
// other way, bit 4 the whole matrix negated (w = -z).
static projection read_as(double m[4][4], int reading, box2 data, box2 display)
{
    projection p = {.kind = CAMERA_PERSPECTIVE};
    double width = box2_width(display), height = box2_height(display);
    for (int c = 0; c < 4; c++) {
        double x = reading & 1 ? m[0][c] : m[c][0], y = reading & 1 ? m[1][c] : m[c][1], w = reading & 1 ? m[3][c] : m[c][3];
        if (reading & 2) x = 0.5 * (x + w), y = 0.5 * (w - y);
        if (reading & 4) y = w - y;
        if (reading & 8) x = w - x;
        p.m[0][c] = width * x + (display.x0 - data.x0) * w;
        p.m[1][c] = height * y + (display.y0 - data.y0) * w;
        p.m[2][c] = w;
    }
    double in_w = fabs(p.m[2][0]) + fabs(p.m[2][1]) + fabs(p.m[2][2]);
    if (in_w <= 1e-9 * fabs(p.m[2][3])) {
        for (int r = 0; r < 2; r++)
            for (int c = 0; c < 4; c++) p.m[r][c] /= p.m[2][3];
        p.kind = CAMERA_ORTHOGRAPHIC;
        p.m[2][0] = p.m[2][1] = p.m[2][2] = 0.0, p.m[2][3] = 1.0;
    } else if (reading & 16) {
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 4; c++) p.m[r][c] = -p.m[r][c];
    }
    return p;
}

// Distance of the principal point from the centre of the display window, pixels.
static double off_centre(const camera *c, box2 data, box2 display)
{
    double x = display.x0 - data.x0 + 0.5 * box2_width(display), y = display.y0 - data.y0 + 0.5 * box2_height(display);
    return hypot(c->cx - x, c->cy - y);
}

bool camera_from_ndc(double m[4][4], box2 data, box2 display, const camera_point *points, size_t count, camera *out)
{
    double best = count ? most_error : 0.25 * box2_width(display);
    bool found = false;
    for (int reading = 0; reading < 32; reading++) {
        if (count == 0 && reading != 0 && reading != 2) continue;
        projection p = read_as(m, reading, data, display);
        camera c;
        if (!projection_to_camera(&p, &c)) continue;
        c.source = CAMERA_FROM_HEADER;
        double measure;
        if (count)
            camera_residual(&c, points, count, &measure, &c.inliers), c.residual = measure;
        else
            measure = off_centre(&c, data, display);
        if (measure >= 0.0 && measure < best) best = measure, *out = c, found = true;
    }
    if (found && count == 0 && m3_det(out->world_from_camera) < 0.0) {
        out->has_world = false;
        out->world_from_camera = m3_identity(), out->origin = v3(0, 0, 0);
    }
    return found;
}
