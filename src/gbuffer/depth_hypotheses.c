// Finds the kind of a depth where the file has no positions. Two kinds of evidence decide; neither needs the scale:
// - the file's normals: they fit the surfaces only if the depth is read as the right kind;
// - planes: 1 / z is linear across a perspective picture of a plane (z across an orthographic one), again only for the right
// kind. 1 / z and a z-buffer's values differ by a scale and an offset, so that planes do not tell them apart: what stands for
// the background does, or outlines (depth_direction.c).
// If neither decides, the renderer's usual kind is taken, unless all values lie within 0..1 and so can hardly be distances.
#include <stdio.h>
#include <stdlib.h>

#include "base/mem.h"
#include "gbuffer/depth_trial.h"

static const double bend = 1e-3;  // of a plane's profile
static const double equal = 2e-4; // losses that differ by less are as good as each other

static int list_trials(const build *b, const values *s, trial list[MOST_TRIALS], bool *range)
{
    const depth_code own = {.kind = b->g->depth_kind, .sign = b->position.code.sign};
    depth_code other = own;
    double near, far;
    int n = 0;
    trial_start(&list[n++], own);
    other.kind = own.kind == DEPTH_RADIAL ? DEPTH_PLANAR : DEPTH_RADIAL;
    if (b->g->camera.kind == CAMERA_PERSPECTIVE) trial_start(&list[n++], other);
    other.kind = DEPTH_INVERSE;
    trial_start(&list[n++], other);
    *range = depth_find_range(b, &near, &far);
    for (int k = DEPTH_LINEAR; *range && s->beyond == 0 && k < DEPTH_KINDS; k++) {
        if (!(near > 0.0) && k >= DEPTH_ZBUFFER) break;
        if (k == DEPTH_NDC ? s->under > 0 : own.sign < 0.0 || depth_both_signs(s)) continue;
        trial_start(&list[n++], (depth_code){.kind = (depth_kind)k, .sign = 1.0, .near = near, .far = far});
    }
    return n;
}

// The normals decide if they fit one kind's surfaces; else the planes; else the renderer's usual kind.
static int choose(const trial *list, int n, bool *confirmed)
{
    int best = 0;
    for (int i = 1; i < n; i++)
        if (list[i].loss < list[best].loss && trial_fits_better(&list[i], &list[0])) best = i;
    *confirmed = trial_has_normals(&list[best]);
    for (int i = 0; i < n && *confirmed; i++) // as good by the normals
        if (trial_has_normals(&list[i]) && list[i].loss < list[best].loss + equal && trial_more_planes(&list[i], &list[best]))
            best = i;
    if (*confirmed) return best;
    best = 0;
    for (int i = 1; i < n; i++)
        if (list[i].flat > list[best].flat && trial_more_planes(&list[i], &list[0])) best = i;
    *confirmed = trial_has_planes(&list[best]);
    return best;
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
    trial list[MOST_TRIALS];
    values s = depth_look(b);
    bool confirmed, range, open = false;
    int n = list_trials(b, &s, list, &range);
    evidence *scratch = mem_zero(1, sizeof *scratch, b->e);
    bool ok = scratch != NULL;
    for (int i = 0; ok && i < n; i++) {
        if (b->normal.there) ok = trial_ask_normals(b, &list[i], scratch);
        trial_ask_planes(b, &list[i], bend);
    }
    int best = ok ? choose(list, n, &confirmed) : 0;
    ok = ok && depth_question_curve(b, &s, &list[best], scratch);
    free(scratch);
    if (!ok) return false;
    if (confirmed && !trial_has_normals(&list[best]) && !depth_settle_hyperbolic(b, &s, list, n, &best, &open)) return false;
    tell(b, list, n, best);
    if (open) depth_doubt(b, "nothing tells 1 / z from a z-buffer's values");
    if (!depth_question(b, &s, list, n, best, confirmed, range)) return false;
    depth_kind kind = list[best].code.kind;
    if (kind <= DEPTH_RADIAL) {
        g->depth_kind = kind;
        return true;
    }
    g->depth_kind = DEPTH_PLANAR;
    b->position.code = list[best].code;
    return validity_find(b);
}
