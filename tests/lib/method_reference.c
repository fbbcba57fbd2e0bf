#include "method_reference.h"

#include <string.h>

#include "light/sh.h"

typedef enum kind { NONE, SSDO, S3HO, ALCHEMY, HORIZON, BITMASK, HEMISPHERE, HBAO } kind;

static kind kind_of(const method *m)
{
    static const struct {
        const char *name;
        kind kind;
    } list[] = {{"ssdo", SSDO},    {"s3ho", S3HO},       {"alchemy", ALCHEMY},
                {"gtao", HORIZON}, {"bitmask", BITMASK}, {"hemisphere", HEMISPHERE},
                {"hbao", HBAO}};
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        if (strcmp(m->name, list[i].name) == 0) return list[i].kind;
    return NONE;
}

bool method_has_reference(const method *m) { return kind_of(m) != NONE; }
bool method_references_light(const method *m) { return kind_of(m) == SSDO || kind_of(m) == S3HO; }

// ---- skies

typedef struct blurred_sky {
    const environment *env;
    double solid_angle, sigma;
} blurred_sky;

// The level whose texels have the given solid angle where the direction falls.
static vec3 sky_of_directions(void *data, vec3 world)
{
    const blurred_sky *b = data;
    const env_level *top = &b->env->levels[0];
    vec3 d = m3_apply(b->env->map_from_world, world);
    double row = acos(fmax(-1.0, fmin(1.0, d.z))) / M_PI * top->height;
    double texel = env_texel_solid_angle(top->width, top->height, (int)fmin(row, top->height - 1));
    return environment_lookup(b->env, d, fmin(fmax(0.5 * log2(b->solid_angle / texel), 0.0), b->env->level_count - 1));
}

static vec3 sky_of_coefficients(void *data, vec3 world)
{
    const blurred_sky *b = data;
    double y[SH_MAX], sum[3] = {0};
    sh_basis(m3_apply(b->env->map_from_world, world), 3, y);
    for (int i = 0; i < 9; i++) {
        int l = i == 0 ? 0 : i < 4 ? 1 : 2;
        double pass = exp(-0.5 * b->sigma * b->sigma * l * (l + 1));
        for (int k = 0; k < 3; k++) sum[k] += pass * b->env->sh[i][k] * y[i];
    }
    return v3(sum[0], sum[1], sum[2]);
}

static method_reference_value point_test(const layer *l, pixel p, const method_reference_options *o)
{
    reference_ssdo_options so = {.radius = o->set->radius,
                                 .thickness = o->set->thickness,
                                 .elevations = o->fine ? 32 : 24,
                                 .azimuths = o->fine ? 48 : 36,
                                 .distances = o->fine ? 24 : 12};
    blurred_sky sky = {o->env, 2.0 * M_PI / (so.elevations * so.azimuths), o->set->sh_sigma};
    if (o->env) so.sky = kind_of(o->method) == S3HO ? sky_of_coefficients : sky_of_directions, so.sky_data = &sky;
    reference_ssdo_result r = reference_ssdo(l, p, &so);
    // Few bands ring below zero, and light is not negative.
    return (method_reference_value){r.occlusion, v3(fmax(0.0, r.radiance.x), fmax(0.0, r.radiance.y), fmax(0.0, r.radiance.z))};
}

static double scalar(const layer *l, pixel p, const method_reference_options *o)
{
    const pass_settings *s = o->set;
    reference_alchemy_options a = {.radius = s->radius, .measure = TAPS_UNIFORM_IN_RADIUS, .points = true};
    reference_hemisphere_options h = {.radius = s->radius};
    reference_hbao_options b = {.radius = s->radius, .bias = s->angle_bias * M_PI / 180.0};
    reference_slice_options c = {.radius = s->radius, .thickness = s->thickness, .points = true};
    a.radii = a.angles = o->fine ? 128 : 64;
    h.elevations = h.azimuths = h.distances = o->fine ? 40 : 20;
    b.directions = o->fine ? 64 : 48;
    b.steps = o->fine ? 512 : 128;
    c.slices = o->fine ? 64 : 32;
    switch (kind_of(o->method)) {
    case ALCHEMY:
        return pow(fmax(0.0, 1.0 - s->scale * reference_alchemy(l, p, &a)), s->contrast);
    case HORIZON:
        return reference_horizon(l, p, &c);
    case BITMASK:
        return reference_bitmask(l, p, &c);
    case HEMISPHERE:
        return reference_hemisphere(l, p, &h);
    case HBAO:
        return fmax(0.0, reference_hbao(l, p, &b));
    default:
        return NAN;
    }
}

method_reference_value method_reference(const layer *l, pixel p, const method_reference_options *o)
{
    if (method_references_light(o->method)) return point_test(l, p, o);
    return (method_reference_value){.occlusion = scalar(l, p, o)};
}

// ---- virtual lights

static double pixel_area(const camera *c, const surfel *s)
{
    if (c->kind == CAMERA_ORTHOGRAPHIC) return 1.0 / (c->fx * c->fy * fabs(s->normal.z));
    vec3 ray = v3_scale(s->position, 1.0 / s->position.z);
    return s->position.z * s->position.z / (c->fx * c->fy * fabs(v3_dot(s->normal, ray)));
}

vec3 reference_vpl(const layer *l, pixel p, const float *radiance)
{
    const surfel *receiver = layer_at(l, p.x, p.y);
    vec3 light = v3(0, 0, 0);
    double factors = 0.0;
    for (int i = 0; i < l->width * l->height; i++) {
        const surfel *s = &l->surfels[i];
        if (s->slack < 0.0 || s == receiver) continue;
        vec3 w = v3_sub(s->position, receiver->position);
        double received = v3_dot(receiver->normal, w), sent = -v3_dot(s->normal, w);
        if (received <= 0.0 || sent <= 0.0) continue;
        double dd = v3_dot(w, w), area = pixel_area(&l->camera, s), f = area * received * sent / (dd * (M_PI * dd + area));
        const float *a = l->albedo + 4 * i, *r = radiance + 3 * i;
        factors += f;
        light =
            v3_add(light, v3_scale(v3((double)a[0] * (double)r[0], (double)a[1] * (double)r[1], (double)a[2] * (double)r[2]), f));
    }
    return v3_scale(light, factors > 1.0 ? 1.0 / factors : 1.0);
}
