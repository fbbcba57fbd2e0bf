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

// The SH vector has images enough for a run of its own.
static bool fill_vector(pass_context *c, const gpu_tiles *tiles, error *e)
{
    const pass_call call = {
        .program = "edges",
        .label = "edges sh",
        .variant = c->sh[3].id ? "SH BANDS3" : "SH",
        .tiles = tiles,
        .reads = {{"coverage_image", &c->coverage}},
        .writes = {{"sh0_image", &c->sh[0]},
                   {"sh1_image", &c->sh[1]},
                   {"sh2_image", &c->sh[2]},
                   {"sh3_image", &c->sh[3]},
                   {"sh4_image", &c->sh[4]}},
    };
    return c->sh[0].id == 0 || pass_run(c, &call, e);
}

bool pass_edges(pass_context *c, error *e)
{
    variant v = {{0}};
    gpu_tiles tiles;
    variant_add(&v, true, "OCCLUSION");
    variant_add(&v, c->bent.id != 0, "BENT");
    variant_add(&v, c->visibility.id != 0, "VISIBILITY");
    variant_add(&v, c->radiance.id != 0, "RADIANCE");
    variant_add(&v, c->indirect.id != 0, "INDIRECT");
    if (!make_tiles(c, &tiles, e)) return false;
    const pass_call call = {
        .program = "edges",
        .variant = v.words,
        .tiles = &tiles,
        .reads = {{"coverage_image", &c->coverage}},
        .writes = {{"occlusion_image", &c->occlusion},
                   {"bent_image", &c->bent},
                   {"visibility_image", &c->visibility},
                   {"radiance_image", &c->radiance},
                   {"indirect_image", &c->indirect}},
    };
    bool ok = pass_run(c, &call, e) && fill_vector(c, &tiles, e);
    gpu_tiles_free(&tiles);
    return ok;
}
