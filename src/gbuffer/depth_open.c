// What a depth's values are: their signs and range, and the kind that an option gives them.
#include "gbuffer/depth_trial.h"

enum { LOOKED_AT = 40000 };
static const double most_ringing = 0.4,
                    ringing_share = 0.05; // past 0..1, of values that a filter with negative lobes leaves at edges
static const double same_grey = 0.01;     // of a value, by which a lossy compression may set R, G and B apart

bool depth_background(const build *b, double v)
{
    return !isfinite(v) || fabs(v) >= b->r->background_depth || (b->position.z.type == SAMPLE_HALF && fabs(v) >= 65504.0);
}

values depth_look(const build *b)
{
    values s = {0};
    size_t ringing = 0, below = 0;
    size_t pixels = (size_t)b->g->width * (size_t)b->g->height, stride = pixels / LOOKED_AT + 1;
    for (size_t i = 0; i < pixels; i += stride) {
        double v = plane_get(&b->position.z, (int)(i % (size_t)b->g->width), (int)(i / (size_t)b->g->width));
        if (depth_background(b, v)) continue;
        s.looked_at++, s.negative += v < 0.0, s.zero += v == 0.0, s.one += v == 1.0, s.under += v < -1.0;
        s.within += v > 0.0 && 1.0 > v, s.beyond += v > 1.0;
        ringing += v > 1.0 && v < 1.0 + most_ringing, below += v < 0.0 && v > -most_ringing;
    }
    if (s.beyond == ringing && (double)ringing < ringing_share * (double)s.looked_at) s.beyond = 0;
    if (s.negative == below && (double)below < ringing_share * (double)s.looked_at) s.negative = 0;
    return s;
}

// Both signs, more than a filter or a few broken pixels would leave.
bool depth_both_signs(const values *s)
{
    size_t positive = s->looked_at - s->negative - s->zero;
    return 50 * s->negative > s->looked_at && 50 * positive > s->looked_at;
}

bool depth_marks_background(const values *s, size_t count) { return 2000 * count > s->looked_at; }

// Near and far by an option, or by names that headers use.
bool depth_find_range(const build *b, double *near, double *far)
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

bool depth_no_range(build *b, const char *what)
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
    values s = depth_look(b);
    if (10 * s.negative > 9 * (s.looked_at - s.zero)) c->sign = s.looked_at > s.zero ? -1.0 : 1.0;
    if (!b->r->depth_told || b->r->depth <= DEPTH_RADIAL) return true;
    c->kind = b->r->depth;
    if (!depth_needs_range(c->kind)) return true;
    if (!depth_find_range(b, &c->near, &c->far)) return depth_no_range(b, "the depth's near and far are not known");
    if (c->near > 0.0 || c->kind == DEPTH_LINEAR || c->kind == DEPTH_INVERTED) return true;
    return depth_no_range(b, "a z-buffer's near lies at 0, which says nothing about depth");
}
