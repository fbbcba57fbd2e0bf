#include <math.h>
#include <string.h>

#include "base/threads.h"
#include "passes/arc.h"

// The box of the frame's surfaces, in the axes of the environment's map. Scenes stand upright in those axes, so the box is tight
// above a ground.
typedef struct box_job {
    const gbuffer *gb;
    mat3 map_from_camera;
    vec3 low[64], high[64]; // of each band of rows
} box_job;

enum { BANDS = 64 };

// A sharp shadow shows where a back is. The best guess of its depth is half the width of the surface
// (shaders/include/arc_march.glsl).
static const float SUN_KAPPA = 0.5f;

static bool bound_band(void *context, size_t band, int worker)
{
    (void)worker;
    box_job *j = context;
    const gbuffer *gb = j->gb;
    vec3 low = v3(INFINITY, INFINITY, INFINITY), high = v3_scale(low, -1.0);
    int from = (int)(band * (size_t)gb->height / BANDS), to = (int)((band + 1) * (size_t)gb->height / BANDS);
    for (int y = from; y < to; y++)
        for (int x = 0; x < gb->width; x++) {
            if (gb->depth[(size_t)y * (size_t)gb->width + (size_t)x] == 0.0f) continue;
            vec3 p = m3_apply(j->map_from_camera, gbuffer_position(gb, x, y));
            low = v3(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
            high = v3(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
        }
    j->low[band] = low, j->high[band] = high;
    return true;
}

static void put_box(const pass_context *c, mat3 map_from_camera, arc_params *p)
{
    box_job j = {.gb = c->gb, .map_from_camera = map_from_camera};
    threads_for(c->threads, BANDS, bound_band, &j);
    for (int i = 1; i < BANDS; i++) {
        j.low[0] = v3(fmin(j.low[0].x, j.low[i].x), fmin(j.low[0].y, j.low[i].y), fmin(j.low[0].z, j.low[i].z));
        j.high[0] = v3(fmax(j.high[0].x, j.high[i].x), fmax(j.high[0].y, j.high[i].y), fmax(j.high[0].z, j.high[i].z));
    }
    params_put(p->box_low, j.low[0], 0);
    params_put(p->box_high, j.high[0], 0);
}

static void put_suns(const pass_context *c, arc_params *p)
{
    const sun_set *set = &c->sunless->suns;
    mat3 map_from_camera = m3_mul(c->env->map_from_world, c->set.world_from_camera);
    p->suns = set->count;
    for (int i = 0; i < set->count; i++) {
        const sun *s = &set->suns[i];
        double half_width = acos(fmax(-1.0, 1.0 - s->solid_angle / (2.0 * M_PI))); // of a cap of that solid angle
        params_put(p->sun_direction[i], m3_apply(m3_transpose(map_from_camera), s->direction), half_width);
        params_put(p->sun_light[i], v3_scale(v3(s->flux[0], s->flux[1], s->flux[2]), 1.0 / M_PI), 0);
    }
    for (int i = 0; i < 9; i++)
        for (int k = 0; k < 3; k++) p->rest[i][k] = (float)c->sunless->rest[i][k];
}

bool pass_split_suns(pass_context *c, error *e)
{
    pass_sunless *l = c->sunless;
    if (l->ready || !c->env || c->env->white) return true;
    environment rest;
    if (!sun_split(c->env, c->threads, &l->suns, &rest, c->log, e)) return false;
    if (l->suns.count > 0) {
        memcpy(l->rest, rest.sh, sizeof l->rest);
        bool ok = pass_upload_environment(c->g, &rest, &l->map, e);
        environment_free(&rest);
        if (!ok) return false;
        log_info(c->log, "environment: %d small bright source%s marched one by one", l->suns.count,
                 l->suns.count > 1 ? "s are" : " is");
    }
    l->ready = true;
    return true;
}

static arc_params params_of(const pass_context *c)
{
    arc_params p = arc_unlimited_params_of(c);
    p.kappa *= SUN_KAPPA;
    p.steps = c->set.samples < 16 ? 16 : c->set.samples > 128 ? 128 : c->set.samples;
    p.inverse_steps = 1.0f / (float)p.steps;
    put_suns(c, &p);
    return p;
}

static bool find_shadows(pass_context *c, arc_params params, error *e)
{
    if (c->image[IMAGE_SUNS].id) return true;
    if (!arc_make_inputs(c, e) || !arc_make_outside(c, e)) return false;
    put_box(c, m3_mul(c->env->map_from_world, c->set.world_from_camera), &params);
    variant v = {{0}};
    variant_add(&v, arc_closes_outside(c), "OUTSIDE");
    variant_add(&v, arc_has_surround(c), "SURROUND");
    const pass_call march = {
        .program = "suns",
        .variant = v.words,
        PASS_PARAMS(params),
        .reads = {{"surface_image", &c->image[IMAGE_SURFACE]},
                  {"rim_image", &c->image[IMAGE_RIM]},
                  {"surround_image", &c->surround->shell}},
        .writes = {{"sun_image", &c->image[IMAGE_SUNS]}},
    };
    return pass_make_image(c, IMAGE_SUNS, e) && pass_run(c, &march, e);
}

bool pass_add_suns(pass_context *c, gpu_image *light, gpu_image *visibility, error *e)
{
    const arc_params params = params_of(c);
    const pass_call add = {
        .program = "suns_add",
        .variant = visibility && visibility->id ? "VISIBILITY" : NULL,
        PASS_PARAMS(params),
        .reads = {{"sun_image", &c->image[IMAGE_SUNS]}},
        .writes = {{"scalar_image", visibility}, {"light_image", light}},
    };
    return find_shadows(c, params, e) && pass_run(c, &add, e);
}

bool pass_suns(pass_context *c, error *e)
{
    if (!c->suns_pending) return true;
    bool ok = pass_add_suns(c, &c->image[IMAGE_RADIANCE], &c->image[IMAGE_VISIBILITY], e);
    gpu_image_free(&c->image[IMAGE_SUNS]);
    c->suns_pending = !ok;
    return ok;
}
