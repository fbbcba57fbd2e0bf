// Planar depth of every pixel, in double until the camera is subtracted.
#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/build.h"
#include "gbuffer/camera_solve.h"

static const double on_ray = 0.02;     // pixels: nearer than this to its own centre, P stays as it is
static const double grazing = 0.01;    // cosine between ray and plane below which the plane says too little about depth
static const double bump = 0.1;        // and below which a shading normal is believed only if the surface lies so too
static const double same_depth = 0.02; // relative

// Z as planar depth at a pixel. The caller has checked that there is a depth.
static double depth_from_channel(const build *b, int x, int y)
{
    double z = build_depth(b, x, y);
    const camera *c = &b->g->camera;
    if (c->kind == CAMERA_ORTHOGRAPHIC) return z + b->position.z_offset;
    return b->g->depth_kind == DEPTH_RADIAL ? z / v3_length(build_ray(c, x, y)) : z;
}

// P in camera space; with depth_wins its distance is the depth channel's (which was sampled where P was, not at the centre).
static vec3 sampled(const build *b, int x, int y)
{
    vec3 p = camera_from_world(&b->g->camera, build_position(b, x, y));
    if (!b->position.z_wins) return p;
    const camera *c = &b->g->camera;
    double z = build_depth(b, x, y);
    if (c->kind == CAMERA_ORTHOGRAPHIC) return v3(p.x, p.y, z + b->position.z_offset);
    double length = b->g->depth_kind == DEPTH_RADIAL ? v3_length(p) : p.z;
    return v3_scale(p, z / length);
}

static double pixels_off(const build *b, vec3 p, int x, int y)
{
    double px, py;
    if (!camera_project(&b->g->camera, p, &px, &py)) return INFINITY;
    px -= x + 0.5, py -= y + 0.5;
    return sqrt(px * px + py * py);
}

// P = (0,0,0) is a place like any other when the depth channel says the surface is there.
static bool origin_is_surface(const build *b, int x, int y)
{
    if (!b->position.z_measured || !b->camera.has_pose) return false;
    vec3 p = camera_from_world(&b->g->camera, v3(0, 0, 0));
    return fabs(depth_from_channel(b, x, y) - p.z) < same_depth * p.z && pixels_off(b, p, x, y) < 2.0;
}

// Whether depth comes from where P was sampled, which need not be its pixel's centre.
static bool depth_is_of_p(const build *b) { return b->position.has_p && (!b->position.z_wins || b->position.lateral); }

static void raw_row(build *b, int y)
{
    const bool from_p = depth_is_of_p(b);
    for (int x = 0; x < b->g->width; x++) {
        size_t i = build_index(b, x, y);
        b->position.raw[i] = 0.0f;
        if (b->surface[i] == SURFACE_ORIGIN) b->surface[i] = origin_is_surface(b, x, y) ? SURFACE_YES : SURFACE_NONE;
        if (b->surface[i] != SURFACE_YES) continue;
        vec3 p = from_p ? sampled(b, x, y) : v3(0, 0, 0);
        double z = from_p ? p.z : depth_from_channel(b, x, y);
        if (!(z > 0.0) && b->position.z_measured) z = depth_from_channel(b, x, y); // a bad P behind the eye
        float as_float = (float)z;
        if (!(as_float > 0.0f && isfinite(as_float))) {
            b->surface[i] = SURFACE_NONE;
            continue;
        }
        b->position.raw[i] = as_float;
        if (!from_p || pixels_off(b, p, x, y) <= on_ray) b->surface[i] = SURFACE_SETTLED;
    }
}

// The nearest and farthest surface along an orthographic camera's axis decide where its origin goes.
static void settle_origin(build *b)
{
    camera *c = &b->g->camera;
    if (c->kind != CAMERA_ORTHOGRAPHIC || !b->position.has_p) return;
    double low = INFINITY, high = -INFINITY;
    for (int y = 0; y < b->g->height; y++)
        for (int x = 0; x < b->g->width; x++) {
            if (b->surface[build_index(b, x, y)] != SURFACE_YES) continue;
            double z = camera_from_world(c, build_position(b, x, y)).z;
            low = fmin(low, z), high = fmax(high, z);
        }
    if (low <= high) camera_move_back(c, low, high);
}

bool positions_raw(build *b)
{
    b->position.raw = mem_pixels((size_t)b->g->width * (size_t)b->g->height, sizeof *b->position.raw, b->e);
    if (!b->position.raw) return false;
    settle_origin(b);
    if (!measure_depth(b)) return false;
    build_rows(b, raw_row);
    return true;
}

// Whether the neighbours' depths allow depth z. They are compared as values that are linear across a plane's picture. A pixel
// moves by less than a pixel, so its depth stays near the range of its neighbours: beyond it by at most half that range, at the
// frame's border by at most all of it. A larger change means an edge, or a shading normal that is not the surface's.
static bool neighbours_allow(const build *b, int x, int y, double z)
{
    bool inverse = b->g->camera.kind == CAMERA_PERSPECTIVE;
    double low = INFINITY, high = -INFINITY, at = inverse ? 1.0 / z : z;
    for (int v = y - 1; v <= y + 1; v++)
        for (int u = x - 1; u <= x + 1; u++) {
            if (u < 0 || v < 0 || u >= b->g->width || v >= b->g->height) continue;
            double d = (double)b->position.raw[build_index(b, u, v)];
            if (d > 0.0) low = fmin(low, inverse ? 1.0 / d : d), high = fmax(high, inverse ? 1.0 / d : d);
        }
    bool border = x == 0 || y == 0 || x == b->g->width - 1 || y == b->g->height - 1;
    double slack = (border ? 1.0 : 0.5) * (high - low) + 1e-6 * high;
    return at >= low - slack && at <= high + slack;
}

// Depth for a position far from its pixel: the depth channel's if its meaning is known; else P's own if a neighbour's is close;
// else none.
static double depth_of_stray(build *b, int x, int y)
{
    atomic_fetch_add(&b->defects.positions, 1);
    if (b->position.z_measured) return depth_from_channel(b, x, y);
    static const int step[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    double z = (double)b->position.raw[build_index(b, x, y)];
    for (int i = 0; i < 4; i++) {
        int u = x + step[i][0], v = y + step[i][1];
        if (u < 0 || v < 0 || u >= b->g->width || v >= b->g->height) continue;
        double d = (double)b->position.raw[build_index(b, u, v)];
        if (d > 0.0 && fabs(d - z) < same_depth * z) return z;
    }
    return 0.0;
}

// *moved: depth is where the plane through P meets the pixel's own ray.
static double final_depth(build *b, int x, int y, bool *moved)
{
    double z = (double)b->position.raw[build_index(b, x, y)];
    *moved = false;
    if (!(z > 0.0) || b->surface[build_index(b, x, y)] == SURFACE_SETTLED) return z;
    vec3 p = sampled(b, x, y);
    double off = pixels_off(b, p, x, y);
    if (!(off <= b->position.far_pixels)) return depth_of_stray(b, x, y);
    vec3 n, d = build_ray(&b->g->camera, x, y);
    if (!normals_read(b, x, y, &n)) n = normals_from_depth(b, b->position.raw, x, y);
    double cosine = v3_dot(n, d);
    if (fabs(cosine) < grazing * v3_length(d)) return z;
    if (fabs(cosine) < bump * v3_length(d) &&
        fabs(v3_dot(normals_from_depth(b, b->position.raw, x, y), d)) > 2.0 * bump * v3_length(d))
        return z;
    // Perspective: the ray starts at the eye. Orthographic: at the pixel's place on the plane z = 0.
    vec3 start = build_point(&b->g->camera, x, y, 0.0);
    double there = v3_dot(n, v3_sub(p, start)) / cosine;
    if (!(there > 0.0) || !neighbours_allow(b, x, y, there)) return z;
    *moved = true;
    return there;
}

static void final_row(build *b, int y)
{
    for (int x = 0; x < b->g->width; x++) {
        size_t i = build_index(b, x, y);
        bool moved;
        float z = (float)final_depth(b, x, y, &moved);
        b->g->depth[i] = z > 0.0f && isfinite(z) ? z : 0.0f;
        b->surface[i] = moved; // from here on the mask says which pixels were moved
    }
}

void positions_final(build *b)
{
    build_rows(b, final_row);
    size_t total = (size_t)b->g->width * (size_t)b->g->height;
    for (size_t i = 0; i < total; i++) {
        b->g->valid += b->g->depth[i] > 0.0f;
        b->g->off_ray += b->surface[i];
    }
    b->g->depth_from_position = b->position.has_p && !b->position.z_wins;
}
