// A smooth surface that hides another bends away from the eye where its outline is. In a value that is linear in 1 / z a plane
// has no second difference, so that only round surfaces speak: the nearer side's is negative.
#include "gbuffer/depth_direction.h"

enum { LEAST = 24, LOOKED_AT = 400000, LINE = 6 };
static const double step = 2.0;        // of the value across an outline, over the differences beside it
static const double bend = 0.05;       // second difference over the first, from which a surface is round
static const double rounding = 0x1p-9; // of the step across, that is no shape
static const double clear_margin = 0.5;

typedef enum measure { AS_IT_IS, NEGATED, INVERTED } measure;

typedef struct votes {
    size_t away, towards;
} votes;

// Linear in 1 / z and larger nearer to the eye, if the measure is the right one; NaN for the background.
static double nearness(const build *b, measure m, bool linear_inverse, int x, int y)
{
    double v = b->position.code.sign * plane_get(&b->position.z, x, y);
    bool half = b->position.z.type == SAMPLE_HALF;
    if (!isfinite(v) || v >= b->r->background_depth || (half && v >= 65504.0)) return (double)NAN;
    if (linear_inverse ? v == 0.0 || v >= 1.0 : v <= 0.0) return (double)NAN;
    return m == AS_IT_IS ? v : m == NEGATED ? -v : 1.0 / v;
}

// u: of six pixels in a line, with the outline in their middle.
static void vote(const double u[LINE], votes *v)
{
    double across = u[3] - u[2], before = u[2] - u[1], behind = u[4] - u[3];
    if (!(fabs(across) > step * fmax(fabs(before), fabs(behind)))) return;
    double first = across < 0.0 ? before : behind, second = across < 0.0 ? before - (u[1] - u[0]) : u[5] - u[4] - behind;
    if (fabs(second) < bend * fabs(first) || fabs(second) < rounding * fabs(across)) return;
    if (second < 0.0)
        v->away++;
    else
        v->towards++;
}

// 1: at all outlines of round surfaces the nearer side bends away from the eye; -1: at none; 0: too few to tell.
static double bent_away(const build *b, measure m, bool linear_inverse)
{
    const int width = b->g->width, height = b->g->height;
    const int stride = 1 + (int)((size_t)width * (size_t)height / LOOKED_AT);
    votes v = {0};
    for (int down = 0; down < 2; down++)
        for (int y = 0; y < height; y += down ? 1 : stride)
            for (int x = 0; x < width; x += down ? stride : 1) {
                double u[LINE];
                bool whole = down ? y + LINE <= height : x + LINE <= width;
                for (int k = 0; whole && k < LINE; k++) {
                    u[k] = nearness(b, m, linear_inverse, x + (down ? 0 : k), y + (down ? k : 0));
                    whole = isfinite(u[k]);
                }
                if (whole) vote(u, &v);
            }
    size_t all = v.away + v.towards;
    return all < LEAST ? 0.0 : ((double)v.away - (double)v.towards) / (double)all;
}

depth_direction depth_find_direction(const build *b, bool linear_inverse)
{
    double nearer = bent_away(b, AS_IT_IS, linear_inverse);
    double farther = bent_away(b, linear_inverse ? NEGATED : INVERTED, linear_inverse);
    if (fabs(nearer - farther) < clear_margin) return LARGER_UNKNOWN;
    return nearer > farther ? LARGER_IS_NEARER : LARGER_IS_FARTHER;
}
