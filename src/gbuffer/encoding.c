#include "gbuffer/encoding.h"

static const char *const texts[NORMAL_ENCODINGS] = {
    [NORMAL_SIGNED] = "as they are",
    [NORMAL_UNORM] = "0..1 encoded",
    [NORMAL_GAMMA] = "0..1 encoded through gamma 2.2",
    [NORMAL_SRGB] = "0..1 encoded through the sRGB curve",
    [NORMAL_DEGAMMA] = "0..1 encoded, then linearised by gamma 2.2",
    [NORMAL_DESRGB] = "0..1 encoded, then linearised by the sRGB curve",
};

const char *encoding_text(normal_encoding e) { return texts[e]; }

static double linear_of_srgb(double v) { return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4); }
static double srgb_of_linear(double v) { return v <= 0.0031308 ? v * 12.92 : 1.055 * pow(v, 1.0 / 2.4) - 0.055; }

static double decode(normal_encoding e, double v)
{
    double a = fabs(v), u = a;
    if (e == NORMAL_GAMMA) u = pow(a, 2.2);
    if (e == NORMAL_SRGB) u = linear_of_srgb(a);
    if (e == NORMAL_DEGAMMA) u = pow(a, 1.0 / 2.2);
    if (e == NORMAL_DESRGB) u = srgb_of_linear(a);
    return 2.0 * (v < 0.0 ? -u : u) - 1.0;
}

vec3 encoding_undo_curve(normal_encoding e, vec3 s) { return v3(decode(e, s.x), decode(e, s.y), decode(e, s.z)); }
