// The normals as stored are decoded in every way and held against the surfaces' own. For one encoding the correlation of both is
// a 3 x 3 matrix, of which every rotation's mean cosine is a dot product: all of some hundred signed permutations of the axes of
// every known space cost next to nothing, and their best is an unknown rotation's competitor. The few that lead are then compared
// sample by sample.
//
// A reading displaces one that is likelier beforehand only if its gain is real: larger than chance by six standard errors of the
// paired differences, and larger than the margin of its kind. On a picture that several readings fit (a wall) the likeliest
// stays.
#include "gbuffer/normal_hypotheses.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "gbuffer/rotation.h"
#include "gbuffer/solve.h"

enum { AXES = 48, LEAST = 8 };
static const double most_loss = 0.3;     // of a sample: 45 degrees off is as wrong as can be
static const double odd_length = 0.15;   // median | |n| - 1 | beyond which a 0..1 decoding was none
static const double certain = 6.0;       // standard errors
static const double least_second = 0.05; // singular value, of the first, below which a rotation is open
static const double least_turn = 1.5;    // degrees: a nearer rotation is the named reading itself
static const double least_spread = 0.02; // of the surfaces, for normals to be asked whether they follow it

// What a reading of a kind must gain in mean loss over a likelier one.
static const struct {
    double gain, share;
} margins[KINDS] = {[KIND_PLAIN] = {2e-4, 0.0}, [KIND_TURNED] = {5e-4, 0.1}, [KIND_ESTIMATE] = {4e-4, 0.05}};

typedef struct decoded {
    vec3 unit[EVIDENCE_SAMPLES]; // 0 where there is none
    mat3 correlation;            // mean of w surface unit^T
    double odd;                  // median | |n| - 1 | of what was coded as 0..1
    bool there;
} decoded;

typedef struct search {
    const build *b;
    const evidence *v;
    decoded *decoded; // one an encoding
    pass_space space; // of an option
    normal_encoding encoding;
    reading best[KINDS]; // of each kind
    bool has[KINDS];
    verdict *list;
} search;

static mat3 outer(vec3 d, vec3 s, double w)
{
    return (mat3){{{w * d.x * s.x, w * d.x * s.y, w * d.x * s.z},
                   {w * d.y * s.x, w * d.y * s.y, w * d.y * s.z},
                   {w * d.z * s.x, w * d.z * s.y, w * d.z * s.z}}};
}

static void accumulate(mat3 *sum, mat3 m)
{
    for (int i = 0; i < 9; i++) sum->m[i / 3][i % 3] += m.m[i / 3][i % 3];
}

// 0..1, with what a filter's negative lobes add at edges.
static bool within_unorm(vec3 s) { return fmin(s.x, fmin(s.y, s.z)) > -0.3 && fmax(s.x, fmax(s.y, s.z)) < 1.4; }

static bool decode_all(const evidence *v, normal_encoding e, decoded *out)
{
    double off[EVIDENCE_SAMPLES];
    size_t n = 0, beyond = 0;
    for (size_t i = 0; i < v->count && e != NORMAL_SIGNED; i++) beyond += !within_unorm(v->stored[i]);
    if (20 * beyond > v->count) return false;
    out->correlation = (mat3){{{0}}};
    for (size_t i = 0; i < v->count; i++) {
        vec3 s = encoding_decode(e, v->stored[i]);
        double length = v3_length(s);
        out->unit[i] = v3_normalize(s);
        if (!(length > 0.0) || !isfinite(length)) continue;
        off[n++] = fabs(length - 1.0);
        accumulate(&out->correlation, outer(v->surface[i], out->unit[i], v->weight[i]));
    }
    // Normals need not have unit length, but what was coded as 0..1 had it before.
    out->odd = e == NORMAL_SIGNED ? 0.0 : solve_median(off, n);
    out->there = n >= LEAST && out->odd < odd_length;
    return out->there;
}

static double product(mat3 a, mat3 b)
{
    double sum = 0.0;
    for (int i = 0; i < 9; i++) sum += a.m[i / 3][i % 3] * b.m[i / 3][i % 3];
    return sum;
}

static double loss_of(const search *s, const reading *r, size_t i)
{
    vec3 n = s->decoded[r->encoding].unit[i];
    if (!(v3_dot(n, n) > 0.5)) return most_loss;
    return fmin(1.0 - v3_dot(m3_apply(r->to_camera, n), s->v->surface[i]), most_loss);
}

// Of two curves that decode to about the same directions the one that makes unit vectors is the right one.
static double mean_loss(const search *s, const reading *r)
{
    double sum = 0.1 * s->decoded[r->encoding].odd;
    for (size_t i = 0; i < s->v->count; i++) sum += s->v->weight[i] * loss_of(s, r, i);
    return sum;
}

// Whether b's gain over a is more than chance and more than the margin.
static bool displaces(const search *s, const reading *b, const reading *a, reading_kind k)
{
    double gain = a->loss - b->loss, variance = 0.0;
    if (!(gain > margins[k].gain + margins[k].share * a->loss)) return false;
    for (size_t i = 0; i < s->v->count; i++) {
        double d = s->v->weight[i] * (loss_of(s, a, i) - loss_of(s, b, i) - gain);
        variance += d * d;
    }
    return gain > certain * sqrt(variance);
}

// Takes the reading as the best of its kind if it has the smaller loss.
static void offer(search *s, reading r, reading_kind k)
{
    r.kind = k;
    r.loss = mean_loss(s, &r);
    char name[VERDICT_TEXT];
    reading_describe(s->b, &r, name, sizeof name);
    verdict_try(s->list, name, (double)NAN, r.loss);
    if (s->has[k] && s->best[k].loss <= r.loss) return;
    s->best[k] = r, s->has[k] = true;
}

static mat3 signs(double x, double y, double z) { return (mat3){{{x, 0, 0}, {0, y, 0}, {0, 0, z}}}; }

// The 48 orders and signs of the axes.
static mat3 axes(int k)
{
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    mat3 s = {{{0}}};
    for (int row = 0; row < 3; row++) s.m[row][orders[k / 8][row]] = k >> row & 1 ? -1.0 : 1.0;
    return s;
}

// The best of base with the axes turned, before it (the stored axes) or after it (the camera's).
static void offer_turned(search *s, normal_encoding e, reading_source source, mat3 base, bool before, bool inverse)
{
    reading best = {.encoding = e, .source = source, .inverse = inverse};
    double most = -INFINITY;
    for (int k = 0; k < AXES; k++) {
        mat3 r = before ? m3_mul(base, axes(k)) : m3_mul(axes(k), base);
        double cosine = product(r, s->decoded[e].correlation);
        if (cosine > most) most = cosine, best.to_camera = r, best.turned = axes(k);
    }
    offer(s, best, KIND_TURNED);
}

// The rotation or reflection that fits best, in three rounds of which the later ones leave outliers out.
static bool estimate(const search *s, normal_encoding e, double determinant, mat3 *r)
{
    const decoded *d = &s->decoded[e];
    mat3 m = d->correlation;
    double second;
    for (int round = 0;; round++) {
        if (!rotation_between(m, determinant, r, &second) || second < least_second) return false;
        if (round == 3) return true;
        m = (mat3){{{0}}};
        for (size_t i = 0; i < s->v->count; i++)
            if (v3_dot(m3_apply(*r, d->unit[i]), s->v->surface[i]) > 1.0 - most_loss)
                accumulate(&m, outer(s->v->surface[i], d->unit[i], s->v->weight[i]));
    }
}

static mat3 known_rotation(const build *b) { return m3_transpose(b->g->camera.world_from_camera); }
static mat3 header_rotation(const build *b) { return m3_transpose(m3_mul(b->camera.header.axes, b->camera.header.from_ours)); }

// The named readings of one encoding.
static void offer_named(search *s, normal_encoding e)
{
    static const double eyes[3][3] = {{1, -1, -1}, {1, -1, 1}, {1, 1, 1}}; // y up, z back; y up, z forward; our own
    const build *b = s->b;
    const mat3 none = m3_identity(), inwards = signs(-1, -1, -1);
    reading_kind k = e == NORMAL_SIGNED || e == NORMAL_UNORM ? KIND_PLAIN : KIND_TURNED;
    bool known_is_camera = b->g->position_is_camera_space;
    bool world = s->space != SPACE_CAMERA, eye = s->space != SPACE_WORLD;
    for (int side = 0; side < 2; side++) {
        reading r = {.encoding = e, .turned = side ? inwards : none};
        if (b->camera.has_rotation && (known_is_camera ? eye : world)) {
            r.source = FROM_KNOWN, r.to_camera = m3_mul(r.turned, known_rotation(b));
            offer(s, r, side ? KIND_TURNED : k);
        }
        if (b->camera.has_header_pose && world) {
            r.source = FROM_HEADER, r.to_camera = m3_mul(r.turned, header_rotation(b));
            offer(s, r, side ? KIND_TURNED : k);
        }
        for (int i = 0; i < 3 && eye; i++) {
            r.source = FROM_CAMERA, r.turned = m3_mul(side ? inwards : none, signs(eyes[i][0], eyes[i][1], eyes[i][2]));
            r.to_camera = r.turned;
            offer(s, r, side ? KIND_TURNED : k);
        }
    }
    if (b->camera.has_rotation && (known_is_camera ? eye : world)) offer_turned(s, e, FROM_KNOWN, known_rotation(b), true, false);
    if (b->camera.has_header_pose && world) {
        offer_turned(s, e, FROM_HEADER, m3_transpose(b->camera.header.axes), false, false);
        offer_turned(s, e, FROM_HEADER, b->camera.header.axes, false, true);
    }
    if (eye) offer_turned(s, e, FROM_CAMERA, m3_identity(), false, false);
}

static void offer_estimates(search *s, normal_encoding e)
{
    for (int side = 0; side < 2; side++) {
        reading r = {.encoding = e, .source = FROM_ESTIMATE, .turned = m3_identity()};
        if (estimate(s, e, side ? -1.0 : 1.0, &r.to_camera)) offer(s, r, KIND_ESTIMATE);
    }
}

// What the renderer's row promises.
static void offer_own(search *s)
{
    const build *b = s->b;
    bool world = s->space == SPACE_WORLD || (s->space == SPACE_UNKNOWN && b->row->normal_space != SPACE_CAMERA);
    reading r = {.encoding = s->encoding != NORMAL_AUTO ? s->encoding : b->row->normal_encoding, .turned = m3_identity()};
    if (!s->decoded[r.encoding].there) r.encoding = NORMAL_SIGNED;
    if (!s->decoded[r.encoding].there) return;
    bool known_serves = b->camera.has_rotation && (!b->g->position_is_camera_space || s->space != SPACE_WORLD);
    if (world && known_serves)
        r.source = FROM_KNOWN, r.to_camera = known_rotation(b);
    else if (world && b->camera.has_header_pose)
        r.source = FROM_HEADER, r.to_camera = header_rotation(b);
    else if (s->space == SPACE_WORLD)
        return; // a world that only the normals know
    else
        r.source = FROM_CAMERA, r.turned = r.to_camera = signs(1, -1, -1);
    offer(s, r, KIND_OWN);
}

typedef struct weighed {
    double value, weight;
} weighed;

static int by_value(const void *a, const void *b)
{
    double x = ((const weighed *)a)->value, y = ((const weighed *)b)->value;
    return (x > y) - (x < y);
}

// Half of the weight lies at or above it.
static double median_cosine(const search *s, const reading *r)
{
    weighed all[EVIDENCE_SAMPLES];
    size_t n = 0;
    double sum = 0.0, below = 0.0;
    for (size_t i = 0; i < s->v->count; i++) {
        double c = v3_dot(m3_apply(r->to_camera, s->decoded[r->encoding].unit[i]), s->v->surface[i]);
        all[n++] = (weighed){c, s->v->weight[i]};
        sum += s->v->weight[i];
    }
    qsort(all, n, sizeof *all, by_value);
    for (size_t i = 0; i < n; i++)
        if ((below += all[i].weight) >= 0.5 * sum) return all[i].value;
    return 0.0;
}

// Correlation of both about their means. *scatter: of the normals, over that of the surfaces. A normal that looks away is that of
// a surface seen from its back, and is turned when it is read (normals.c).
static double follows(const search *s, const reading *r, double *scatter)
{
    vec3 n = {0}, d = {0};
    double both = 0.0, weight = 0.0;
    *scatter = 1.0;
    for (size_t i = 0; i < s->v->count; i++) {
        vec3 unit = s->decoded[r->encoding].unit[i];
        if (!(v3_dot(unit, unit) > 0.5)) continue;
        unit = m3_apply(r->to_camera, unit);
        if (v3_dot(unit, s->v->surface[i]) < 0.0) unit = v3_scale(unit, -1.0);
        double w = s->v->weight[i];
        weight += w;
        n = v3_add(n, v3_scale(unit, w)), d = v3_add(d, v3_scale(s->v->surface[i], w));
        both += w * v3_dot(unit, s->v->surface[i]);
    }
    if (!(weight > 0.0)) return 0.0;
    n = v3_scale(n, 1.0 / weight), d = v3_scale(d, 1.0 / weight);
    double normals = 1.0 - v3_dot(n, n), surfaces = 1.0 - v3_dot(d, d);
    if (surfaces < least_spread) return 1.0;
    *scatter = normals / surfaces;
    if (!(normals > 1e-9)) return 0.0;
    return (both / weight - v3_dot(n, d)) / sqrt(normals * surfaces);
}

static void put_fit(const search *s, const reading *r, double fit)
{
    char name[VERDICT_TEXT];
    reading_describe(s->b, r, name, sizeof name);
    for (int i = 0; i < s->list->count; i++)
        if (strcmp(s->list->tried[i].name, name) == 0) s->list->tried[i].fit = fit;
}

static bool settle(const search *s, normal_choice *out)
{
    int chosen = -1;
    for (int k = 0; k < KINDS; k++) {
        if (!s->has[k]) continue;
        if (chosen >= 0 && !displaces(s, &s->best[k], &out->best, (reading_kind)k)) continue;
        if (k == KIND_ESTIMATE && chosen >= 0 &&
            rotation_angle(m3_mul(s->best[k].to_camera, m3_transpose(out->best.to_camera))) < least_turn)
            continue;
        out->best = s->best[k], chosen = k;
    }
    if (chosen < 0) return false;
    double scatter;
    out->best.fit = median_cosine(s, &out->best);
    put_fit(s, &out->best, out->best.fit);
    out->best.follows = follows(s, &out->best, &scatter);
    out->one_way = scatter < 0.2;
    mat3 ideal;
    out->turn = estimate(s, out->best.encoding, m3_det(out->best.to_camera), &ideal)
                    ? rotation_angle(m3_mul(ideal, m3_transpose(out->best.to_camera)))
                    : 0.0;
    out->next = (double)NAN;
    for (int k = 0; k < KINDS; k++) {
        if (!s->has[k] || s->best[k].encoding == out->best.encoding) {
            mat3 apart = m3_mul(s->best[k].to_camera, m3_transpose(out->best.to_camera));
            if (!s->has[k] || rotation_angle(apart) < least_turn) continue;
        }
        double fit = median_cosine(s, &s->best[k]);
        put_fit(s, &s->best[k], fit);
        if (!(fit <= out->next)) out->next = fit;
    }
    return true;
}

bool normals_choose(const build *b, const evidence *v, verdict *list, normal_choice *out)
{
    *out = (normal_choice){.best = {.to_camera = m3_identity()}, .next = (double)NAN};
    search s = {.b = b, .v = v, .list = list, .space = b->options->normal_space};
    s.encoding = b->options->encoding_told ? b->options->normal_encoding : NORMAL_AUTO;
    s.decoded = mem_zero(NORMAL_ENCODINGS, sizeof *s.decoded, b->e);
    if (!s.decoded) return false;
    for (int e = 0; e < NORMAL_ENCODINGS; e++)
        if (s.encoding == NORMAL_AUTO || s.encoding == (normal_encoding)e) decode_all(v, (normal_encoding)e, &s.decoded[e]);
    offer_own(&s);
    for (int e = 0; e < NORMAL_ENCODINGS; e++) {
        if (!s.decoded[e].there) continue;
        offer_named(&s, (normal_encoding)e);
        offer_estimates(&s, (normal_encoding)e);
    }
    settle(&s, out);
    free(s.decoded);
    return true;
}
