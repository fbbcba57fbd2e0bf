// Which pixels of a filtered pass show one surface alone: the normal has its length, alpha is 1, and along each axis at least one
// neighbour continues the surface. Depths and lengths tell it of nearly all pixels. Only where they do not, normals are asked.
#include "base/mem.h"
#include "base/threads.h"
#include "gbuffer/filtered.h"

static const float odd_alpha = 0.01f;
static const double off_tangent = 0.05; // of the step between neighbours
static const float most_bend = 0.5f;    // second difference of depth over a pixel's size at that depth

// A pixel is whole if its normal and its alpha are.
static bool look_at_row(void *context, size_t row, int worker)
{
    (void)worker;
    const repair *r = context;
    const build *b = r->b;
    const int y = (int)row, width = b->g->width, unasked = r->lengths ? 0 : LENGTH_NEARLY | LENGTH_WHOLE;
    for (int x = 0; x < width; x += PLANE_BLOCK) {
        float alpha[PLANE_BLOCK];
        const int count = width - x < PLANE_BLOCK ? width - x : PLANE_BLOCK;
        const float *depth = b->g->depth + build_index(b, x, y);
        uint8_t *state = r->state + build_index(b, x, y);
        const bool has_alpha = b->alpha.data;
        if (has_alpha) plane_fetch(&b->alpha, x, y, count, alpha);
        for (int k = 0; k < count; k++) {
            const bool opaque = !has_alpha || fabsf(alpha[k] - 1.0f) <= odd_alpha, there = depth[k] > 0.0f;
            const int known = state[k] | unasked;
            const bool whole = opaque && there && known & LENGTH_WHOLE, empty = !there && !(has_alpha && alpha[k] > 0.5f);
            state[k] = (uint8_t)(known | (whole ? PIXEL_WHOLE : 0) | (empty ? PIXEL_EMPTY : 0));
        }
    }
    return true;
}

// Whether the neighbour continues the surface by normals: the line between them is perpendicular to the mean of both.
static bool by_normals(const repair *r, const stored *here, int x, int y, int dx, int dy)
{
    const build *b = r->b;
    if (!filtered_inside(b, x + dx, y + dy) || !(r->state[build_index(b, x + dx, y + dy)] & LENGTH_NEARLY)) return false;
    stored beside = filtered_read(r, x + dx, y + dy);
    vec3 next = filtered_place(r, &beside, x + dx, y + dy), step = v3_sub(next, filtered_place(r, here, x, y));
    return next.z > 0.0 && fabs(v3_dot(v3_add(here->n, beside.n), step)) < 2.0 * off_tangent * v3_length(step);
}

// Or, because a bump map may have changed the normals: the line through the neighbour, a step of memory away, and the pixel
// beyond it leads to the pixel.
static inline bool leads_here(const float *z, const uint8_t *state, ptrdiff_t step, float limit)
{
    const float next = z[step], beyond = z[2 * step];
    return next > 0.0f && beyond > 0.0f && state[step] & LENGTH_NEARLY && fabsf(*z - 2.0f * next + beyond) < limit;
}

static bool in_line(const repair *r, int x, int y, int dx, int dy, float limit)
{
    const size_t i = build_index(r->b, x, y);
    return filtered_inside(r->b, x + 2 * dx, y + 2 * dy) &&
           leads_here(r->b->position.raw + i, r->state + i, dx + dy * (ptrdiff_t)r->b->g->width, limit);
}

static float limit_of(const camera *c, float z) { return most_bend * (c->kind == CAMERA_PERSPECTIVE ? z : 1.0f) / (float)c->fx; }

static bool is_clean(const repair *r, int x, int y)
{
    const build *b = r->b;
    const size_t i = build_index(b, x, y);
    const float z = b->position.raw[i], limit = limit_of(&b->g->camera, z);
    if (!(r->state[i] & PIXEL_WHOLE) || !(z > 0.0f)) return false;
    bool across = in_line(r, x, y, -1, 0, limit) || in_line(r, x, y, 1, 0, limit);
    bool down = in_line(r, x, y, 0, -1, limit) || in_line(r, x, y, 0, 1, limit);
    if ((across && down) || !r->lengths) return across && down;
    stored s = filtered_read(r, x, y);
    across = across || by_normals(r, &s, x, y, -1, 0) || by_normals(r, &s, x, y, 1, 0);
    return across && (down || by_normals(r, &s, x, y, 0, -1) || by_normals(r, &s, x, y, 0, 1));
}

// Inside the picture, by depths: nearly all pixels.
static void settle_inside(const repair *r, int y)
{
    const build *b = r->b;
    const int width = b->g->width;
    if (y < 2 || y + 2 >= b->g->height) return;
    const float per_z = b->g->camera.kind == CAMERA_PERSPECTIVE ? limit_of(&b->g->camera, 1.0f) : 0.0f;
    const float fixed = b->g->camera.kind == CAMERA_PERSPECTIVE ? 0.0f : limit_of(&b->g->camera, 1.0f);
    const float *z = b->position.raw + build_index(b, 0, y);
    uint8_t *state = r->state + build_index(b, 0, y);
    for (int x = 2; x + 2 < width; x++) {
        const float limit = per_z * z[x] + fixed;
        if (!(state[x] & PIXEL_WHOLE) || !(z[x] > 0.0f)) continue;
        if (!leads_here(z + x, state + x, -1, limit) && !leads_here(z + x, state + x, 1, limit)) continue;
        if (!leads_here(z + x, state + x, -width, limit) && !leads_here(z + x, state + x, width, limit)) continue;
        state[x] |= PIXEL_CLEAN;
    }
}

static bool settle_row(void *context, size_t row, int worker)
{
    (void)worker;
    const repair *r = context;
    const int y = (int)row;
    settle_inside(r, y);
    for (int x = 0; x < r->b->g->width; x++) {
        uint8_t *state = &r->state[build_index(r->b, x, y)];
        if ((*state & (PIXEL_CLEAN | PIXEL_WHOLE)) == PIXEL_WHOLE && is_clean(r, x, y)) *state |= PIXEL_CLEAN;
    }
    return true;
}

bool filtered_find_clean(repair *r)
{
    const build *b = r->b;
    const size_t total = (size_t)b->g->width * (size_t)b->g->height;
    size_t count = 0;
    threads_for(b->options->threads, (size_t)b->g->height, look_at_row, r);
    threads_for(b->options->threads, (size_t)b->g->height, settle_row, r);
    for (size_t i = 0; i < total; i++) count += !(r->state[i] & (PIXEL_CLEAN | PIXEL_EMPTY));
    r->mixed = mem_pixels(count, sizeof *r->mixed, b->e);
    if (!r->mixed) return false;
    for (size_t i = 0; r->mixed_count < count; i++)
        if (!(r->state[i] & (PIXEL_CLEAN | PIXEL_EMPTY))) r->mixed[r->mixed_count++] = i;
    return true;
}
