// Unit camera-space normals, from the file or from depth.
#include "gbuffer/build.h"

// A normal this far (cosine) beyond the silhouette is still a shading normal's doing; further, the surface is seen from its back,
// unless the surface itself agrees with the normal.
static const double facing_away = 0.1;
// At the silhouette itself only a normal that is the surface's turned round is seen from its back.
static const double opposite = -0.5;

static vec3 stored(const build *b, int x, int y)
{
    return v3(plane_get(&b->normal.n[0], x, y), plane_get(&b->normal.n[1], x, y), plane_get(&b->normal.n[2], x, y));
}

double normals_length(const build *b, int x, int y)
{
    vec3 n = b->normal.there && b->normal.encoding == NORMAL_SIGNED ? stored(b, x, y) : v3(0, 0, 0);
    return v3_finite(n) ? v3_length(n) : 0.0;
}

vec3 normals_code(const build *b, int x, int y)
{
    vec3 v = b->normal.there ? stored(b, x, y) : v3(0, 0, 0);
    return v3_finite(v) ? v : v3(0, 0, 0);
}

vec3 normals_decode(const build *b, vec3 code)
{
    return b->normal.there ? m3_apply(b->normal.to_camera, encoding_decode(b->normal.encoding, code)) : v3(0, 0, 0);
}

// *square: of the length that v decodes to.
static bool read_stored(const build *b, vec3 v, vec3 *n, double *square)
{
    *square = 0.0;
    if (v3_length(v) > b->normal.longest) return false;
    v = encoding_decode(b->normal.encoding, v);
    *square = v3_dot(v, v);
    *n = v3_normalize(m3_apply(b->normal.to_camera, v));
    return v3_dot(*n, *n) > 0.5;
}

bool normals_read(const build *b, int x, int y, vec3 *n)
{
    double ignored;
    return b->normal.there && read_stored(b, stored(b, x, y), n, &ignored);
}

// On a plane 1/z is linear across a perspective picture, z across an orthographic one.
static double linear(const camera *c, double z) { return c->kind == CAMERA_PERSPECTIVE ? 1.0 / z : z; }

static double depth_at(const build *b, const float *depth, int x, int y)
{
    if (x < 0 || y < 0 || x >= b->g->width || y >= b->g->height) return 0.0;
    return (double)depth[build_index(b, x, y)];
}

// How badly the neighbour and the one after it predict this pixel; without the second, the plain difference, counted as worse.
static double disagreement(const build *b, const float *depth, int x, int y, int dx, int dy)
{
    const camera *c = &b->g->camera;
    double z0 = depth_at(b, depth, x, y), z1 = depth_at(b, depth, x + dx, y + dy),
           z2 = depth_at(b, depth, x + 2 * dx, y + 2 * dy);
    if (!(z1 > 0.0)) return INFINITY;
    if (!(z2 > 0.0)) return 1e6 * fabs(linear(c, z1) - linear(c, z0));
    return fabs(2.0 * linear(c, z1) - linear(c, z2) - linear(c, z0));
}

// The surface's direction along one axis: from both neighbours where both continue the surface about equally well, else from the
// better one.
static vec3 along(const build *b, const float *depth, int x, int y, int dx, int dy)
{
    const camera *c = &b->g->camera;
    double back = disagreement(b, depth, x, y, -dx, -dy), ahead = disagreement(b, depth, x, y, dx, dy);
    double z = depth_at(b, depth, x, y);
    vec3 here = build_point(c, x, y, z);
    if (isinf(back) && isinf(ahead)) return v3_sub(build_point(c, x + dx, y + dy, z), here);
    double rounding = 1e-6 * fabs(linear(c, z));
    bool use_back = back <= 3.0 * ahead + rounding, use_ahead = ahead <= 3.0 * back + rounding;
    vec3 p = use_back ? build_point(c, x - dx, y - dy, depth_at(b, depth, x - dx, y - dy)) : here;
    vec3 q = use_ahead ? build_point(c, x + dx, y + dy, depth_at(b, depth, x + dx, y + dy)) : here;
    return v3_sub(q, p);
}

vec3 normals_from_depth(const build *b, const float *depth, int x, int y)
{
    const camera *c = &b->g->camera;
    vec3 n = v3_normalize(v3_cross(along(b, depth, x, y, 1, 0), along(b, depth, x, y, 0, 1)));
    vec3 ray = build_ray(c, x, y);
    if (!(v3_dot(n, n) > 0.5)) return v3_scale(v3_normalize(ray), -1.0);
    return v3_dot(n, ray) > 0.0 ? v3_scale(n, -1.0) : n;
}

// v: as stored. *square: of the length that it decodes to.
static vec3 normal_of(build *b, int x, int y, vec3 v, double *square)
{
    vec3 n;
    if (!b->normal.there || !read_stored(b, v, &n, square)) {
        if (b->normal.there) atomic_fetch_add(&b->defects.normals, 1);
        return normals_from_depth(b, b->g->depth, x, y);
    }
    vec3 ray = build_ray(&b->g->camera, x, y);
    if (v3_dot(n, ray) < -1e-9 * (fabs(ray.x) + fabs(ray.y) + 1.0)) return n; // whatever rounding does
    ray = v3_normalize(ray);
    double away = v3_dot(n, ray);
    if (away <= 0.0) return n;
    double agrees = v3_dot(n, normals_from_depth(b, b->g->depth, x, y));
    return agrees < (away <= facing_away ? opposite : 0.0) ? v3_scale(n, -1.0) : n;
}

static uint8_t length_bits(double square)
{
    const bool nearly = square >= 0.98 * 0.98 && square <= 1.02 * 1.02, whole = square >= 0.99 * 0.99 && square <= 1.01 * 1.01;
    return (uint8_t)((nearly ? LENGTH_NEARLY : 0) | (whole ? LENGTH_WHOLE : 0));
}

static void make_block(build *b, int x, int y, int count)
{
    float v[3][PLANE_BLOCK] = {{0}};
    for (int c = 0; c < 3 && b->normal.there; c++) plane_fetch(&b->normal.n[c], x, y, count, v[c]);
    for (int k = 0; k < count; k++) {
        size_t i = build_index(b, x + k, y);
        double square = 0.0;
        vec3 n = v3(0, 0, 0), code = v3((double)v[0][k], (double)v[1][k], (double)v[2][k]);
        if (b->g->depth[i] > 0.0f) n = normal_of(b, x + k, y, code, &square);
        if (b->normal.lengths) b->normal.lengths[i] = length_bits(square);
        float *out = b->g->normal + 4 * i;
        out[0] = (float)n.x, out[1] = (float)n.y, out[2] = (float)n.z, out[3] = 0.0f;
    }
}

static void make_row(build *b, int y)
{
    const int width = b->g->width;
    for (int x = 0; x < width; x += PLANE_BLOCK) make_block(b, x, y, width - x < PLANE_BLOCK ? width - x : PLANE_BLOCK);
}

void normals_make(build *b)
{
    build_rows(b, make_row);
    b->g->normals_from_depth = !b->normal.there;
}
