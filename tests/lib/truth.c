#include "truth.h"

#include "light/environment.h"

double truth_cone(double cos_m, double k)
{
    double s = sqrt(fmax(0.0, 1.0 - k * k)), sin_m = sqrt(fmax(0.0, 1.0 - cos_m * cos_m));
    // Lowest point of the rim above the horizon: an ellipse; highest below it: nothing.
    if (k * cos_m >= s * sin_m) return s * s * cos_m;
    if (-k * cos_m >= s * sin_m) return 0.0;
    double phi = acos(-k * cos_m / (s * sin_m));                        // half angle of the rim's part above the horizon
    double psi = atan2(s * sin(phi), k * sin_m - s * cos(phi) * cos_m); // half angle of the horizon's arc
    return (psi + s * s * cos_m * phi - s * k * sin_m * sin(phi)) / M_PI;
}

double truth_wall(double a) { return 0.5 * (1.0 + cos(a)); }

double truth_wall_cutoff(double a, double x, double radius)
{
    double k = x * sin(a) / radius;
    return k >= 1.0 ? 1.0 : 1.0 - truth_cone(-cos(a), k);
}

double truth_corner(double x, double radius)
{
    double k = x / radius;
    return k >= 1.0 ? 1.0 : 1.0 - (acos(k) - k * sqrt(1.0 - k * k)) / M_PI;
}

double truth_sphere(double r, double h, double d)
{
    double distance = hypot(h, d), sin_half = r / distance;
    return 1.0 - truth_cone(h / distance, sqrt(1.0 - sin_half * sin_half));
}

static double sine_of(double across, double up) { return across / hypot(across, up); }

double truth_slit(double w, double depth, double u) { return 0.5 * (sine_of(0.5 * w - u, depth) + sine_of(0.5 * w + u, depth)); }

double truth_bar(double width, double thickness, double h, double u)
{
    double low = 1.0, high = -1.0;
    for (int corner = 0; corner < 4; corner++) {
        double s = sine_of((corner & 1 ? 0.5 : -0.5) * width - u, corner & 2 ? h + thickness : h);
        low = fmin(low, s);
        high = fmax(high, s);
    }
    return 1.0 - 0.5 * (high - low);
}

double truth_patch(double size, double gap)
{
    double x = 0.5 * size / gap, q = sqrt(1.0 + x * x);
    return 1.0 - 4.0 * (x / q * atan(x / q)) / M_PI; // four quarters, each (1 / 2 pi) of two equal terms
}

double truth_corner_point_test(double x, double radius)
{
    double k = x / radius, s = sqrt(fmax(0.0, 1.0 - k * k));
    return k >= 1.0 ? 1.0 : 1.0 - (acos(k) + k * s - 2.0 * k * log((1.0 + s) / k)) / M_PI;
}

vec3 truth_white_sky(void *data, vec3 direction)
{
    (void)data;
    (void)direction;
    return v3(1, 1, 1);
}

vec3 truth_environment_sky(void *data, vec3 direction)
{
    const environment *env = data;
    return environment_lookup(env, m3_apply(env->map_from_world, direction), 0.0);
}

// An integer hash (Wang) to [0, 1).
static double noise(uint32_t a)
{
    a = (a ^ 61u) ^ (a >> 16);
    a *= 9u;
    a = (a ^ (a >> 4)) * 0x27d4eb2du;
    return (double)((a ^ (a >> 15)) >> 8) / 16777216.0;
}

vec3 truth_direction(vec3 normal, int i, int n, uint32_t seed)
{
    uint32_t key = seed * 0x9e3779b9u + 2u * (uint32_t)i;
    double u = (i % n + noise(key)) / n, v = (i / n + noise(key + 1u)) / n;
    double r = sqrt(u), phi = 2.0 * M_PI * v;
    vec3 helper = fabs(normal.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0);
    vec3 a = v3_normalize(v3_cross(normal, helper)), b = v3_cross(normal, a);
    vec3 across = v3_add(v3_scale(a, r * cos(phi)), v3_scale(b, r * sin(phi)));
    return v3_add(across, v3_scale(normal, sqrt(1.0 - u)));
}

static int side(int rays, int standard) { return (int)ceil(sqrt(rays > 0 ? rays : standard)); }

static double reach(const truth_options *o) { return o->radius > 0.0 ? o->radius : INFINITY; }

static vec3 ray_origin(vec3 point, vec3 normal, double offset)
{
    if (offset <= 0.0) offset = 1e-9 * fmax(1e-3, fmax(fabs(point.x), fmax(fabs(point.y), fabs(point.z))));
    return v3_add(point, v3_scale(normal, offset));
}

double truth_occlusion(const tracer *t, vec3 point, vec3 normal, const truth_options *o)
{
    int n = side(o->rays, 4096), open = 0;
    vec3 origin = ray_origin(point, normal, o->offset);
    for (int i = 0; i < n * n; i++) open += !t->blocked(t->data, origin, truth_direction(normal, i, n, o->seed), 0.0, reach(o));
    return (double)open / (n * n);
}

vec3 truth_radiance(const tracer *t, vec3 point, vec3 normal, const truth_options *o)
{
    int n = side(o->rays, 4096);
    truth_sky sky = o->sky ? o->sky : truth_white_sky;
    vec3 origin = ray_origin(point, normal, o->offset), sum = v3(0, 0, 0);
    for (int i = 0; i < n * n; i++) {
        vec3 w = truth_direction(normal, i, n, o->seed);
        if (!t->blocked(t->data, origin, w, 0.0, reach(o))) sum = v3_add(sum, sky(o->sky_data, w));
    }
    return v3_scale(sum, 1.0 / (n * n));
}

static vec3 product(vec3 a, vec3 b) { return v3(a.x * b.x, a.y * b.y, a.z * b.z); }

vec3 truth_indirect(const tracer *t, vec3 point, vec3 normal, const truth_options *o)
{
    int n = side(o->rays, 4096);
    truth_options second = *o;
    second.radius = INFINITY;
    second.rays = o->bounce_rays > 0 ? o->bounce_rays : 64;
    vec3 origin = ray_origin(point, normal, o->offset), sum = v3(0, 0, 0);
    for (int i = 0; i < n * n; i++) {
        hit h;
        if (!t->closest(t->data, origin, truth_direction(normal, i, n, o->seed), 0.0, reach(o), &h)) continue;
        second.seed = o->seed * 7919u + (uint32_t)i + 1u;
        sum = v3_add(sum, product(h.albedo, truth_radiance(t, h.position, h.normal, &second)));
    }
    return v3_scale(sum, 1.0 / (n * n));
}
