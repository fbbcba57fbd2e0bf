#include "gbuffer/camera_header.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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

// A number, or a text that begins with one.
bool camera_number(const exrio_file *file, int part, const char *name, double *value)
{
    const char *text;
    part = exrio_attr_part(file, part, name);
    if (exrio_attr_float(file, part, name, value)) return isfinite(*value);
    if (!exrio_attr_string(file, part, name, &text)) return false;
    char *end;
    *value = strtod(text, &end); // main() keeps the C locale for numbers
    return end != text && isfinite(*value);
}

bool camera_from_lens(const exrio_file *file, int part, const header_camera *where, box2 data, box2 display, double pixel_aspect,
                      camera *out)
{
    double fov;
    if (!file->core || !where->fov || !camera_number(file, part, where->fov, &fov)) return false;
    if (where->radians) fov *= 57.295779513082320877;
    if (!(fov > 0.0 && fov < 180.0)) return false;
    camera_from_fov(fov, data, display, pixel_aspect, out);
    out->source = CAMERA_FROM_HEADER;
    return true;
}

// "beginning" + "Rot/yaw" and so on, "Pos/x" and so on. Unreal's rotator: x forward, y right, z up, left-handed; yaw about z,
// then pitch up, then roll clockwise. The columns made here are right, up, forward.
static bool pose_from_angles(const exrio_file *file, int part, const char *beginning, header_pose *out)
{
    static const char *const names[6] = {"Rot/yaw", "Rot/pitch", "Rot/roll", "Pos/x", "Pos/y", "Pos/z"};
    double v[6];
    for (int i = 0; i < 6; i++) {
        char name[128];
        snprintf(name, sizeof name, "%s%s", beginning, names[i]);
        if (!camera_number(file, part, name, &v[i])) return false;
        if (i < 3) v[i] *= 0.017453292519943295769;
    }
    double cy = cos(v[0]), sy = sin(v[0]), cp = cos(v[1]), sp = sin(v[1]), cr = cos(v[2]), sr = sin(v[2]);
    out->axes = (mat3){{{sr * sp * cy - cr * sy, -(cr * sp * cy + sr * sy), cp * cy},
                        {sr * sp * sy + cr * cy, cy * sr - cr * sp * sy, cp * sy},
                        {-sr * cp, cr * cp, sp}}};
    out->eye = out->inverse_eye = v3(v[3], v[4], v[5]);
    return true;
}

static bool pose_from_matrix(const exrio_file *file, int part, const header_camera *where, header_pose *out)
{
    double m[4][4];
    if (!where->pose || !exrio_attr_m44(file, exrio_attr_part(file, part, where->pose), where->pose, m)) return false;
    mat3 r = {{{m[0][0], m[0][1], m[0][2]}, {m[1][0], m[1][1], m[1][2]}, {m[2][0], m[2][1], m[2][2]}}};
    vec3 t = v3(m[3][0], m[3][1], m[3][2]), inverse = v3_scale(m3_apply(r, t), -1.0);
    out->axes = where->world_to_camera ? r : m3_transpose(r);
    out->eye = where->world_to_camera ? inverse : t;
    out->inverse_eye = where->world_to_camera ? t : inverse;
    return true;
}

static bool make_orthonormal(mat3 *m)
{
    vec3 columns[3];
    for (int c = 0; c < 3; c++) {
        columns[c] = v3_normalize(v3(m->m[0][c], m->m[1][c], m->m[2][c]));
        if (!(v3_dot(columns[c], columns[c]) > 0.5)) return false;
        m->m[0][c] = columns[c].x, m->m[1][c] = columns[c].y, m->m[2][c] = columns[c].z;
    }
    return fabs(v3_dot(columns[0], columns[1])) < 1e-3 && fabs(v3_dot(columns[1], columns[2])) < 1e-3 &&
           fabs(v3_dot(columns[2], columns[0])) < 1e-3;
}

bool camera_header_pose(const exrio_file *file, int part, const header_camera *where, header_pose *out)
{
    static const header_camera standard = {.pose = "worldToCamera", .world_to_camera = true, .looks_along_z = true};
    if (!file->core) return false;
    bool along = where->looks_along_z || where->angles;
    bool found = (where->angles && pose_from_angles(file, part, where->angles, out)) || pose_from_matrix(file, part, where, out);
    if (!found && pose_from_matrix(file, part, &standard, out)) found = along = true;
    out->from_ours = (mat3){{{1, 0, 0}, {0, -1, 0}, {0, 0, along ? 1 : -1}}};
    return found && make_orthonormal(&out->axes) && v3_finite(out->eye);
}
