#include <math.h>
#include <string.h>

#include "gbuffer/build.h"

size_t plane_fetch(const plane *p, int x, int y, int n, float *to)
{
    int from = x + p->dx, row = y + p->dy, first = from < 0 ? -from : 0, last = from + n > p->width ? p->width - from : n;
    if (row < 0 || row >= p->height || first > n) first = last = n;
    if (last < first) last = first;
    for (int i = 0; i < first; i++) to[i] = NAN;
    for (int i = last; i < n; i++) to[i] = NAN;
    if (first == last) return 0;
    size_t at = (size_t)row * (size_t)p->width + (size_t)(from + first), count = (size_t)(last - first), bad = 0;
    if (p->type == SAMPLE_HALF)
        half_to_floats((const uint16_t *)p->data + at, count, to + first);
    else if (p->type == SAMPLE_FLOAT)
        memcpy(to + first, (const float *)p->data + at, count * sizeof *to);
    else
        for (size_t i = 0; i < count; i++) to[(size_t)first + i] = (float)((const uint32_t *)p->data)[at + i];
    for (int i = first; i < last; i++) bad += isfinite(to[i]) ? 0 : 1;
    return bad;
}
