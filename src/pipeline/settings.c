#include "pipeline/settings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "gbuffer/conventions.h"
#include "passes/method.h"
#include "passes/openings.h"

bool settings_up_z(const job *j, const frame_result *r) { return j->o->env_up ? j->o->env_up == 'z' : r->resolution.up_is_z; }

static double radius_of(const job *j, const gbuffer *gb)
{
    const options *o = j->o;
    if (o->radius_unit == RADIUS_WORLD) return o->radius;
    if (o->radius_unit == RADIUS_AUTO) return j->is_shot ? j->shot.radius : gbuffer_auto_radius(gb);
    // Pixels are turned into one world distance at the frame's median depth, so that the radius is the same on all surfaces.
    double per_unit = gb->camera.fx;
    return gb->camera.kind == CAMERA_ORTHOGRAPHIC ? o->radius / per_unit : o->radius * frame_median_depth(gb) / per_unit;
}

// Of at most a few thousand evenly spaced surfaces: enough for a scale. `share` of them are nearer.
static double depth_at(const gbuffer *gb, double share)
{
    enum { MOST = 4096 };
    float depths[MOST];
    int n = 0;
    size_t count = (size_t)gb->width * (size_t)gb->height, stride = gb->valid / MOST + 1, seen = 0;
    for (size_t i = 0; i < count && n < MOST; i++)
        if (gb->depth[i] > 0.0f && seen++ % stride == 0) depths[n++] = gb->depth[i];
    if (n == 0) return 1.0;
    sort_floats(depths, (size_t)n);
    return (double)depths[(int)(share * n)];
}

double frame_median_depth(const gbuffer *gb) { return depth_at(gb, 0.5); }

bool frame_check_scale(const frame_result *r, error *e)
{
    static const double least_pixel = 1e-14, most_depth = 1e10;
    const camera *c = &r->gb.camera;
    double depth = frame_median_depth(&r->gb), pixel = c->kind == CAMERA_ORTHOGRAPHIC ? 1.0 / c->fx : depth / c->fx;
    if (r->gb.valid == 0 || (pixel >= least_pixel && depth_at(&r->gb, 0.1) <= most_depth)) return true;
    return err_set(e, ERR_INPUT, r->file->path, NULL,
                   "its surfaces are about %.2g scene units away and a pixel is %.2g wide, beyond what is computed with (%g to "
                   "%g); render it in another unit",
                   depth, pixel, least_pixel, most_depth);
}

// The world the environment is fixed to: the scene's, or one that moves with the camera, its up axis up in the picture and the
// camera looking along +y (z up) or -z (y up).
static mat3 world_from_camera(const job *j, const frame_result *r)
{
    static const mat3 up_z = {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}}, up_y = {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    if (j->o->env_frame == FRAME_CAMERA) return settings_up_z(j, r) ? up_z : up_y;
    return r->gb.camera.has_rotation ? r->gb.camera.world_from_camera : m3_identity();
}

// ---- the outside

static mat3 upright_from_world(const job *j, const frame_result *r)
{
    static const mat3 up_y = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
    return settings_up_z(j, r) ? m3_identity() : up_y;
}

static vec3 upright_eye(const job *j, const frame_result *r)
{
    bool known = r->gb.camera.has_world && j->o->env_frame != FRAME_CAMERA;
    return known ? m3_apply(upright_from_world(j, r), r->gb.camera.origin) : v3(0, 0, 0);
}

// Below the first share of roof the picture is taken to be under the sky, above the second one to be covered. Between them the
// outside closes by degrees, so that nothing jumps.
static const double LEAST_ROOF = 0.01, MOST_ROOF = 0.03;

// Which way is up needs the camera's rotation, or an environment that moves with the camera.
static bool knows_up(const job *j, const frame_result *r) { return r->gb.camera.has_rotation || j->o->env_frame == FRAME_CAMERA; }

// Whether the camera lies on its back in a world with this axis up, and stands upright in one with the other. The axis is an
// assumption unless the user says it, and the wrong one makes a roof of what lies ahead.
static bool stands_on_other_axis(const job *j, const frame_result *r)
{
    vec3 up = m3_apply(world_from_camera(j, r), v3(0, -1, 0));
    double assumed = settings_up_z(j, r) ? up.z : up.y, other = settings_up_z(j, r) ? up.y : up.z;
    return !j->o->env_up && j->o->env_frame != FRAME_CAMERA && assumed < 0.5 && other > 0.7;
}

static shot_facts outside_of(const job *j, const frame_result *r)
{
    shot_facts f = {.outside = openness_even(j->o->outside < 0.0 ? 1.0 : j->o->outside), .roof = -1.0};
    if (j->o->outside >= 0.0) return f;
    if (!plan_asks_outside(j->o) || !knows_up(j, r)) return f;
    vec3 up = settings_up_z(j, r) ? v3(0, 0, 1) : v3(0, 1, 0);
    f.roof = openings_roof(&r->gb, m3_apply(m3_transpose(world_from_camera(j, r)), up));
    if (f.roof > LEAST_ROOF && stands_on_other_axis(j, r)) {
        log_warn(j->log, "up",
                 "%s: with %c up, %.3g %% of the picture is a roof, but the camera looks steeply up and would stand upright with "
                 "%c up; "
                 "the outside is taken to be open; say which it is with --env-up, for the environment turns with it",
                 r->file->path, settings_up_z(j, r) ? 'z' : 'y', 100.0 * f.roof, settings_up_z(j, r) ? 'y' : 'z');
        f.roof = -1.0;
        return f;
    }
    double t = fmin(fmax((f.roof - LEAST_ROOF) / (MOST_ROOF - LEAST_ROOF), 0.0), 1.0);
    f.outside = openness_even(1.0 + (OUTSIDE_COVERED - 1.0) * t * t * (3.0 - 2.0 * t));
    return f;
}

shot_facts settings_measure_shot(const job *j, const frame_result *r)
{
    shot_facts f = outside_of(j, r);
    f.radius = gbuffer_auto_radius(&r->gb);
    return f;
}

shot_facts settings_shot(const job *j, const frame_result *r)
{
    shot_facts f = j->is_shot ? j->shot : outside_of(j, r);
    f.radius = radius_of(j, &r->gb);
    return f;
}

// composite.comp: 1 the beauty, 2 the environment, 0 nothing.
static int background_of(bool beauty, bool sky) { return beauty ? 1 : sky ? 2 : 0; }

// A quarter of the method's own samples for a draft (and of the pixels, settings_of), four times as many for high quality.
static int samples_at(const method *m, int quality)
{
    return quality < 0 ? m->samples / 4 : quality > 0 ? m->samples * 4 : m->samples;
}

static estimate_size size_of(const job *j, const frame_result *r)
{
    const options *o = j->o;
    if (r->plan.from_sh || o->error > 0.0)
        return SIZE_FULL; // stored layers are whole already, and so are the tiles of the rounds
    switch (o->resolution) {
    case RESOLUTION_FULL:
        return SIZE_FULL;
    case RESOLUTION_LIGHT:
        return SIZE_LIGHT;
    case RESOLUTION_HALF:
        return SIZE_HALF;
    case RESOLUTION_BY_QUALITY:
        break;
    }
    return o->quality < 0 ? SIZE_HALF : o->quality > 0 ? SIZE_FULL : SIZE_LIGHT;
}

pass_settings settings_of(const job *j, const frame_result *r, shot_facts shot)
{
    const options *o = j->o;
    const method *m = r->plan.method;
    double share = o->thickness < 0.0 ? m->thickness : o->thickness;
    bool beauty = r->resolution.components[ROLE_BEAUTY] > 0, alpha = r->resolution.components[ROLE_ALPHA] > 0;
    return (pass_settings){
        .radius = shot.radius,
        .thickness = share * shot.radius,
        .thickness_fixed = o->thickness >= 0.0,
        .planes = !o->no_planes,
        .outside = shot.outside,
        .size = size_of(j, r),
        .samples = o->samples > 0 && o->error <= 0.0 ? o->samples : samples_at(m, o->error > 0.0 ? 0 : o->quality),
        .target_error = o->error,
        .most_samples = o->samples > 0 ? o->samples : ROUNDS_MOST_SAMPLES,
        .angle_bias = o->angle_bias,
        .sh_bands = o->sh_bands,
        .sh_sigma = o->sh_sigma,
        .blur = o->blur < 0 ? m->blur : o->blur,
        .scale = o->scale,
        .contrast = o->contrast,
        .env_level = o->env_lod,
        .bounce_strength = o->bounce_strength,
        .vpl_count = o->vpl_count,
        .world_from_camera = world_from_camera(j, r),
        .upright_from_camera = m3_mul(upright_from_world(j, r), world_from_camera(j, r)),
        .upright_eye = upright_eye(j, r),
        .mesh = o->mesh,
        .trace = o->trace,
        .mesh_axes = o->mesh_axes,
        .amount = o->amount,
        .depthmask_strength = o->depthmask_strength,
        .multiply_all = o->multiply == MULTIPLY_ALL,
        .visibility_mode = r->plan.visibility_mode,
        .base_albedo = r->resolution.albedo == ALBEDO_BASE,
        .averaged_albedo = convention_named(r->resolution.convention)->normals_averaged,
        // With an alpha the picture is premultiplied, and the environment is not part of it.
        .background = background_of(beauty, o->env && !alpha),
        .relight = r->plan.relight,
        .bounce_in_composite = r->plan.bounce_in_composite,
    };
}
