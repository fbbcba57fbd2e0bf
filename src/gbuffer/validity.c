// Which pixels hold a surface, and a sample of them spread over the frame.
#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/build.h"
#include "gbuffer/solve.h"

enum { SAMPLE_POINTS = 12000 };
static const double far_position = 9e9;    // some renderers fill P with 1e10 or 1e30
static const double largest_half = 65504.; // what a clamped background becomes

static bool depth_good(const build *b, double z)
{
    if (!(z > 0.0) || !isfinite(z) || z >= b->r->background_depth) return false;
    return b->position.z.type != SAMPLE_HALF || z < largest_half;
}

static surface classify(build *b, int x, int y)
{
    bool good = !b->position.has_z || depth_good(b, build_depth(b, x, y));
    if (!b->position.has_p) return good ? SURFACE_YES : SURFACE_NONE;
    vec3 p = build_position(b, x, y);
    double most = fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z)));
    if (b->position.has_z && good && !v3_finite(p)) atomic_fetch_add(&b->defects.positions, 1);
    if (!good || !v3_finite(p) || most >= far_position) return SURFACE_NONE;
    if (most > 0.0) return SURFACE_YES;
    return b->position.has_z ? SURFACE_ORIGIN : SURFACE_NONE;
}

static void classify_row(build *b, int y)
{
    for (int x = 0; x < b->g->width; x++) b->surface[build_index(b, x, y)] = (uint8_t)classify(b, x, y);
}

static size_t count_surfaces(const build *b)
{
    size_t n = 0, total = (size_t)b->g->width * (size_t)b->g->height;
    for (size_t i = 0; i < total; i++) n += b->surface[i] == SURFACE_YES;
    return n;
}

// A depth that calls most of the positions background is no depth of them (an artist's remapped Z, an empty channel).
static bool classify_all(build *b)
{
    build_rows(b, classify_row);
    b->sample.candidates = count_surfaces(b);
    if (!b->position.has_p || !b->position.has_z) return true;
    if (2 * b->sample.candidates >= (size_t)b->g->width * (size_t)b->g->height) return true;
    b->position.has_z = false;
    size_t with_depth = b->sample.candidates;
    uint8_t *kept = b->surface;
    b->surface = mem_zero((size_t)b->g->width * (size_t)b->g->height, 1, b->e);
    if (!b->surface) {
        b->surface = kept;
        return false;
    }
    build_rows(b, classify_row);
    size_t without = count_surfaces(b);
    if (2 * with_depth >= without) {
        free(b->surface);
        b->surface = kept;
        b->position.has_z = true;
        return true;
    }
    free(kept);
    b->sample.candidates = without;
    atomic_store(&b->defects.positions, 0); // they were background
    log_warn(b->log, "depth-background",
             "the depth channel calls %zu of %zu pixels with a position background; it is ignored (--depth names another)",
             without - with_depth, without);
    build_note(b, "depth ignored: background where there are positions");
    return true;
}

// One pixel out of every run of `stride` surface pixels in reading order, at random.
static bool sample(build *b)
{
    free(b->sample.points);
    free(b->sample.depth);
    b->sample.count = 0;
    size_t stride = b->sample.candidates / SAMPLE_POINTS + 1, most = b->sample.candidates / stride + 1;
    b->sample.points = mem_pixels(most, sizeof *b->sample.points, b->e);
    b->sample.depth = mem_pixels(most, sizeof *b->sample.depth, b->e);
    if (!b->sample.points || !b->sample.depth) return false;
    uint64_t random = 3;
    size_t seen = 0, chosen = (size_t)(solve_random(&random) % stride);
    for (int y = 0; y < b->g->height; y++)
        for (int x = 0; x < b->g->width; x++) {
            if (b->surface[build_index(b, x, y)] != SURFACE_YES) continue;
            if (seen++ != chosen) continue;
            chosen = seen - 1 - (seen - 1) % stride + stride + (size_t)(solve_random(&random) % stride);
            vec3 p = b->position.has_p ? build_position(b, x, y) : v3(0, 0, 0);
            b->sample.points[b->sample.count] = (camera_point){p, x + 0.5, y + 0.5};
            b->sample.depth[b->sample.count++] = b->position.has_z ? build_depth(b, x, y) : (double)NAN;
        }
    return true;
}

bool validity_find(build *b) { return classify_all(b) && sample(b); }
