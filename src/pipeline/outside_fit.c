#include "pipeline/outside_fit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/sort.h"
#include "pipeline/filter.h"
#include "pipeline/outside_shares.h"
#include "pipeline/settings.h"

enum {
    MOST_PIXELS = 1 << 14, // of the small frame
    SAMPLES = 16,          // a pixel: that there are many pixels makes up for the noise
};

// Where the albedo is darker, the quotient of beauty and albedo says more about the noise than about the light.
static const float LEAST_ALBEDO = 0.05f;

// ---- what is seen

// r g b of the diffuse light before albedo and 1, or zeros where it is not known.
static void light_of_pixel(const gbuffer *g, size_t i, float out[4])
{
    memset(out, 0, 4 * sizeof *out);
    if (!(g->depth[i] > 0.0f) || (g->coverage && g->coverage[i] < 1.0f)) return;
    const float *a = g->albedo ? g->albedo + 4 * i : NULL, *d = g->diffuse_direct ? g->diffuse_direct + 4 * i : NULL;
    for (int k = 0; k < 3; k++) {
        if (!d && !(a[k] >= LEAST_ALBEDO)) return;
        float light = d ? d[k] : (g->beauty[4 * i + (size_t)k] - (g->emission ? g->emission[4 * i + (size_t)k] : 0.0f)) / a[k];
        out[k] = light > 0.0f ? light : 0.0f;
    }
    out[3] = 1.0f;
}

static void drop(float **array, bool needed)
{
    if (needed) return;
    free(*array);
    *array = NULL;
}

// One pixel of each step x step of a frame, with its light as beauty.
static bool pick(const gbuffer *g, int step, gbuffer *out, error *e)
{
    *out = (gbuffer){.width = g->width / step, .height = g->height / step, .camera = g->camera, .valid = g->valid};
    out->data_window = out->display_window = (box2){0, 0, out->width - 1, out->height - 1};
    out->camera.fx /= step, out->camera.fy /= step;
    out->camera.cx = (g->camera.cx - step / 2 - 0.5) / step + 0.5, out->camera.cy = (g->camera.cy - step / 2 - 0.5) / step + 0.5;
    size_t pixels = (size_t)out->width * (size_t)out->height;
    if (!(out->depth = mem_pixels(pixels, sizeof(float), e)) || !(out->normal = mem_pixels(4 * pixels, sizeof(float), e)) ||
        !(out->beauty = mem_pixels(4 * pixels, sizeof(float), e)) ||
        (g->albedo && !(out->albedo = mem_pixels(4 * pixels, sizeof(float), e)))) {
        gbuffer_free(out);
        return false;
    }
    for (size_t to = 0; to < pixels; to++) {
        size_t x = to % (size_t)out->width, y = to / (size_t)out->width, n = (size_t)step;
        size_t from = (y * n + n / 2) * (size_t)g->width + x * n + n / 2;
        out->depth[to] = g->depth[from];
        memcpy(out->normal + 4 * to, g->normal + 4 * from, 4 * sizeof(float));
        if (g->albedo) memcpy(out->albedo + 4 * to, g->albedo + 4 * from, 4 * sizeof(float));
        light_of_pixel(g, from, out->beauty + 4 * to);
    }
    return true;
}

static bool is_larger(const gbuffer *g, int step, size_t pixels)
{
    return (size_t)(g->width / step) * (size_t)(g->height / step) > pixels;
}

bool outside_fit_gather(const job *j, frame_result *r, error *e)
{
    gbuffer *g = &r->gb, lit, next;
    if (!r->plan.need_to_fit) return true;
    bool seen = g->diffuse_direct || (g->beauty && g->albedo), ok = true;
    if (seen && g->valid > 0) {
        int step = 1;
        while (is_larger(g, 2 * step, 4 * MOST_PIXELS)) step *= 2; // so that each pixel in the end is a mean of at least four
        ok = pick(g, step, &lit, e);
        for (bool first = true; ok && (first || is_larger(&lit, 1, MOST_PIXELS)); first = false) {
            ok = gbuffer_halve(&lit, j->threads, &next, e);
            gbuffer_free(&lit);
            lit = next;
        }
        if (ok) r->lit = lit, r->lit_direct = g->diffuse_direct;
        for (size_t i = 0; ok && i < (size_t)lit.width * (size_t)lit.height; i++) lit.normal[4 * i + 3] = 0.0f;
    }
    drop(&g->beauty, r->plan.need & (NEED_BEAUTY | NEED_BACKGROUND));
    drop(&g->albedo, r->plan.need & NEED_ALBEDO);
    drop(&g->emission, r->plan.need & NEED_EMISSION);
    drop(&g->diffuse_direct, r->plan.need & NEED_DIFFUSE_LIGHT);
    return ok;
}

// ---- what would be seen

typedef struct model {
    job *j;
    const frame_result *r;
    job_light *light;
    plan plan;
    pass_settings set;
    openness walls;
    size_t pixels;
    float *column[SHARE_COLUMNS];
} model;

static bool estimate(const model *m, const openness *o, bool views, float *radiance, float *indirect, error *e)
{
    pass_settings set = m->set;
    plan p = m->plan;
    set.outside = *o;
    set.outside.low = m->walls.low, set.outside.high = m->walls.high;
    p.bounce = indirect != NULL;
    p.layers |= indirect ? 1u << LAYER_INDIRECT : 0u;
    return filter_estimate(m->j, &m->r->lit, m->light, &p, &set, &m->r->planes, views, radiance, indirect, e);
}

// The box about what is seen, but for the outermost 2 % on each side.
static bool find_walls(const model *m, openness *o, error *e)
{
    const gbuffer *g = &m->r->lit;
    float *place = mem_pixels(m->pixels, sizeof *place, e);
    if (!place) return false;
    for (int axis = 0; axis < 3; axis++) {
        size_t n = 0;
        for (int y = 0; y < g->height; y++)
            for (int x = 0; x < g->width; x++) {
                vec3 p = v3_add(m->set.upright_eye, m3_apply(m->set.upright_from_camera, gbuffer_position(g, x, y)));
                if (g->depth[(size_t)y * (size_t)g->width + (size_t)x] > 0.0f)
                    place[n++] = (float)(axis == 0 ? p.x : axis == 1 ? p.y : p.z);
            }
        sort_floats(place, n);
        double low = (double)place[n / 50], high = (double)place[n - 1 - n / 50];
        *(axis == 0 ? &o->low.x : axis == 1 ? &o->low.y : &o->low.z) = low;
        *(axis == 0 ? &o->high.x : axis == 1 ? &o->high.y : &o->high.z) = high;
    }
    free(place);
    return true;
}

// All but the bounce's, which depends on the shares.
static bool estimate_columns(model *m, error *e)
{
    for (int k = 0; k < SHARE_COLUMNS; k++) {
        openness o = openness_even(0.0);
        o.suns = k == SHARE_SUNS ? 1.0 : 0.0;
        if (k < OPENNESS_COUNT) o.share[k] = 1.0;
        if (!(m->column[k] = mem_zero(3 * m->pixels, sizeof(float), e))) return false;
        if (k != SHARE_BOUNCE && !estimate(m, &o, true, m->column[k], NULL, e)) return false;
    }
    for (int k = 0; k < SHARE_BOUNCE; k++)
        for (size_t i = 0; i < 3 * m->pixels; i++) m->column[k][i] -= m->column[SHARE_CLOSED][i];
    return true;
}

// ---- the shares

static openness openness_of(const model *m, const double x[SHARE_UNKNOWNS])
{
    openness o = {.suns = x[SHARE_SUNS], .low = m->walls.low, .high = m->walls.high};
    memcpy(o.share, x, sizeof o.share);
    return o;
}

// A beauty holds the light that bounces too. It depends on the shares, so each time round it is that of the last ones.
static bool fit_with_bounce(model *m, const double prior[SHARE_UNKNOWNS], shares *s, error *e)
{
    enum { ROUNDS = 4 };
    float *radiance = mem_pixels(3 * m->pixels, sizeof *radiance, e);
    bool ok = radiance;
    for (int round = 0; ok && round < ROUNDS; round++) {
        const openness o = openness_of(m, s->x);
        ok = estimate(m, &o, true, radiance, m->column[SHARE_BOUNCE], e);
        if (ok) shares_fit(&m->r->lit, m->column, prior, s);
    }
    free(radiance);
    return ok;
}

// ---- whether it is asked, and believed

// What is left of the picture's light may have at most this root mean square, over that of the light: what a black picture leaves
// is 1.
static const double MOST_LEFT = 0.9;
// The same where nobody said that the environment lit the picture, and the picture shows no roof. Then it must be dark too: up to
// the third of these shares of what the open sky would give, the outside is as fitted; from the second one on it is open.
static const double MOST_LEFT_UNASKED = 0.6, MOST_LIGHT = 0.5, SURE_LIGHT = 0.25;
// It must be unlike an open sky's, too, which another exposure leaves as it is. Open places have .07 to .13, covered ones .53 to
// .96 (`unlike`, tests/bench/RESULTS.md).
// And the shares must explain clearly more of it than that sky does: light of another environment they do not.
static const double UNLIKE = 0.3, MOST_OF_UNLIKE = 0.85;

// More than this many times what the open sky would give, bounces included, is not that sky's light.
static const double TOO_BRIGHT = 2.0;

// Whether the frame shows more background than surfaces: that is an open place.
static bool shows_background(const gbuffer *g) { return (double)g->valid < 0.5 * (double)g->width * (double)g->height; }

// The picture's light beside that with all open, whatever further G-buffers show: where they close what is open, a picture is not
// too bright for its sky.
static bool compare_light(const model *m, light_comparison *found, error *e)
{
    const openness open = openness_even(1.0);
    float *light = mem_pixels(3 * m->pixels, sizeof *light, e);
    bool ok = light && estimate(m, &open, false, light, NULL, e);
    if (ok) *found = shares_compare(&m->r->lit, light);
    free(light);
    return ok;
}

// light: the picture's over that with all open. Where no single direction is seen to matter, that is how open it is taken to be,
// if the prior is not less.
static bool fit_shares(model *m, const openness *prior, double light, shares *s, error *e)
{
    double before[SHARE_UNKNOWNS];
    for (int k = 0; k < SHARE_UNKNOWNS; k++) before[k] = fmin(openness_mean(prior), light);
    before[SHARE_BOUNCE] = 1.0;
    memcpy(s->x, before, sizeof before);
    bool ok = estimate_columns(m, e);
    if (ok && m->r->lit_direct) shares_fit(&m->r->lit, m->column, before, s);
    if (ok && !m->r->lit_direct) ok = fit_with_bounce(m, before, s, e);
    for (int k = 0; k < SHARE_COLUMNS; k++) free(m->column[k]);
    return ok;
}

static void say(job *j, const frame_result *r, const openness *o, double unexplained)
{
    log_info(
        j->log,
        "outside: %.2g of the unseen directions are open, fitted to the picture's %s light, of which %.2g is left unexplained",
        openness_mean(o), r->lit_direct ? "direct" : "diffuse", unexplained);
    for (int row = 0; row <= OPENNESS_ROWS + 1; row++) {
        char text[128] = "";
        bool pole = row == 0 || row == OPENNESS_ROWS + 1;
        for (int i = 0; i < (pole ? 1 : OPENNESS_COLUMNS); i++)
            snprintf(text + strlen(text), sizeof text - strlen(text), " %.2f",
                     o->share[pole ? row > 0 : 2 + (row - 1) * OPENNESS_COLUMNS + i]);
        log_info(j->log, "outside: %3d degrees from the zenith:%s", 180 * row / (OPENNESS_ROWS + 1), text);
    }
}

static model model_of(job *j, const frame_result *r, job_light *light)
{
    model m = {.j = j, .r = r, .light = light, .set = r->set, .pixels = (size_t)r->lit.width * (size_t)r->lit.height};
    // Whatever the frame's own quality, so that it does not decide what is open.
    m.set.size = SIZE_FULL;
    m.set.target_error = 0.0;
    m.set.samples = SAMPLES;
    m.set.blur = (r->plan.method->blur * r->lit.width + r->gb.width - 1) / r->gb.width;
    m.plan = (plan){.method = r->plan.method,
                    .estimator = r->plan.method->bounce,
                    .layers = 1u << LAYER_RADIANCE,
                    .light = true,
                    .relight = true,
                    .want_radiance = true,
                    .blur = true};
    return m;
}

// Whether the shares explain the picture's light; without, s holds none.
static bool is_explained(const model *m, const char *file, bool told, bool unasked, const light_comparison *own, const shares *s)
{
    static const char other[] = "; lamps or another environment light it, and the outside is as without the option";
    double most = unasked ? fmin(MOST_LEFT_UNASKED, MOST_OF_UNLIKE * own->unlike) : MOST_LEFT;
    bool too_bright = own->share > TOO_BRIGHT, left = !too_bright && s->unexplained > most;
    if (told && too_bright)
        log_warn(m->j->log, "beauty-env", "%s: its light is %.2g times what --beauty-env gives under an open sky%s", file,
                 own->share, other);
    if (told && left)
        log_warn(m->j->log, "beauty-env", "%s: --beauty-env does not explain its light, of which %.2g is left%s", file,
                 s->unexplained, other);
    return !too_bright && !left;
}

// Whether the light is that of an open sky in another exposure.
static bool is_dimmed(const model *m, const char *file, bool told, const light_comparison *own)
{
    if (own->share >= MOST_LIGHT || own->unlike > UNLIKE) return false;
    if (told)
        log_warn(m->j->log, "beauty-env",
                 "%s: its light is that of an open sky under --beauty-env, but %.2g times as bright; the outside is open; "
                 "--beauty-env-scale makes them alike",
                 file, own->share);
    return true;
}

// Nobody said that the environment lit the picture: from open to what was fitted, the darker the picture is.
static void close_by_degrees(const model *m, const char *file, double light, openness *o)
{
    double t = fmin(1.0, fmax(0.0, (MOST_LIGHT - light) / (MOST_LIGHT - SURE_LIGHT)));
    t *= t * (3.0 - 2.0 * t);
    for (int i = 0; i < OPENNESS_COUNT; i++) o->share[i] = 1.0 + t * (o->share[i] - 1.0);
    o->suns = o->suns < 0.0 ? o->suns : 1.0 + t * (o->suns - 1.0);
    log_warn(
        m->j->log, "dark",
        "%s: its own light is %.2g of what --env gives with the outside open, so the outside is closed as that light tells; if "
        "--env is not what lit it, name that with --beauty-env or choose --outside open",
        file, light);
}

bool outside_fit(job *j, frame_result *r, job_light *light, bool told, openness *out, error *e)
{
    const openness prior = *out;
    const char *file = r->file ? r->file->path : "the picture";
    light_comparison own;
    shares s;
    if (!r->lit.depth || r->lit.valid == 0) return true;
    bool unasked = !told && openness_is_whole(&prior);
    if (unasked && shows_background(&r->gb)) return true;
    model m = model_of(j, r, light);
    if (m.set.planes && !r->planes.found && !planes_find(&r->gb, &r->planes, e)) return false;
    if (!find_walls(&m, &m.walls, e) || !compare_light(&m, &own, e)) return false;
    log_info(j->log, "outside: the picture's own light is %.2g of what an open sky would give, and unlike it by %.2g", own.share,
             own.unlike);
    if (unasked && own.share >= MOST_LIGHT) return true;
    if (openness_is_whole(&prior) && is_dimmed(&m, file, told, &own)) return true;
    if (own.share <= TOO_BRIGHT && !fit_shares(&m, &prior, own.share, &s, e)) return false;
    if (!is_explained(&m, file, told, unasked, &own, &s)) return true;
    *out = openness_of(&m, s.x);
    r->unexplained = s.unexplained;
    if (light != &j->light) out->suns = -1.0;
    if (unasked) close_by_degrees(&m, file, own.share, out);
    say(j, r, out, s.unexplained);
    return true;
}
