// How well a reading of the depth fits the file's normals, and the planes that the picture shows.
#include "gbuffer/depth_trial.h"

#include "gbuffer/normal_hypotheses.h"

static const double fits = 0.97;           // median cosine from which the normals confirm a kind
static const double gain[2] = {2e-4, 0.3}; // of loss, and its share, that another kind must have over the renderer's
static const double nearer = 0.25; // share of 1 - cosine, by the medians, that tells a better kind where edges spoil the means
static const double many_planes = 0.15; // share of the looked-at pixels on planes from which they confirm a kind

void trial_start(trial *t, depth_code code) { *t = (trial){.code = code, .fit = (double)NAN, .loss = INFINITY}; }

static double undone(const trial *t, double v)
{
    if (t->curve == CURVE_EXPONENTIAL) return exp(t->by * v);
    return t->curve == CURVE_OFFSET ? fabs(v + t->by) : pow(fabs(v), t->by);
}

double trial_distance(const build *b, const trial *t, int x, int y)
{
    if (!plane_holds(&b->position.z, x, y)) return 0.0;
    double v = plane_get(&b->position.z, x, y), z = depth_background(b, v) ? 0.0 : depth_decode(&t->code, v);
    if (t->curve != CURVE_NONE && z > 0.0) z = undone(t, v);
    if (t->code.kind == DEPTH_RADIAL && b->g->camera.kind == CAMERA_PERSPECTIVE) z /= v3_length(build_ray(&b->g->camera, x, y));
    return z > 0.0 && isfinite(z) ? z : 0.0;
}

static bool point_of(const build *b, const void *context, int x, int y, vec3 *p)
{
    double z = x >= 0 && y >= 0 && x < b->g->width && y < b->g->height ? trial_distance(b, context, x, y) : 0.0;
    if (!(z > 0.0)) return false;
    *p = build_point(&b->g->camera, x, y, z);
    return true;
}

bool trial_ask_normals(build *b, trial *t, evidence *v)
{
    verdict ignored = {0};
    normal_choice c;
    evidence_gather(b, point_of, t, 1, TRIAL_SAMPLES, v);
    if (v->count == 0 || v->spread < 0.01) return true; // a wall fits every kind
    if (!normals_choose(b, v, &ignored, &c)) return false;
    if (c.one_way) return true; // constant normals say nothing
    t->fit = c.best.fit, t->loss = c.best.loss;
    return true;
}

// Along one axis: 1 a line, 0 a curve, -1 too level to tell.
static int straight(const build *b, const trial *t, double bend, int x, int y, int dx, int dy)
{
    double z[3], rounding = b->position.z.type == SAMPLE_HALF ? 0x1p-11 : 0x1p-24;
    for (int k = 0; k < 3; k++) {
        int u = x + (k - 1) * dx, v = y + (k - 1) * dy;
        z[k] = u >= 0 && v >= 0 && u < b->g->width && v < b->g->height ? trial_distance(b, t, u, v) : 0.0;
        if (!(z[k] > 0.0)) return 0;
        if (b->g->camera.kind == CAMERA_PERSPECTIVE) z[k] = 1.0 / z[k];
    }
    double first = fabs(z[2] - z[0]), second = fabs(z[2] - 2.0 * z[1] + z[0]);
    if (first < 100.0 * rounding * fabs(z[1]) || first < 0.01 * fabs(z[1])) return -1;
    return second < bend * first + 4.0 * rounding * fabs(z[1]);
}

void trial_ask_planes(const build *b, trial *t, double bend)
{
    int shorter = b->g->width < b->g->height ? b->g->width : b->g->height, step = shorter / 40 > 2 ? shorter / 40 : 2;
    size_t stride = b->sample.count / TRIAL_SAMPLES + 1, flat = 0, all = 0;
    for (size_t i = 0; i < b->sample.count; i += stride) {
        int x = (int)b->sample.points[i].x, y = (int)b->sample.points[i].y;
        int across = straight(b, t, bend, x, y, step, 0), down = straight(b, t, bend, x, y, 0, step);
        all++;
        flat += across && down && (across > 0 || down > 0);
    }
    t->flat = all ? (double)flat / (double)all : 0.0;
}

// Pixels at edges whose values a filter mixed spoil every kind's mean loss alike, but no median.
bool trial_fits_better(const trial *a, const trial *b)
{
    if (!(a->loss < b->loss) || !(a->fit >= fits)) return false;
    return b->loss - a->loss > gain[0] + gain[1] * b->loss ||
           (b->fit < 1.0 - gain[0] && 1.0 - a->fit < nearer * (1.0 - b->fit) && 4.0 * (b->loss - a->loss) > a->fit - b->fit);
}

bool trial_more_planes(const trial *a, const trial *b) { return a->flat > many_planes && a->flat > 3.0 * b->flat; }

bool trial_has_planes(const trial *t) { return t->flat > many_planes; }
bool trial_has_normals(const trial *t) { return t->fit >= fits; }
