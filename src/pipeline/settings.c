#include "pipeline/settings.h"

#include <stdlib.h>
#include <string.h>

#include "gbuffer/conventions.h"

bool settings_up_z(const job *j, const frame_result *r) { return j->o->env_up ? j->o->env_up == 'z' : r->resolution.up_is_z; }

double settings_radius(const job *j, const gbuffer *gb)
{
    const options *o = j->o;
    if (o->radius_unit == RADIUS_WORLD) return o->radius;
    if (o->radius_unit == RADIUS_AUTO) return j->sequence_radius > 0.0 ? j->sequence_radius : gbuffer_auto_radius(gb);
    // Pixels are turned into one world distance at the frame's median depth, so that the radius is the same on all surfaces.
    double per_unit = gb->camera.fx;
    return gb->camera.kind == CAMERA_ORTHOGRAPHIC ? o->radius / per_unit : o->radius * frame_median_depth(gb) / per_unit;
}

static int by_value(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
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
    qsort(depths, (size_t)n, sizeof *depths, by_value);
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

// composite.comp: 1 the beauty, 2 the environment, 0 nothing.
static int background_of(bool beauty, bool sky) { return beauty ? 1 : sky ? 2 : 0; }

// A quarter of the method's own samples for a draft (and of the pixels, settings_of), four times as many for high quality.
static int samples_at(const method *m, int quality)
{
    return quality < 0 ? m->samples / 4 : quality > 0 ? m->samples * 4 : m->samples;
}

pass_settings settings_of(const job *j, const frame_result *r, double radius)
{
    const options *o = j->o;
    const method *m = r->plan.method;
    double share = o->thickness < 0.0 ? m->thickness : o->thickness;
    bool beauty = r->resolution.components[ROLE_BEAUTY] > 0, alpha = r->resolution.components[ROLE_ALPHA] > 0;
    return (pass_settings){
        .radius = radius,
        .thickness = share * radius,
        .thickness_fixed = o->thickness >= 0.0,
        .planes = !o->no_planes,
        .half =
            (o->half < 0 ? o->quality < 0 : o->half) && !r->plan.from_sh && o->error <= 0.0, // stored layers are whole already
        .samples = o->samples > 0 && o->error <= 0.0 ? o->samples : samples_at(m, o->error > 0.0 ? 0 : o->quality),
        .error = o->error,
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
