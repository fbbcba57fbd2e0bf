#include "passes/openness.h"

#include <math.h>

// A number of the grid.
static double stored(const openness *o, int row, int column)
{
    int i = row == 0 ? 0 : row > OPENNESS_ROWS ? 1 : 2 + (row - 1) * OPENNESS_COLUMNS + column % OPENNESS_COLUMNS;
    return o->share[i];
}

// Where a ray leaves the box, as a direction from the middle of the box, whose sides count as equally long.
static vec3 way_through(const openness *o, vec3 place, vec3 d)
{
    const double from[] = {place.x, place.y, place.z}, along[] = {d.x, d.y, d.z};
    const double low[] = {o->low.x, o->low.y, o->low.z}, high[] = {o->high.x, o->high.y, o->high.z};
    double least = INFINITY, aside[3], most = 0.0;
    for (int k = 0; k < 3; k++)
        if (fabs(along[k]) > 1e-20) least = fmin(least, ((along[k] > 0.0 ? high[k] : low[k]) - from[k]) / along[k]);
    for (int k = 0; k < 3; k++) {
        aside[k] = (from[k] + fmax(0.0, least) * along[k] - 0.5 * (low[k] + high[k])) / fmax(high[k] - low[k], 1e-12);
        most = fmax(most, fabs(aside[k]));
    }
    if (!(most > 1e-12 && most < 1e30)) return d;
    vec3 way = v3(aside[0] / most, aside[1] / most, aside[2] / most);
    return v3_scale(way, 1.0 / v3_length(way));
}

double openness_towards(const openness *o, vec3 place, vec3 d)
{
    vec3 way = way_through(o, place, d);
    double u = 0.5 - atan2(way.y, way.x) / (2.0 * M_PI), v = acos(fmin(1.0, fmax(-1.0, way.z))) / M_PI;
    double x = u * OPENNESS_COLUMNS, y = v * (OPENNESS_ROWS + 1);
    int column = (int)x, row = (int)fmin(y, OPENNESS_ROWS);
    double s = x - column, t = y - row;
    return (1.0 - t) * ((1.0 - s) * stored(o, row, column) + s * stored(o, row, column + 1)) +
           t * ((1.0 - s) * stored(o, row + 1, column) + s * stored(o, row + 1, column + 1));
}
