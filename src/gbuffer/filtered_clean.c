// Which pixels of a filtered pass show one surface alone: the normal has its length, alpha is 1, and along each axis at least one
// neighbour continues the surface. Depths and lengths tell it of nearly all pixels. Only where they do not, normals are asked.
#include "base/threads.h"
#include "gbuffer/filtered.h"

static const float least[2] = {0.98f * 0.98f, 0.99f * 0.99f}; // squared lengths of a neighbour's normal, and of a pixel's own
static const float most[2] = {1.02f * 1.02f, 1.01f * 1.01f};
static const float odd_alpha = 0.01f;
static const double off_tangent = 0.05; // of the step between neighbours
static const float most_bend = 0.5f;    // second difference of depth over a pixel's size at that depth

static void square_lengths(const build *b, int x, int y, int count, float *out)
{
    float v[3][PLANE_BLOCK] = {{0}};
    const normal_encoding e = b->normal.encoding;
    for (int c = 0; c < 3; c++) plane_fetch(&b->normal.n[c], x, y, count, v[c]);
    const float scale = e == NORMAL_SIGNED ? 1.0f : 2.0f, offset = e == NORMAL_SIGNED ? 0.0f : 1.0f;
    for (int k = 0; k < count && e <= NORMAL_UNORM; k++) {
        float a = scale * v[0][k] - offset, c = scale * v[1][k] - offset, d = scale * v[2][k] - offset;
        out[k] = a * a + c * c + d * d;
    }
    for (int k = 0; k < count && e > NORMAL_UNORM; k++) {
        vec3 n = encoding_decode(e, v3((double)v[0][k], (double)v[1][k], (double)v[2][k]));
        out[k] = (float)v3_dot(n, n);
    }
}

static bool look_at_row(void *context, size_t row, int worker)
{
    (void)worker;
    const repair *r = context;
    const build *b = r->b;
    const int y = (int)row, width = b->g->width;
    for (int x = 0; x < width; x += PLANE_BLOCK) {
        float length[PLANE_BLOCK], alpha[PLANE_BLOCK];
        const int count = width - x < PLANE_BLOCK ? width - x : PLANE_BLOCK;
        const float *depth = b->g->depth + build_index(b, x, y);
        uint8_t *state = r->state + build_index(b, x, y);
        for (int k = 0; k < count; k++) length[k] = alpha[k] = 1.0f;
        if (r->lengths) square_lengths(b, x, y, count, length);
        if (b->alpha.data) plane_fetch(&b->alpha, x, y, count, alpha);
        for (int k = 0; k < count; k++) {
            const int nearly = length[k] >= least[0] && length[k] <= most[0];
            const int whole =
                length[k] >= least[1] && length[k] <= most[1] && depth[k] > 0.0f && fabsf(alpha[k] - 1.0f) <= odd_alpha;
            state[k] = (uint8_t)(nearly * PIXEL_NEARLY | whole * PIXEL_WHOLE);
        }
    }
    return true;
}

// Whether the neighbour continues the surface by normals: the line between them is perpendicular to the mean of both.
static bool by_normals(const repair *r, const stored *here, int x, int y, int dx, int dy)
{
    const build *b = r->b;
    if (!filtered_inside(b, x + dx, y + dy) || !(r->state[build_index(b, x + dx, y + dy)] & PIXEL_NEARLY)) return false;
    stored beside = filtered_read(r, x + dx, y + dy);
    vec3 next = filtered_place(r, &beside, x + dx, y + dy), step = v3_sub(next, filtered_place(r, here, x, y));
    return next.z > 0.0 && fabs(v3_dot(v3_add(here->n, beside.n), step)) < 2.0 * off_tangent * v3_length(step);
}

// Or, because a bump map may have changed the normals: the line through the neighbour and the pixel beyond it leads to the pixel.
static bool in_line(const repair *r, int x, int y, int dx, int dy, float limit)
{
    const build *b = r->b;
    if (!filtered_inside(b, x + 2 * dx, y + 2 * dy)) return false;
    const size_t i = build_index(b, x, y), next = build_index(b, x + dx, y + dy), beyond = build_index(b, x + 2 * dx, y + 2 * dy);
    const float *z = b->position.raw;
    return z[next] > 0.0f && z[beyond] > 0.0f && r->state[next] & PIXEL_NEARLY &&
           fabsf(z[i] - 2.0f * z[next] + z[beyond]) < limit;
}

static bool is_clean(const repair *r, int x, int y)
{
    const build *b = r->b;
    const camera *c = &b->g->camera;
    const size_t i = build_index(b, x, y);
    const float z = b->position.raw[i], limit = most_bend * (c->kind == CAMERA_PERSPECTIVE ? z : 1.0f) / (float)c->fx;
    if (!(r->state[i] & PIXEL_WHOLE) || !(z > 0.0f)) return false;
    bool across = in_line(r, x, y, -1, 0, limit) || in_line(r, x, y, 1, 0, limit);
    bool down = in_line(r, x, y, 0, -1, limit) || in_line(r, x, y, 0, 1, limit);
    if ((across && down) || !r->lengths) return across && down;
    stored s = filtered_read(r, x, y);
    across = across || by_normals(r, &s, x, y, -1, 0) || by_normals(r, &s, x, y, 1, 0);
    return across && (down || by_normals(r, &s, x, y, 0, -1) || by_normals(r, &s, x, y, 0, 1));
}

static bool settle_row(void *context, size_t row, int worker)
{
    (void)worker;
    const repair *r = context;
    const int y = (int)row;
    for (int x = 0; x < r->b->g->width; x++)
        if (is_clean(r, x, y)) r->state[build_index(r->b, x, y)] |= PIXEL_CLEAN;
    return true;
}

void filtered_find_clean(repair *r)
{
    threads_for(r->b->options->threads, (size_t)r->b->g->height, look_at_row, r);
    threads_for(r->b->options->threads, (size_t)r->b->g->height, settle_row, r);
}
