// The camera from world positions and the pixels they were seen at.
//
// Order of work, once for each camera kind: a linear fit of all points, reweighted by its own residuals; if that leaves too few
// points explained, random minimal subsets (RANSAC with the truncated squared error as its score, Torr and Zisserman 2000); then
// Levenberg-Marquardt on the points within a few standard deviations.
#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/camera_solve.h"
#include "gbuffer/solve.h"

enum {
    LEAST_POINTS = 12,
    SCORED = 512,      // points that score a hypothesis
    TRIALS = 800,      // for 6 points and half of them bad, 800 draws miss with probability 3e-6
    REWEIGHTINGS = 15, // of the linear fit
    LINEAR = 3000,     // points the linear stage looks at; the refinement uses all
};
static const double near_pixels = 2.0;   // a point within this of its place counts as explained while searching
static const double least_sigma = 0.01;  // pixels: keeps float rounding from being taken for an outlier
static const double worst_spread = 0.01; // relative standard deviation of the focal length beyond which it counts as unknown
static const double tie = 1.005;         // an orthographic camera whose error is this close to the perspective one is preferred

typedef struct problem {
    camera_point *points; // shifted and scaled
    size_t count;
    vec3 centre;
    double size;
    double *weights, *errors; // scratch, count each
} problem;

typedef struct solution {
    bool good;
    camera camera;
    double median; // pixels, over all points
    double spread; // relative standard deviation of fx
} solution;

static void errors_of(const problem *k, const projection *p)
{
    for (size_t i = 0; i < k->count; i++) k->errors[i] = projection_error(p, &k->points[i]);
}

static double share_explained(const problem *k)
{
    size_t n = 0;
    for (size_t i = 0; i < k->count; i++) n += k->errors[i] < near_pixels;
    return (double)n / (double)k->count;
}

static double median_error(const problem *k, double *scratch)
{
    for (size_t i = 0; i < k->count; i++) scratch[i] = k->errors[i];
    return solve_median(scratch, k->count);
}

// Geman-McClure weights with the scale following the median down: a redescending estimator that ends blind to outliers.
static bool reweight(const problem *k, projection *p)
{
    for (int i = 0; i < REWEIGHTINGS; i++) {
        errors_of(k, p);
        double scale = fmax(2.0 * median_error(k, k->weights), 2.0 * least_sigma);
        for (size_t j = 0; j < k->count; j++) {
            double r = k->errors[j] / scale, w = 1.0 / (1.0 + r * r);
            k->weights[j] = w * w;
        }
        projection next;
        if (!projection_fit(p->kind, k->points, k->weights, k->count, p, &next)) return false;
        *p = next;
    }
    errors_of(k, p);
    return true;
}

// Truncated squared error over some of the points; *share: those within the limit.
static double score(const problem *k, const projection *p, double limit, double *share)
{
    size_t n = k->count < SCORED ? k->count : SCORED, within = 0;
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        double r = projection_error(p, &k->points[i]);
        sum += fmin(r * r, limit * limit);
        within += r < limit;
    }
    *share = (double)within / (double)n;
    return sum;
}

// Draws after which a set without a bad point has been missed with a probability of one in a million, if `share` is good.
static int draws_needed(double share, size_t minimal)
{
    double clean = pow(share, (double)minimal);
    if (clean > 0.999) return 1;
    double draws = log(1e-6) / log1p(-clean);
    return draws < TRIALS ? (int)draws + 1 : TRIALS;
}

static bool search(const problem *k, camera_kind kind, double limit, projection *best)
{
    const size_t minimal = kind == CAMERA_PERSPECTIVE ? 6 : 4;
    uint64_t random = 1;
    double least = INFINITY;
    int needed = TRIALS;
    for (int trial = 0; trial < needed; trial++) {
        camera_point picked[6];
        for (size_t i = 0; i < minimal; i++) picked[i] = k->points[solve_random(&random) % k->count];
        projection p;
        double share;
        if (!projection_fit(kind, picked, NULL, minimal, NULL, &p)) continue;
        double s = score(k, &p, limit, &share);
        if (!(s < least)) continue;
        least = s, *best = p;
        // Sets close to one plane or line explain less than clean ones could: four times the draws of the textbook.
        needed = 4 * draws_needed(share, minimal);
        needed = needed < TRIALS ? needed : TRIALS;
    }
    return isfinite(least);
}

// The linear stage. searching: draw minimal sets where reweighting explains too few points.
static bool linear_stage(const problem *all, camera_kind kind, bool searching, projection *out)
{
    problem few = *all, *k = &few;
    if (few.count > LINEAR) few.count = LINEAR;
    bool have = projection_fit(kind, k->points, NULL, k->count, NULL, out) && reweight(k, out);
    double share = have ? share_explained(k) : 0.0;
    for (int attempt = 0; searching && attempt < 2 && share < 0.65; attempt++) {
        projection p;
        if (!search(k, kind, attempt == 0 ? near_pixels : 5.0 * near_pixels, &p) || !reweight(k, &p)) continue;
        double found = share_explained(k);
        if (!have || found > share) *out = p, share = found, have = true;
    }
    return have;
}

static void camera_errors(const problem *k, const camera *c)
{
    for (size_t i = 0; i < k->count; i++) k->errors[i] = camera_point_error(c, &k->points[i]);
}

// Sets k->weights to 1 for points within 3.5 standard deviations; returns the standard deviation (per axis, from the median,
// whose ratio to it is 1.1774 for a two-dimensional normal distribution).
static double choose_inliers(const problem *k)
{
    double sigma = fmax(median_error(k, k->weights) / 1.1774, least_sigma);
    for (size_t i = 0; i < k->count; i++) k->weights[i] = k->errors[i] < 3.5 * sigma ? 1.0 : 0.0;
    return sigma;
}

// Beyond this median error the positions and the pixels have nothing to do with each other.
static double worst_median(const problem *k)
{
    double x0 = INFINITY, x1 = -INFINITY, y0 = INFINITY, y1 = -INFINITY;
    for (size_t i = 0; i < k->count; i++) {
        x0 = fmin(x0, k->points[i].x), x1 = fmax(x1, k->points[i].x);
        y0 = fmin(y0, k->points[i].y), y1 = fmax(y1, k->points[i].y);
    }
    return fmax(1.0, 0.01 * hypot(x1 - x0, y1 - y0));
}

static solution solve(const problem *k, camera_kind kind, bool searching)
{
    solution s = {.median = INFINITY, .spread = INFINITY};
    projection p;
    if (!linear_stage(k, kind, searching, &p) || !projection_to_camera(&p, &s.camera)) return s;
    camera_errors(k, &s.camera);
    if (!(median_error(k, k->weights) < 2.0 * worst_median(k))) return s; // no refinement will save it
    unsigned all = FREE_FX | FREE_FY | FREE_CENTRE | FREE_POSE;
    double sigma = least_sigma;
    for (int round = 0; round < 3; round++) {
        camera_errors(k, &s.camera);
        sigma = choose_inliers(k);
        double spread;
        if (!camera_refine(&s.camera, k->points, NULL, k->weights, k->count, all, &spread)) return s;
        s.spread = spread * sigma;
    }
    camera_errors(k, &s.camera);
    s.median = median_error(k, k->weights);
    s.good = isfinite(s.median) && s.median < 1e29;
    return s;
}

// Root mean square errors of both cameras on the same points: those that the better of the two explains well. Choosing them by
// one camera alone would let a nonsensical one choose the outliers.
static void compare(const problem *k, const camera *a, const camera *b, double *rms_a, double *rms_b)
{
    for (size_t i = 0; i < k->count; i++) {
        k->errors[i] = fmin(camera_point_error(a, &k->points[i]), camera_point_error(b, &k->points[i]));
        k->weights[i] = k->errors[i];
    }
    double limit = solve_select(k->weights, k->count, k->count * 4 / 5);
    limit = fmin(limit, 10.0 * fmax(median_error(k, k->weights), least_sigma));
    double sum_a = 0.0, sum_b = 0.0, n = 0.0;
    for (size_t i = 0; i < k->count; i++) {
        if (k->errors[i] > limit) continue;
        double ea = camera_point_error(a, &k->points[i]), eb = camera_point_error(b, &k->points[i]);
        sum_a += ea * ea, sum_b += eb * eb, n += 1.0;
    }
    *rms_a = sqrt(sum_a / n), *rms_b = sqrt(sum_b / n); // the median point is always among them
}

static bool choose(const problem *k, const solution *perspective, const solution *orthographic, const solution **out)
{
    bool p = perspective->good, o = orthographic->good && orthographic->spread < worst_spread;
    if (p && o) {
        double rp, ro;
        compare(k, &perspective->camera, &orthographic->camera, &rp, &ro);
        if (ro <= tie * rp + 1e-3)
            p = false;
        else
            o = false;
    }
    *out = o ? orthographic : perspective;
    return (p || o) && (*out)->spread < worst_spread;
}

// From the shifted, scaled points back to the world.
static void to_world(const problem *k, camera *c)
{
    c->origin = v3_add(v3_scale(c->origin, k->size), k->centre);
    if (c->kind == CAMERA_ORTHOGRAPHIC) c->fx /= k->size, c->fy /= k->size;
}

// An orthographic camera's centre is free: the pixels' mean, with the origin moved across to match, then back.
static void settle_orthographic(const camera_point *points, size_t count, camera *c)
{
    double x = 0.0, y = 0.0, low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < count; i++) x += points[i].x / (double)count, y += points[i].y / (double)count;
    vec3 across = v3((x - c->cx) / c->fx, (y - c->cy) / c->fy, 0.0);
    c->origin = v3_add(c->origin, m3_apply(c->world_from_camera, across));
    c->cx = x, c->cy = y;
    for (size_t i = 0; i < count; i++) {
        if (!v3_finite(points[i].world) || camera_point_error(c, &points[i]) > 10.0) continue;
        double z = camera_from_world(c, points[i].world).z;
        low = fmin(low, z), high = fmax(high, z);
    }
    if (low <= high) camera_move_back(c, low, high);
}

static bool prepare(const camera_point *points, size_t count, problem *k, error *e)
{
    k->points = mem_pixels(count + 1, sizeof *k->points, e);
    k->weights = mem_pixels(count + 1, sizeof *k->weights, e);
    k->errors = mem_pixels(count + 1, sizeof *k->errors, e);
    if (!k->points || !k->weights || !k->errors) return false;
    for (size_t i = 0; i < count; i++)
        if (v3_finite(points[i].world) && isfinite(points[i].x + points[i].y)) k->points[k->count++] = points[i];
    // In random order, so that the first n are a fair sample.
    uint64_t random = 11;
    for (size_t i = k->count; i > 1; i--) {
        size_t j = (size_t)(solve_random(&random) % i);
        camera_point swap = k->points[i - 1];
        k->points[i - 1] = k->points[j], k->points[j] = swap;
    }
    double *axis[3] = {&k->centre.x, &k->centre.y, &k->centre.z};
    for (int a = 0; a < 3; a++) {
        for (size_t i = 0; i < k->count; i++) {
            vec3 w = k->points[i].world;
            k->errors[i] = a == 0 ? w.x : a == 1 ? w.y : w.z;
        }
        *axis[a] = solve_median(k->errors, k->count);
    }
    for (size_t i = 0; i < k->count; i++) k->errors[i] = v3_length(v3_sub(k->points[i].world, k->centre));
    k->size = solve_median(k->errors, k->count);
    if (!(k->size > 0.0)) k->size = 1.0;
    for (size_t i = 0; i < k->count; i++) k->points[i].world = v3_scale(v3_sub(k->points[i].world, k->centre), 1.0 / k->size);
    return true;
}

bool camera_fit(const camera_point *points, size_t count, camera *out, error *e)
{
    static const char remedy[] = "give the camera with --fov, --ortho or --camera";
    problem k = {.count = 0};
    bool done = false;
    if (!prepare(points, count, &k, e)) goto out;
    if (k.count < LEAST_POINTS) {
        err_set(e, ERR_INPUT, NULL, NULL, "only %zu usable positions, too few to find the camera from (%d needed); %s", k.count,
                LEAST_POINTS, remedy);
        goto out;
    }
    // Parallel rays leave a perspective camera's focal length open: where that is settled there is nothing to search for.
    solution perspective = solve(&k, CAMERA_PERSPECTIVE, true);
    bool settled = perspective.good && perspective.spread < worst_spread && perspective.median < near_pixels;
    solution orthographic = solve(&k, CAMERA_ORTHOGRAPHIC, !settled);
    const solution *best;
    if (!choose(&k, &perspective, &orthographic, &best)) {
        err_set(e, ERR_INPUT, NULL, NULL,
                "the positions do not determine the camera (all of the visible surface may lie on one plane); %s", remedy);
        goto out;
    }
    if (!(best->median < worst_median(&k))) {
        err_set(e, ERR_INPUT, NULL, NULL, "no camera explains the positions (median error %.3g pixels); %s", best->median,
                remedy);
        goto out;
    }
    *out = best->camera;
    to_world(&k, out);
    if (out->kind == CAMERA_ORTHOGRAPHIC) settle_orthographic(points, count, out);
    camera_residual(out, points, count, &out->residual, &out->inliers);
    done = true;
out:
    free(k.points);
    free(k.weights);
    free(k.errors);
    return done;
}
