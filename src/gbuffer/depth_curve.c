// What may have been done to a distance before it was stored, to look at it: a logarithm, a root, an offset. No kind of depth
// undoes it: what is lost is in no file.
//
// Which one it is, planes tell. Along a line of the picture a plane is straight in 1 / z (in z where the picture is
// orthographic). If v is stored, the second difference over the square of the first is then a function of v alone: (p + 1) / v
// where z is v to the power of p, k where z is exp(k v), and 2 / (v + c) where z is v + c. The value that most pixels agree on is
// tried, by how many planes it makes straight; where a picture has none, a square root and a natural logarithm are tried on the
// normals.
#include <stdio.h>

#include "base/sort.h"
#include "gbuffer/depth_trial.h"

enum { LEAST = 60, SHARE = 8, CURVES = CURVE_OFFSET, MEASURED = 2 * TRIAL_SAMPLES + 2 };
static const double least_step = 0.004, most_step = 0.1; // of the value, between the pixels that are looked at
static const double most_noise = 0.05;                   // of the second difference, by rounding
static const double bend = 2e-4;         // of a plane's profile; where curves touch each other they differ by little
static const double fits_exactly = 5e-4; // loss: nearly as good a fit comes of a field of view that is told wrong

// Second difference over the squared first along one axis. False where the step is too small or too large to tell.
static bool curving(const build *b, const trial *as_stored, int x, int y, int dx, int dy, double *value, double *ratio)
{
    double v[3], rounding = b->position.z.type == SAMPLE_HALF ? 0x1p-11 : 0x1p-24;
    for (int k = 0; k < 3; k++) {
        if (!(trial_distance(b, as_stored, x + (k - 1) * dx, y + (k - 1) * dy) > 0.0)) return false;
        v[k] = plane_get(&b->position.z, x + (k - 1) * dx, y + (k - 1) * dy);
    }
    double first = 0.5 * (v[2] - v[0]), size = fabs(v[1]);
    if (fabs(first) < least_step * size || fabs(first) > most_step * size) return false;
    if (4.0 * rounding * size * size > most_noise * first * first) return false;
    *value = v[1], *ratio = (v[2] - 2.0 * v[1] + v[0]) / (first * first);
    return true;
}

// The middle of the narrowest range that holds an eighth of the numbers.
static double mode_of(double *list, size_t count)
{
    size_t many = count / SHARE, best = 0;
    sort_doubles(list, count);
    for (size_t i = 0; i + many < count; i++)
        if (list[i + many] - list[i] < list[best + many] - list[best]) best = i;
    return list[best + many / 2];
}

// What planes would have each curve be.
static bool measure(const build *b, const trial *as_stored, trial found[CURVES])
{
    double by[CURVES][MEASURED];
    int shorter = b->g->width < b->g->height ? b->g->width : b->g->height, step = shorter / 40 > 2 ? shorter / 40 : 2;
    size_t stride = b->sample.count / TRIAL_SAMPLES + 1, count = 0;
    bool perspective = b->g->camera.kind == CAMERA_PERSPECTIVE;
    for (size_t i = 0; i < b->sample.count; i += stride)
        for (int down = 0; down < 2; down++) {
            double v, ratio;
            int x = (int)b->sample.points[i].x, y = (int)b->sample.points[i].y;
            if (!curving(b, as_stored, x, y, down ? 0 : step, down ? step : 0, &v, &ratio)) continue;
            by[0][count] = perspective ? ratio * v - 1.0 : 1.0 - ratio * v;
            by[1][count] = perspective ? ratio : -ratio;
            by[2][count++] = ratio != 0.0 ? 2.0 / ratio - v : INFINITY;
        }
    for (int k = 0; k < CURVES && count >= LEAST; k++) {
        found[k] = *as_stored;
        found[k].curve = (depth_curve)(k + 1), found[k].by = mode_of(by[k], count);
        if (isfinite(found[k].by)) trial_ask_planes(b, &found[k], bend);
    }
    return count >= LEAST;
}

static bool refuse(build *b, const trial *t)
{
    char what[64];
    if (t->curve == CURVE_EXPONENTIAL)
        snprintf(what, sizeof what, "a logarithm of the distance");
    else if (t->curve == CURVE_OFFSET)
        snprintf(what, sizeof what, "the distance less an offset of %.4g", t->by);
    else if (fabs(t->by - 2.0) < 0.02)
        snprintf(what, sizeof what, "the square root of the distance");
    else
        snprintf(what, sizeof what, "the distance to the power of %.2f", 1.0 / t->by);
    return err_set(
        b->e, ERR_INPUT, b->file->path, NULL,
        "the depth's values are %s, by the %s, and not the distance itself; store that (--depth names another channel), "
        "or give --depth-kind planar to take them as they are",
        what, trial_has_planes(t) ? "planes in the picture" : "file's normals");
}

bool depth_question_curve(build *b, const values *s, const trial *best, evidence *scratch)
{
    trial as_stored, list[CURVES];
    bool planes = trial_has_planes(best);
    // An orthographic picture shows the same shapes at any offset; 0..1 is asked for its range.
    int curves = b->g->camera.kind == CAMERA_PERSPECTIVE && s->beyond > 0 ? CURVES : CURVES - 1, likeliest = 0;
    trial_start(&as_stored, (depth_code){.kind = DEPTH_PLANAR, .sign = b->position.code.sign});
    if (measure(b, &as_stored, list)) {
        trial known = *best;
        trial_ask_planes(b, &known, bend);
        for (int k = 1; k < curves; k++)
            if (list[k].flat > list[likeliest].flat) likeliest = k;
        planes = planes || trial_has_planes(&list[likeliest]);
        if (trial_more_planes(&list[likeliest], &known)) return refuse(b, &list[likeliest]);
    }
    if (planes || !b->normal.there || best->loss < fits_exactly) return true;
    for (int k = 0; k < 2; k++) {
        trial t = as_stored;
        t.curve = k ? CURVE_EXPONENTIAL : CURVE_POWER, t.by = k ? 1.0 : 2.0;
        if (!trial_ask_normals(b, &t, scratch)) return false;
        if (t.loss < fits_exactly && 20.0 * t.loss < best->loss) return refuse(b, &t);
    }
    return true;
}
