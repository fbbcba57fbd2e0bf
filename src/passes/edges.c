#include "passes/pass.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/mem.h"

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
    tiles->stop = c->tiles.stop;
    free(mask);
    return ok;
}

bool pass_edges(pass_context *c, error *e)
{
    char defines[128];
    snprintf(defines, sizeof defines, "%s%s%s%s%s%s", c->sh[3].id ? "BANDS3 1\n" : "", c->bent.id ? "BENT 1\n" : "",
             c->sh[0].id ? "SH 1\n" : "", c->visibility.id ? "VISIBILITY 1\n" : "", c->radiance.id ? "RADIANCE 1\n" : "",
             c->indirect.id ? "INDIRECT 1\n" : "");
    const pass_binding bindings[] = {
        {2, &c->coverage, GL_READ_ONLY},  {3, &c->occlusion, GL_READ_WRITE}, {4, &c->visibility, GL_READ_WRITE},
        {5, &c->radiance, GL_READ_WRITE}, {6, &c->indirect, GL_READ_WRITE},  {7, &c->sh[0], GL_READ_WRITE},
        {8, &c->sh[1], GL_READ_WRITE},    {9, &c->sh[2], GL_READ_WRITE},     {10, &c->bent, GL_READ_WRITE},
        {11, &c->sh[3], GL_READ_WRITE},   {12, &c->sh[4], GL_READ_WRITE}};
    gpu_tiles whole = c->tiles, tiles;
    if (!make_tiles(c, &tiles, e)) return false;
    c->tiles = tiles;
    bool ok = pass_run(c, "edges", defines, NULL, 0, bindings, 11, false, e);
    c->tiles = whole;
    gpu_tiles_free(&tiles);
    return ok;
}
