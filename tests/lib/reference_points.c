// The estimators that test points: SSDO and Alchemy (reference.h).
#include "reference.h"

static vec3 to_world(const camera *c, vec3 w) { return c->has_world ? m3_apply(c->world_from_camera, w) : w; }

static void tangent_frame(vec3 n, vec3 *a, vec3 *b)
{
    *a = v3_normalize(v3_cross(n, fabs(n.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0)));
    *b = v3_cross(n, *a);
}

static double fraction(double a) { return a - floor(a); }

static double luminance_of(vec3 c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

// What one hemisphere's quadrature adds up.
typedef struct sums {
    double weight, open, light, visible;
    vec3 radiance;
    double form; // mean of f over all samples
    vec3 bounce; // mean of f fade albedo radiance
} sums;

typedef struct receiver {
    const layer *layer;
    const reference_ssdo_options *options;
    vec3 position, normal;
} receiver;

static double fade(const reference_ssdo_options *o, double distance)
{
    double u = distance / o->radius;
    if (u >= 1.0) return 0.0;
    if (u <= o->fade_start) return 1.0;
    double a = (1.0 - u) / (1.0 - o->fade_start);
    return o->fade_smooth ? a * a * (3.0 - 2.0 * a) : a;
}

// One blocked sample as a sender: a disc of area A_s on the surface that blocks it.
static void add_bounce(const receiver *r, const surfel *sender, vec3 at, sums *sum)
{
    const reference_ssdo_options *o = r->options;
    if (!o->sender_radiance || !r->layer->albedo) return;
    vec3 to = v3_sub(at, r->position);
    double distance = v3_length(to), area = M_PI * o->radius * o->radius / (o->patches > 0 ? o->patches : 16);
    if (distance <= 0.0) return;
    double cos_s = -v3_dot(sender->normal, to) / distance, cos_r = v3_dot(r->normal, to) / distance;
    if (cos_s <= 0.0 || cos_r <= 0.0) return;
    double f = area * cos_s * cos_r / (M_PI * distance * distance + area), lit = f * fade(o, distance);
    size_t i = 4 * (size_t)(sender - r->layer->surfels);
    const float *albedo = r->layer->albedo + i, *light = o->sender_radiance + i;
    sum->form += f;
    sum->bounce = v3_add(sum->bounce, v3(lit * (double)albedo[0] * (double)light[0], lit * (double)albedo[1] * (double)light[1],
                                         lit * (double)albedo[2] * (double)light[2]));
}

// True if the recorded surface hides the point s from the camera, by at most the thickness. The margin is float rounding of
// depth.
static bool point_blocked(const receiver *r, vec3 s, const surfel **by, vec3 *at)
{
    double x, y;
    if (!layer_project(r->layer, s, &x, &y)) return false;
    *by = layer_sample(r->layer, x, y, at);
    if (!*by) return false;
    double behind = s.z - at->z;
    return behind > 1e-6 * s.z && behind <= r->options->thickness;
}

// Share of blocked samples along direction w; `shift` decorrelates the distances of neighbouring directions.
static double blocked_share(const receiver *r, vec3 w, int distances, double shift, sums *sum)
{
    int blocked = 0;
    for (int k = 0; k < distances; k++) {
        double lambda = r->options->radius * (k + shift) / distances;
        const surfel *by;
        vec3 at;
        if (!point_blocked(r, v3_add(r->position, v3_scale(w, lambda)), &by, &at)) continue;
        blocked++;
        add_bounce(r, by, at, sum);
    }
    return (double)blocked / distances;
}

static void add_direction(const receiver *r, vec3 w, double cosine, double blocked, sums *sum)
{
    const reference_ssdo_options *o = r->options;
    vec3 sky = (o->sky ? o->sky : truth_white_sky)(o->sky_data, to_world(&r->layer->camera, w));
    double open = 1.0 - blocked, light = luminance_of(sky) * cosine;
    sum->weight += cosine;
    sum->open += cosine * open;
    sum->light += light;
    sum->visible += light * open;
    sum->radiance = v3_add(sum->radiance, v3_scale(sky, cosine * open));
}

static reference_ssdo_result finish(const sums *s, const reference_ssdo_options *o, long samples)
{
    reference_ssdo_result out = {.occlusion = s->open / s->weight,
                                 .visibility = s->light > 0.0 ? s->visible / s->light : 1.0,
                                 .radiance = v3_scale(s->radiance, 1.0 / s->weight)};
    double n = o->patches > 0 ? o->patches : 16, form = n * s->form / (double)samples, blocked = 1.0 - out.occlusion;
    double bound = form > blocked ? blocked / form : 1.0;
    out.indirect = v3_scale(s->bounce, bound * n / (double)samples);
    return out;
}

reference_ssdo_result reference_ssdo(const layer *l, pixel p, const reference_ssdo_options *o)
{
    const surfel *s = layer_at(l, p.x, p.y);
    receiver r = {l, o, s->position, s->normal};
    int rings = o->elevations > 0 ? o->elevations : 64, spokes = o->azimuths > 0 ? o->azimuths : 64;
    int distances = o->distances > 0 ? o->distances : 32;
    vec3 a, b;
    tangent_frame(s->normal, &a, &b);
    sums sum = {0};
    for (int i = 0; i < rings * spokes; i++) {
        int ring = i / spokes;
        double cosine = 1.0 - (ring + 0.5) / rings, sine = sqrt(1.0 - cosine * cosine);
        double phi = 2.0 * M_PI * (i % spokes + fraction(ring * 0.6180339887498949)) / spokes;
        vec3 across = v3_add(v3_scale(a, sine * cos(phi)), v3_scale(b, sine * sin(phi)));
        vec3 w = v3_add(across, v3_scale(s->normal, cosine));
        // (0, R]: the shift runs over (0, 1].
        double blocked = blocked_share(&r, w, distances, 1.0 - fraction(i * 0.7548776662466927), &sum);
        add_direction(&r, w, cosine, blocked, &sum);
    }
    return finish(&sum, o, (long)rings * spokes * distances);
}

static double alchemy_tap(const layer *l, const surfel *centre, double x, double y, const reference_alchemy_options *o)
{
    vec3 at;
    const surfel *surface = layer_sample(l, x, y, &at);
    if (!surface) return 0.0;
    if (o->points) at = surface->position;
    double c = 0.1 * o->radius;
    vec3 w = v3_sub(at, centre->position);
    double square = v3_dot(w, w), above = v3_dot(centre->normal, w) - o->bias;
    // The centre's own plane is zero to the rounding of float depth, not to the last bit of a double.
    if (square > o->radius * o->radius || above <= 1e-7 * centre->position.z) return 0.0;
    return 2.0 * M_PI * c * above / fmax(c * c, square);
}

double reference_alchemy(const layer *l, pixel p, const reference_alchemy_options *o)
{
    const surfel *s = layer_at(l, p.x, p.y);
    int radii = o->radii > 0 ? o->radii : 128, angles = o->angles > 0 ? o->angles : 128;
    double per_unit = l->camera.kind == CAMERA_PERSPECTIVE ? 1.0 / s->position.z : 1.0, sum = 0.0;
    for (int i = 0; i < radii * angles; i++) {
        int ring = i / angles;
        double u = (ring + 0.5) / radii, share = o->measure == TAPS_UNIFORM_IN_AREA ? sqrt(u) : u;
        double phi = 2.0 * M_PI * (i % angles + fraction(ring * 0.6180339887498949)) / angles, h = share * o->radius * per_unit;
        sum += alchemy_tap(l, s, p.x + 0.5 + h * l->camera.fx * cos(phi), p.y + 0.5 + h * l->camera.fy * sin(phi), o);
    }
    return sum / ((double)radii * angles);
}
