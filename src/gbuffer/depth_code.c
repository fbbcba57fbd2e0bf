#include "gbuffer/depth_code.h"

#include <string.h>

static const struct {
    const char *word, *text;
} kinds[DEPTH_KINDS] = {
    [DEPTH_AUTO] = {"auto", "unknown"},
    [DEPTH_PLANAR] = {"planar", "planar distance"},
    [DEPTH_RADIAL] = {"radial", "radial distance"},
    [DEPTH_INVERSE] = {"inverse", "1 / z"},
    [DEPTH_LINEAR] = {"linear", "0..1 from near to far"},
    [DEPTH_INVERTED] = {"inverted", "1..0 from near to far"},
    [DEPTH_ZBUFFER] = {"zbuffer", "a z-buffer's hyperbolic 0..1"},
    [DEPTH_REVERSED] = {"reversed", "a reversed z-buffer's hyperbolic 1..0"},
};

const char *depth_word(depth_kind k) { return kinds[k].word; }
depth_kind depth_named(const char *word)
{
    for (int k = DEPTH_PLANAR; k < DEPTH_KINDS; k++)
        if (strcmp(kinds[k].word, word) == 0) return (depth_kind)k;
    return DEPTH_AUTO;
}
const char *depth_text(depth_kind k) { return kinds[k].text; }

double depth_convert(const depth_code *c, double v)
{
    double n = c->near, f = c->far;
    v *= c->sign;
    bool behind = c->kind == DEPTH_LINEAR || c->kind == DEPTH_ZBUFFER ? !(v >= 0.0 && v < 1.0) : !(v > 0.0);
    if (behind || (c->kind != DEPTH_INVERSE && v > 1.0)) return (double)NAN;
    if (c->kind == DEPTH_INVERSE) return 1.0 / v;
    if (c->kind == DEPTH_LINEAR) return n + (f - n) * v;
    if (c->kind == DEPTH_INVERTED) return f - (f - n) * v;
    return n * f / (f - (c->kind == DEPTH_REVERSED ? 1.0 - v : v) * (f - n));
}
