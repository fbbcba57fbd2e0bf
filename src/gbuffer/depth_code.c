#include "gbuffer/depth_code.h"

static const char *const texts[DEPTH_KINDS] = {
    [DEPTH_AUTO] = "unknown",
    [DEPTH_PLANAR] = "planar distance",
    [DEPTH_RADIAL] = "radial distance",
    [DEPTH_INVERSE] = "1 / z",
    [DEPTH_LINEAR] = "0..1 from near to far",
    [DEPTH_INVERTED] = "1..0 from near to far",
    [DEPTH_ZBUFFER] = "a z-buffer's hyperbolic 0..1",
    [DEPTH_REVERSED] = "a reversed z-buffer's hyperbolic 1..0",
    [DEPTH_NDC] = "a z-buffer's hyperbolic -1..1",
};

const char *depth_text(depth_kind k) { return texts[k]; }

double depth_convert(const depth_code *c, double v)
{
    double n = c->near, f = c->far;
    v = c->kind == DEPTH_NDC ? 0.5 * (v + 1.0) : c->sign * v;
    bool behind =
        c->kind == DEPTH_LINEAR || c->kind == DEPTH_ZBUFFER || c->kind == DEPTH_NDC ? !(v >= 0.0 && v < 1.0) : !(v > 0.0);
    if (behind || (c->kind != DEPTH_INVERSE && v > 1.0)) return (double)NAN;
    if (c->kind == DEPTH_INVERSE) return 1.0 / v;
    if (c->kind == DEPTH_LINEAR) return n + (f - n) * v;
    if (c->kind == DEPTH_INVERTED) return f - (f - n) * v;
    return n * f / (f - (c->kind == DEPTH_REVERSED ? 1.0 - v : v) * (f - n));
}
