// Finds the kind of a depth where the file has no positions. Two kinds of evidence decide; neither needs the scale:
// - the file's normals: they fit the surfaces only if the depth is read as the right kind;
// - planes: 1 / z is linear across a perspective picture of a plane (z across an orthographic one), again only for the right
// kind. 1 / z and a z-buffer's values differ by a scale and an offset, so that planes do not tell them apart: what stands for
// the background does, or outlines (depth_direction.c).
// If neither decides, the renderer's usual kind is taken, unless all values lie within 0..1 and so can hardly be distances.
#include <stdio.h>
#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/depth_direction.h"
#include "gbuffer/normal_hypotheses.h"

enum { SAMPLES = 1200, LOOKED_AT = 40000, MOST = DEPTH_KINDS };
static const double fits = 0.97;           // median cosine from which the normals confirm a kind
static const double gain[2] = {2e-4, 0.3}; // of loss, and its share, that another kind must have over the renderer's
static const double nearer = 0.25; // share of 1 - cosine, by the medians, that tells a better kind where edges spoil the means
static const double most_ringing = 0.4,
                    ringing_share = 0.05; // past 0..1, of values that a filter with negative lobes leaves at edges
static const double same_grey = 0.01;     // of a value, by which a lossy compression may set R, G and B apart
static const double many_planes = 0.15;   // share of the looked-at pixels on planes from which they confirm a kind
static const double bend = 1e-3;          // second difference over the first, below which a profile is a line

typedef struct trial {
    depth_code code;
    double fit, loss; // by the normals; loss INFINITY without
    double flat;      // share of pixels on planes
} trial;

// Raw values of the frame.
typedef struct values {
    size_t looked_at, negative, zero, one, within; // within: 0 < v < 1
    size_t beyond;                                 // v > 1, background left out, unless a filter's negative lobes explain it
    size_t under;                                  // v < -1
} values;

static bool background(const build *b, double v)
{
    return !isfinite(v) || fabs(v) >= b->r->background_depth || (b->position.z.type == SAMPLE_HALF && fabs(v) >= 65504.0);
}

static values look(const build *b)
{
    values s = {0};
    size_t ringing = 0, below = 0;
    size_t pixels = (size_t)b->g->width * (size_t)b->g->height, stride = pixels / LOOKED_AT + 1;
    for (size_t i = 0; i < pixels; i += stride) {
        double v = plane_get(&b->position.z, (int)(i % (size_t)b->g->width), (int)(i / (size_t)b->g->width));
        if (background(b, v)) continue;
        s.looked_at++, s.negative += v < 0.0, s.zero += v == 0.0, s.one += v == 1.0, s.under += v < -1.0;
        s.within += v > 0.0 && 1.0 > v, s.beyond += v > 1.0;
        ringing += v > 1.0 && v < 1.0 + most_ringing, below += v < 0.0 && v > -most_ringing;
    }
    if (s.beyond == ringing && (double)ringing < ringing_share * (double)s.looked_at) s.beyond = 0;
    if (s.negative == below && (double)below < ringing_share * (double)s.looked_at) s.negative = 0;
    return s;
}

// Both signs, more than a filter or a few broken pixels would leave.
static bool both_signs(const values *s)
{
    size_t positive = s->looked_at - s->negative - s->zero;
    return 50 * s->negative > s->looked_at && 50 * positive > s->looked_at;
}

static bool marks_background(const values *s, size_t count) { return 2000 * count > s->looked_at; }

// Near and far by an option, or by names that headers use.
static bool find_range(const build *b, double *near, double *far)
{
    static const char *const names[][2] = {{"near", "far"},
                                           {"nearClip", "farClip"},
                                           {"near_clip", "far_clip"},
                                           {"clipNear", "clipFar"},
                                           {"arnold/camera/near_clip", "arnold/camera/far_clip"}};
    *near = b->options->depth_near, *far = b->options->depth_far;
    if (*far > 0.0) return true;
    for (size_t i = 0; b->file->core && i < sizeof names / sizeof *names; i++)
        if (camera_number(b->file, b->r->main_part, names[i][0], near) &&
            camera_number(b->file, b->r->main_part, names[i][1], far) && *near >= 0.0 && *far > *near)
            return true;
    return false;
}

static bool no_range(build *b, const char *what)
{
    return err_set(b->e, ERR_INPUT, b->file->path, NULL,
                   "%s; give --depth-range NEAR FAR and, where it is not recognised, --depth-kind linear, inverted, zbuffer, "
                   "reversed or ndc",
                   what);
}

// A depth in R, G and B is one value three times. If not, it is a picture of a depth, in false colours.
static void question_colours(build *b)
{
    const plane others[2] = {build_plane(b, ROLE_DEPTH, 1), build_plane(b, ROLE_DEPTH, 2)};
    size_t pixels = (size_t)b->g->width * (size_t)b->g->height, stride = pixels / LOOKED_AT + 1, seen = 0, odd = 0;
    for (size_t i = 0; others[0].data && others[1].data && i < pixels; i += stride) {
        int x = (int)(i % (size_t)b->g->width), y = (int)(i / (size_t)b->g->width);
        double v = plane_get(&b->position.z, x, y), least = same_grey * fabs(v);
        if (!isfinite(v)) continue;
        seen++, odd += fabs(plane_get(&others[0], x, y) - v) > least || fabs(plane_get(&others[1], x, y) - v) > least;
    }
    if (100 * odd <= seen) return;
    b->g->depth_verdict.doubtful = true;
    log_warn(b->log, "depth-colours",
             "the depth's R, G and B differ, as in a picture in false colours; R is taken as the depth (--depth names another "
             "channel)");
}

bool depth_open(build *b)
{
    depth_code *c = &b->position.code;
    if (!b->position.has_z) return true;
    question_colours(b);
    b->g->depth_kind = b->r->depth == DEPTH_RADIAL ? DEPTH_RADIAL : DEPTH_PLANAR;
    values s = look(b);
    if (10 * s.negative > 9 * (s.looked_at - s.zero)) c->sign = s.looked_at > s.zero ? -1.0 : 1.0;
    if (!b->r->depth_told || b->r->depth <= DEPTH_RADIAL) return true;
    c->kind = b->r->depth;
    if (!depth_needs_range(c->kind)) return true;
    if (!find_range(b, &c->near, &c->far)) return no_range(b, "the depth's near and far are not known");
    if (c->near > 0.0 || c->kind == DEPTH_LINEAR || c->kind == DEPTH_INVERTED) return true;
    return no_range(b, "a z-buffer's near lies at 0, which says nothing about depth");
}

// Planar distance at a pixel as the code has it, 0 where there is none.
static double distance(const build *b, const depth_code *c, int x, int y)
{
    if (!plane_holds(&b->position.z, x, y)) return 0.0;
    double v = plane_get(&b->position.z, x, y), z = background(b, v) ? 0.0 : depth_decode(c, v);
    if (c->kind == DEPTH_RADIAL && b->g->camera.kind == CAMERA_PERSPECTIVE) z /= v3_length(build_ray(&b->g->camera, x, y));
    return z > 0.0 && isfinite(z) ? z : 0.0;
}

static bool point_of(const build *b, const void *context, int x, int y, vec3 *p)
{
    double z = x >= 0 && y >= 0 && x < b->g->width && y < b->g->height ? distance(b, context, x, y) : 0.0;
    if (!(z > 0.0)) return false;
    *p = build_point(&b->g->camera, x, y, z);
    return true;
}

static bool ask_normals(build *b, trial *t, evidence *v)
{
    verdict ignored = {0};
    normal_choice c;
    evidence_gather(b, point_of, &t->code, 1, SAMPLES, v);
    if (v->count == 0 || v->spread < 0.01) return true; // a wall fits every kind
    if (!normals_choose(b, v, &ignored, &c)) return false;
    if (c.one_way) return true; // constant normals say nothing
    t->fit = c.best.fit, t->loss = c.best.loss;
    return true;
}

// Along one axis: 1 a line, 0 a curve, -1 too level to tell.
static int straight(const build *b, const depth_code *c, int x, int y, int dx, int dy)
{
    double z[3], rounding = b->position.z.type == SAMPLE_HALF ? 0x1p-11 : 0x1p-24;
    for (int k = 0; k < 3; k++) {
        int u = x + (k - 1) * dx, v = y + (k - 1) * dy;
        z[k] = u >= 0 && v >= 0 && u < b->g->width && v < b->g->height ? distance(b, c, u, v) : 0.0;
        if (!(z[k] > 0.0)) return 0;
        if (b->g->camera.kind == CAMERA_PERSPECTIVE) z[k] = 1.0 / z[k];
    }
    double first = fabs(z[2] - z[0]), second = fabs(z[2] - 2.0 * z[1] + z[0]);
    if (first < 100.0 * rounding * fabs(z[1]) || first < 0.01 * fabs(z[1])) return -1;
    return second < bend * first + 4.0 * rounding * fabs(z[1]);
}

static void ask_planes(const build *b, trial *t)
{
    int shorter = b->g->width < b->g->height ? b->g->width : b->g->height, step = shorter / 40 > 2 ? shorter / 40 : 2;
    size_t stride = b->sample.count / SAMPLES + 1, flat = 0, all = 0;
    for (size_t i = 0; i < b->sample.count; i += stride) {
        int x = (int)b->sample.points[i].x, y = (int)b->sample.points[i].y;
        int across = straight(b, &t->code, x, y, step, 0), down = straight(b, &t->code, x, y, 0, step);
        all++;
        flat += across && down && (across > 0 || down > 0);
    }
    t->flat = all ? (double)flat / (double)all : 0.0;
}

static int list_trials(const build *b, const values *s, trial list[MOST], bool *range)
{
    const depth_code own = {.kind = b->g->depth_kind, .sign = b->position.code.sign};
    double near, far;
    int n = 0;
    list[n++].code = own;
    if (b->g->camera.kind == CAMERA_PERSPECTIVE) {
        list[n].code = own;
        list[n++].code.kind = own.kind == DEPTH_RADIAL ? DEPTH_PLANAR : DEPTH_RADIAL;
    }
    list[n].code = own;
    list[n++].code.kind = DEPTH_INVERSE;
    *range = find_range(b, &near, &far);
    for (int k = DEPTH_LINEAR; *range && s->beyond == 0 && k < DEPTH_KINDS; k++) {
        if (!(near > 0.0) && k >= DEPTH_ZBUFFER) break;
        if (k == DEPTH_NDC ? s->under > 0 : own.sign < 0.0 || both_signs(s)) continue;
        list[n++].code = (depth_code){.kind = (depth_kind)k, .sign = 1.0, .near = near, .far = far};
    }
    for (int i = 0; i < n; i++) list[i].fit = (double)NAN, list[i].loss = INFINITY, list[i].flat = 0.0;
    return n;
}

// Pixels at edges whose values a filter mixed spoil every kind's mean loss alike, but no median.
static bool fits_better(const trial *a, const trial *b)
{
    if (!(a->loss < b->loss) || !(a->fit >= fits)) return false;
    return b->loss - a->loss > gain[0] + gain[1] * b->loss ||
           (b->fit < 1.0 - gain[0] && 1.0 - a->fit < nearer * (1.0 - b->fit) && 4.0 * (b->loss - a->loss) > a->fit - b->fit);
}

static bool more_planes(const trial *a, const trial *b) { return a->flat > many_planes && a->flat > 3.0 * b->flat; }

// The normals decide if they fit one kind's surfaces; else the planes; else the renderer's usual kind.
static int choose(const trial *list, int n, bool *confirmed)
{
    int best = 0;
    for (int i = 1; i < n; i++)
        if (list[i].loss < list[best].loss && fits_better(&list[i], &list[0])) best = i;
    *confirmed = list[best].fit >= fits;
    for (int i = 0; i < n && *confirmed; i++) // as good by the normals
        if (list[i].fit >= fits && list[i].loss < list[best].loss + gain[0] && more_planes(&list[i], &list[best])) best = i;
    if (*confirmed) return best;
    best = 0;
    for (int i = 1; i < n; i++)
        if (list[i].flat > list[best].flat && more_planes(&list[i], &list[0])) best = i;
    *confirmed = list[best].flat > many_planes;
    return best;
}

static int find_kind(const trial *list, int n, depth_kind k)
{
    for (int i = 0; i < n; i++)
        if (list[i].code.kind == k) return i;
    return -1;
}

// Planes confirm 1 / z and every z-buffer alike. What stands for the background tells them apart, else outlines. *open: nothing
// does. False, with the error set, where it is a z-buffer without a range.
static bool settle_hyperbolic(build *b, const values *s, const trial *list, int n, int *best, bool *open)
{
    depth_kind k = list[*best].code.kind;
    if (k != DEPTH_INVERSE && k < DEPTH_ZBUFFER) return true;
    if (s->beyond > 0 || s->under > 0 || b->g->camera.kind != CAMERA_PERSPECTIVE) return true;
    bool told = b->options->depth_far > 0.0, zeros = marks_background(s, s->zero), ones = marks_background(s, s->one);
    depth_direction d = ones == zeros ? depth_find_direction(b, true) : ones ? LARGER_IS_FARTHER : LARGER_IS_NEARER;
    *open = d == LARGER_UNKNOWN && s->negative == 0;
    k = s->negative > 0 ? DEPTH_NDC : d == LARGER_IS_FARTHER ? DEPTH_ZBUFFER : told ? DEPTH_REVERSED : DEPTH_INVERSE;
    *best = find_kind(list, n, k);
    if (*best >= 0 && !(*open && told)) return true;
    return no_range(b, told ? "planes say that the depth is a z-buffer's, and nothing tells which of its ends is near"
                            : "the depth is a z-buffer's, which is no distance, and its near and far are not known");
}

static void tell(build *b, const trial *list, int n, int best)
{
    verdict *v = &b->g->depth_verdict;
    bool by_normals = list[best].fit == list[best].fit;
    v->measure = by_normals ? "median cosine of the normals with its surfaces" : "share of pixels on planes";
    v->fit = by_normals ? list[best].fit : list[best].flat, v->next = (double)NAN;
    for (int i = 0; i < n; i++) {
        double fit = by_normals ? list[i].fit : list[i].flat, loss = by_normals ? list[i].loss : 1.0 - list[i].flat;
        verdict_try(v, depth_text(list[i].code.kind), fit, loss);
        if (i != best && !(fit <= v->next)) v->next = fit;
    }
    snprintf(v->reading, sizeof v->reading, "%s%s", list[best].code.sign < 0.0 ? "negative " : "",
             depth_text(list[best].code.kind));
    build_note(b, "depth: %s, %s %.3f (next best %.3f)", v->reading, by_normals ? "normals fit" : "on planes", v->fit, v->next);
}

static void doubt(build *b, const char *why)
{
    b->g->depth_verdict.doubtful = true;
    log_warn(b->log, "depth-doubt",
             "the depth's values all lie within 0..1 and %s; it is taken as %s (--depth-kind says otherwise, --depth-range NEAR "
             "FAR where it runs between two distances)",
             why, b->g->depth_verdict.reading);
}

// Nearer surfaces may have the larger values, as of 1 / z. Outlines tell; else a background of 0, which 1 / z has, says that it
// may be so. Asked only if no other evidence decides.
static void question_direction(build *b, const values *s, const trial *best, bool confirmed)
{
    bool distance = s->beyond > 0 && s->negative == 0 && best->code.kind <= DEPTH_RADIAL;
    if (confirmed || !distance || b->g->camera.kind != CAMERA_PERSPECTIVE) return;
    depth_direction told = depth_find_direction(b, false);
    if (told == LARGER_IS_FARTHER || (told == LARGER_UNKNOWN && s->zero == 0)) return;
    b->g->depth_verdict.doubtful = true;
    log_warn(b->log, "depth-doubt",
             "%s, and neither normals nor planes confirm a kind; it is taken as %s (--depth-kind says what it is)",
             told == LARGER_IS_NEARER ? "outlines say that larger values of the depth lie nearer to the eye, as of 1 / z"
                                      : "the depth is 0 where there is nothing, as 1 / z is",
             b->g->depth_verdict.reading);
}

// Distances have one sign. Where a filter or a few broken pixels do not explain the other, it is no distance.
static void question_signs(build *b, const values *s, const trial *best)
{
    bool distance = best->code.kind <= DEPTH_INVERSE && b->g->camera.kind == CAMERA_PERSPECTIVE;
    if (!distance || !both_signs(s)) return;
    b->g->depth_verdict.doubtful = true;
    log_warn(b->log, "depth-doubt",
             "the depth has values of both signs, which no distance has; those of the lesser number count as nothing "
             "(--depth names another channel, --depth-kind says what it is)");
}

// Values within 0..1 may be distances of a small scene, or no distances at all.
static bool question(build *b, const values *s, const trial *best, bool confirmed, bool range)
{
    bool unit = s->beyond == 0 && s->under == 0 && s->within > 0, ones = marks_background(s, s->one);
    unit = unit && (s->negative == 0 || both_signs(s));
    question_direction(b, s, best, confirmed);
    question_signs(b, s, best);
    if (!unit || best->code.kind == DEPTH_INVERSE || depth_needs_range(best->code.kind)) return true;
    if (confirmed && ones)
        doubt(b, "1 stands for nothing: its unit may be the distance of the far plane, in which radii are then measured");
    else if (!confirmed && ones)
        return no_range(b, range ? "the depth runs from 0 to 1 and neither normals nor planes tell how"
                                 : "the depth runs from 0 to 1, which is no distance, and its near and far are not known");
    else if (!confirmed)
        doubt(b, "neither normals nor planes confirm a kind");
    return true;
}

bool depth_settle(build *b)
{
    gbuffer *g = b->g;
    verdict *v = &g->depth_verdict;
    v->present = b->position.has_z, v->fit = v->next = (double)NAN;
    if (b->position.has_p || !b->position.has_z || b->sample.count == 0) return true;
    if (b->r->depth_told) {
        snprintf(v->reading, sizeof v->reading, "%s, as told", depth_text(b->r->depth));
        return true;
    }
    trial list[MOST];
    values s = look(b);
    bool confirmed, range, open = false;
    int n = list_trials(b, &s, list, &range);
    evidence *scratch = mem_zero(1, sizeof *scratch, b->e);
    bool ok = scratch != NULL;
    for (int i = 0; ok && i < n; i++) {
        if (b->normal.there) ok = ask_normals(b, &list[i], scratch);
        ask_planes(b, &list[i]);
    }
    free(scratch);
    if (!ok) return false;
    int best = choose(list, n, &confirmed);
    if (confirmed && !(list[best].fit >= fits) && !settle_hyperbolic(b, &s, list, n, &best, &open)) return false;
    tell(b, list, n, best);
    if (open) doubt(b, "nothing tells 1 / z from a z-buffer's values");
    if (!question(b, &s, &list[best], confirmed, range)) return false;
    depth_kind kind = list[best].code.kind;
    if (kind <= DEPTH_RADIAL) {
        g->depth_kind = kind;
        return true;
    }
    g->depth_kind = DEPTH_PLANAR;
    b->position.code = list[best].code;
    return validity_find(b);
}
