// The camera from a JSON file.
#include <json-c/json.h>
#include <math.h>

#include "base/json_read.h"
#include "gbuffer/camera.h"

typedef struct source {
    const char *path;
    struct json_object *root;
    error *e;
} source;

static bool refuse(const source *s, const char *what) { return err_set(s->e, ERR_USAGE, s->path, NULL, "%s", what); }

// A mirror image of the scene has such axes too; only the determinant tells.
static bool is_rotation(double m[4][4])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j <= i; j++) {
            double dot = m[0][i] * m[0][j] + m[1][i] * m[1][j] + m[2][i] * m[2][j];
            if (!(fabs(dot - (i == j ? 1.0 : 0.0)) < 1e-3)) return false;
        }
    mat3 axes;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) axes.m[r][c] = m[r][c];
    return m3_det(axes) > 0.0;
}

// Blender's and OpenGL's camera axes (y up, z backwards) to ours (y down, z forward).
static bool read_pose(const source *s, camera *out)
{
    static const char what[] =
        "\"world_from_camera\" must be four rows of four numbers: a rotation and a position, without scale or "
        "mirroring, and 0 0 0 1";
    struct json_object *rows;
    double m[4][4];
    if (!json_object_object_get_ex(s->root, "world_from_camera", &rows)) return true;
    if (!json_object_is_type(rows, json_type_array) || json_object_array_length(rows) != 4) return refuse(s, what);
    for (size_t r = 0; r < 4; r++)
        if (!json_read_numbers(json_object_array_get_idx(rows, r), 4, m[r])) return refuse(s, what);
    if (m[3][0] != 0.0 || m[3][1] != 0.0 || m[3][2] != 0.0 || m[3][3] != 1.0) return refuse(s, what);
    if (!is_rotation(m)) return refuse(s, what);
    for (int r = 0; r < 3; r++) {
        out->world_from_camera.m[r][0] = m[r][0];
        out->world_from_camera.m[r][1] = -m[r][1];
        out->world_from_camera.m[r][2] = -m[r][2];
    }
    out->origin = v3(m[0][3], m[1][3], m[2][3]);
    out->has_world = true;
    return true;
}

static bool read_lens(const source *s, box2 data, box2 display, double pixel_aspect, camera *out)
{
    struct json_object *fov, *focal, *ortho;
    bool has_fov = json_object_object_get_ex(s->root, "fov", &fov);
    bool has_focal = json_object_object_get_ex(s->root, "focal_px", &focal);
    bool has_ortho = json_object_object_get_ex(s->root, "ortho_width", &ortho);
    if (has_fov + has_focal + has_ortho != 1)
        return refuse(s, "a camera file holds exactly one of \"fov\", \"focal_px\" and \"ortho_width\"");
    double v[2];
    if (has_fov) {
        if (!json_read_number(fov, v) || !(v[0] > 0.0 && v[0] < 180.0))
            return refuse(s, "\"fov\" must be between 0 and 180 degrees");
        camera_from_fov(v[0], data, display, pixel_aspect, out);
    } else if (has_ortho) {
        if (!json_read_number(ortho, v) || !(v[0] > 0.0))
            return refuse(s, "\"ortho_width\" must be a positive number of scene units");
        camera_from_ortho(v[0], data, display, pixel_aspect, out);
    } else {
        if (!json_read_numbers(focal, 2, v) || !(v[0] > 0.0 && v[1] > 0.0))
            return refuse(s, "\"focal_px\" must be two positive numbers");
        camera_from_fov(90.0, data, display, pixel_aspect, out);
        out->fx = v[0], out->fy = v[1];
    }
    struct json_object *principal;
    if (json_object_object_get_ex(s->root, "principal", &principal)) {
        if (!json_read_numbers(principal, 2, v)) return refuse(s, "\"principal\" must be two numbers");
        out->cx = v[0] + display.x0 - data.x0, out->cy = v[1] + display.y0 - data.y0;
    }
    return true;
}

bool camera_from_json(const char *path, box2 data, box2 display, double pixel_aspect, camera *out, error *e)
{
    source s = {.path = path, .root = json_read_object(path, "the camera file", e), .e = e};
    if (!s.root) return false;
    bool good = read_lens(&s, data, display, pixel_aspect, out) && read_pose(&s, out);
    json_object_put(s.root);
    return good;
}
