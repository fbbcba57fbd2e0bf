#include <stdlib.h>

#include "base/mem.h"
#include "passes/pass.h"
#include "passes/variants.h"

enum { EDGE_TILE = 32 };

// Pixels to fill are few, and a software renderer runs the search for pixels that do not need it: only tiles that hold some are
// dispatched.
static bool make_tiles(const pass_context *c, gpu_tiles *tiles, error *e)
{
    size_t n = (size_t)c->width * (size_t)c->height;
    unsigned char *mask = mem_pixels(n, 1, e);
    if (!mask) return false;
    for (size_t i = 0; i < n; i++) mask[i] = c->gb->coverage[i] > 0.0f && c->gb->depth[i] == 0.0f;
    bool ok = gpu_tiles_of(tiles, c->width, c->height, EDGE_TILE, mask, e);
    free(mask);
    return ok;
}

static bool fill(pass_context *c, const gpu_tiles *tiles, unsigned group, const char *label, error *e)
{
    variant v = {{0}};
    pass_call call = {.program = "edges",
                      .label = label,
                      .variant = v.words,
                      .tiles = tiles,
                      .reads = {{"coverage_image", &c->image[IMAGE_COVERAGE]}}};
    return !pass_add_group(c, group, &v, call.writes) || pass_run(c, &call, e);
}

bool pass_edges(pass_context *c, error *e)
{
    gpu_tiles tiles;
    if (!make_tiles(c, &tiles, e)) return false;
    bool ok = fill(c, &tiles, IMAGE_FILLED, "edges", e) && fill(c, &tiles, IMAGE_VECTOR, "edges sh", e);
    gpu_tiles_free(&tiles);
    return ok;
}
