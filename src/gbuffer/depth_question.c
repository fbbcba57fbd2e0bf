// What the evidence leaves open about a depth: doubts, and readings that need to be told more.
#include "gbuffer/depth_direction.h"
#include "gbuffer/depth_trial.h"

static int find_kind(const trial *list, int n, depth_kind k)
{
    for (int i = 0; i < n; i++)
        if (list[i].code.kind == k) return i;
    return -1;
}

// Planes confirm 1 / z and every z-buffer alike. What stands for the background tells them apart, else outlines. *open: nothing
// does. False, with the error set, where it is a z-buffer without a range.
bool depth_settle_hyperbolic(build *b, const values *s, const trial *list, int n, int *best, bool *open)
{
    depth_kind k = list[*best].code.kind;
    if (k != DEPTH_INVERSE && k < DEPTH_ZBUFFER) return true;
    if (s->beyond > 0 || s->under > 0 || b->g->camera.kind != CAMERA_PERSPECTIVE) return true;
    bool told = b->options->depth_far > 0.0, zeros = depth_marks_background(s, s->zero), ones = depth_marks_background(s, s->one);
    depth_direction d = ones == zeros ? depth_find_direction(b, true) : ones ? LARGER_IS_FARTHER : LARGER_IS_NEARER;
    *open = d == LARGER_UNKNOWN && s->negative == 0;
    k = s->negative > 0 ? DEPTH_NDC : d == LARGER_IS_FARTHER ? DEPTH_ZBUFFER : told ? DEPTH_REVERSED : DEPTH_INVERSE;
    *best = find_kind(list, n, k);
    if (*best >= 0 && !(*open && told)) return true;
    return depth_no_range(b, told ? "planes say that the depth is a z-buffer's, and nothing tells which of its ends is near"
                                  : "the depth is a z-buffer's, which is no distance, and its near and far are not known");
}

void depth_doubt(build *b, const char *why)
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
    if (!distance || !depth_both_signs(s)) return;
    b->g->depth_verdict.doubtful = true;
    log_warn(b->log, "depth-doubt",
             "the depth has values of both signs, which no distance has; those of the lesser number count as nothing "
             "(--depth names another channel, --depth-kind says what it is)");
}

// A z-buffer of -1..1 has no negative values if all surfaces lie beyond twice the near plane. Read as 0..1 they all come out
// nearer, in nearly the same shapes.
static void question_ends(build *b, const values *s, const trial *list, int n, const trial *best)
{
    bool ndc = best->code.kind == DEPTH_NDC;
    int other = find_kind(list, n, ndc ? DEPTH_ZBUFFER : DEPTH_NDC);
    if ((!ndc && best->code.kind != DEPTH_ZBUFFER) || other < 0 || s->negative > 0) return;
    if (trial_has_normals(best) && trial_fits_better(best, &list[other])) return;
    b->g->depth_verdict.doubtful = true;
    log_warn(b->log, "depth-doubt",
             "nothing tells a z-buffer's 0..1 from a -1..1 whose values are all positive; the depth is taken as %s (--depth-kind "
             "zbuffer or ndc says what it is)",
             b->g->depth_verdict.reading);
}

// Values within 0..1 may be distances of a small scene, or no distances at all.
bool depth_question(build *b, const values *s, const trial *list, int n, int at, bool confirmed, bool range)
{
    const trial *best = &list[at];
    bool unit = s->beyond == 0 && s->under == 0 && s->within > 0, ones = depth_marks_background(s, s->one);
    unit = unit && (s->negative == 0 || depth_both_signs(s));
    question_direction(b, s, best, confirmed);
    question_signs(b, s, best);
    question_ends(b, s, list, n, best);
    if (!unit || best->code.kind == DEPTH_INVERSE || depth_needs_range(best->code.kind)) return true;
    if (confirmed && ones)
        depth_doubt(b, "1 stands for nothing: its unit may be the distance of the far plane, in which radii are then measured");
    else if (!confirmed && ones)
        return depth_no_range(b, range ? "the depth runs from 0 to 1 and neither normals nor planes tell how"
                                       : "the depth runs from 0 to 1, which is no distance, and its near and far are not known");
    else if (!confirmed)
        depth_doubt(b, "neither normals nor planes confirm a kind");
    return true;
}
