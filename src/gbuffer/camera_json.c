// The camera from a JSON file.
#include <json-c/json.h>
#include <string.h>

#include "gbuffer/camera.h"

typedef struct source {
    const char *path;
    struct json_object *root;
    error *e;
} source;

static bool refuse(const source *s, const char *what) { return err_set(s->e, ERR_USAGE, s->path, NULL, "%s", what); }

static bool number(struct json_object *o, double *out)
{
    if (!json_object_is_type(o, json_type_double) && !json_object_is_type(o, json_type_int)) return false;
    *out = json_object_get_double(o);
    return isfinite(*out);
}

static bool numbers(struct json_object *array, size_t count, double *out)
{
    if (!json_object_is_type(array, json_type_array) || json_object_array_length(array) != count) return false;
    for (size_t i = 0; i < count; i++)
        if (!number(json_object_array_get_idx(array, i), &out[i])) return false;
    return true;
}

static bool orthonormal(const double m[4][4])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j <= i; j++) {
            double dot = m[0][i] * m[0][j] + m[1][i] * m[1][j] + m[2][i] * m[2][j];
            if (!(fabs(dot - (i == j ? 1.0 : 0.0)) < 1e-3)) return false;
        }
    return true;
}

// Blender's and OpenGL's camera axes (y up, z backwards) to ours (y down, z forward).
static bool read_pose(const source *s, camera *out)
{
    static const char what[] =
        "\"world_from_camera\" must be four rows of four numbers: a rotation and a position, without scale";
    struct json_object *rows;
    double m[4][4];
    if (!json_object_object_get_ex(s->root, "world_from_camera", &rows)) return true;
    if (!json_object_is_type(rows, json_type_array) || json_object_array_length(rows) != 4) return refuse(s, what);
    for (size_t r = 0; r < 4; r++)
        if (!numbers(json_object_array_get_idx(rows, r), 4, m[r])) return refuse(s, what);
    if (!orthonormal(m)) return refuse(s, what);
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
        if (!number(fov, v) || !(v[0] > 0.0 && v[0] < 180.0)) return refuse(s, "\"fov\" must be between 0 and 180 degrees");
        camera_from_fov(v[0], data, display, pixel_aspect, out);
    } else if (has_ortho) {
        if (!number(ortho, v) || !(v[0] > 0.0)) return refuse(s, "\"ortho_width\" must be a positive number of scene units");
        camera_from_ortho(v[0], data, display, pixel_aspect, out);
    } else {
        if (!numbers(focal, 2, v) || !(v[0] > 0.0 && v[1] > 0.0)) return refuse(s, "\"focal_px\" must be two positive numbers");
        camera_from_fov(90.0, data, display, pixel_aspect, out);
        out->fx = v[0], out->fy = v[1];
    }
    struct json_object *principal;
    if (json_object_object_get_ex(s->root, "principal", &principal)) {
        if (!numbers(principal, 2, v)) return refuse(s, "\"principal\" must be two numbers");
        out->cx = v[0] + display.x0 - data.x0, out->cy = v[1] + display.y0 - data.y0;
    }
    return true;
}

bool camera_from_json(const char *path, box2 data, box2 display, double pixel_aspect, camera *out, error *e)
{
    source s = {.path = path, .root = json_object_from_file(path), .e = e};
    if (!s.root) {
        const char *why = json_util_get_last_err(); // ends in a newline
        int length = why ? (int)strcspn(why, "\n") : 0;
        return err_set(e, ERR_USAGE, path, NULL, "the camera file cannot be read as JSON%s%.*s", why ? ": " : "",
                       length < 200 ? length : 200, why ? why : "");
    }
    bool good = json_object_is_type(s.root, json_type_object) || refuse(&s, "the camera file must hold one JSON object");
    good = good && read_lens(&s, data, display, pixel_aspect, out) && read_pose(&s, out);
    json_object_put(s.root);
    return good;
}
