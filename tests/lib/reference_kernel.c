// The normal-oriented hemisphere and HBAO (reference.h).
#include "reference.h"

static double fraction(double a) { return a - floor(a); }

static void frame_about(vec3 n, vec3 *a, vec3 *b)
{
    *a = v3_normalize(v3_cross(n, fabs(n.x) < 0.6 ? v3(1, 0, 0) : v3(0, 1, 0)));
    *b = v3_cross(n, *a);
}

// ---- hemisphere

// A point uniform in the half cube [-1, 1]^2 x [0, 1] falls into a narrow cone with a probability in proportion to the cube of
// the cone's length up to the faces; averaged over the turn about the normal, for the tutorial's kernel is turned at random.
static double cone_weight(double cosine)
{
    enum { TURNS = 90 };
    double sine = sqrt(1.0 - cosine * cosine), sum = 0.0;
    for (int i = 0; i < TURNS; i++) {
        double turn = 0.25 * M_PI * (i + 0.5) / TURNS; // an eighth holds all
        double length = 1.0 / fmax(cosine, sine * cos(turn));
        sum += length * length * length / TURNS;
    }
    return sum;
}

// True if the recorded surface hides point s, and lies within the radius of the receiver's depth.
static bool hidden_in_range(const layer *l, const surfel *receiver, vec3 s, double radius)
{
    double x, y;
    vec3 at;
    if (!layer_project(l, s, &x, &y) || !layer_sample(l, x, y, &at)) return false;
    return s.z - at.z > 1e-6 * s.z && fabs(receiver->position.z - at.z) < radius;
}

double reference_hemisphere(const layer *l, pixel p, const reference_hemisphere_options *o)
{
    const surfel *s = layer_at(l, p.x, p.y);
    int rings = o->elevations > 0 ? o->elevations : 48, spokes = o->azimuths > 0 ? o->azimuths : 48;
    int distances = o->distances > 0 ? o->distances : 48;
    vec3 a, b;
    frame_about(s->normal, &a, &b);
    double total = 0.0, open = 0.0;
    for (int ring = 0; ring < rings; ring++) {
        double cosine = (ring + 0.5) / rings, sine = sqrt(1.0 - cosine * cosine), weight = cone_weight(cosine);
        for (int spoke = 0; spoke < spokes; spoke++) {
            double phi = 2.0 * M_PI * (spoke + fraction(ring * 0.6180339887498949)) / spokes;
            vec3 across = v3_add(v3_scale(a, sine * cos(phi)), v3_scale(b, sine * sin(phi)));
            vec3 w = v3_add(across, v3_scale(s->normal, cosine));
            int i = ring * spokes + spoke, blocked = 0;
            for (int k = 0; k < distances; k++) {
                double t = (k + fraction(i * 0.7548776662466927)) / distances;
                double u = fraction(k * 0.6180339887498949 + i * 0.5698402909980532);
                double length = o->radius * u * (0.1 + 0.9 * t * t);
                blocked += hidden_in_range(l, s, v3_add(s->position, v3_scale(w, length)), o->radius);
            }
            total += weight;
            open += weight * (1.0 - (double)blocked / distances);
        }
    }
    return open / total;
}

// ---- HBAO

// One direction: the attenuated rise of the horizon over its start, in sines of elevation.
static double horizon_rise(const layer *l, const surfel *s, vec3 to_eye, vec3 across, const reference_hbao_options *o)
{
    int steps = o->steps > 0 ? o->steps : 512;
    double x0, y0, x1, y1, h = 1e-4 * o->radius; // the projection's derivative, by a difference
    vec3 p = s->position;
    if (!layer_project(l, v3_sub(p, v3_scale(across, h)), &x0, &y0) ||
        !layer_project(l, v3_add(p, v3_scale(across, h)), &x1, &y1))
        return 0.0;
    double dx = (x1 - x0) * 0.5 * o->radius / h, dy = (y1 - y0) * 0.5 * o->radius / h, cx, cy;
    layer_project(l, p, &cx, &cy);
    // The tangent of the slice climbs where the normal leans back.
    double tangent = atan2(-v3_dot(s->normal, across), v3_dot(s->normal, to_eye)) + o->bias;
    double horizon = fmax(-0.5 * M_PI, fmin(tangent, 0.5 * M_PI)), sum = 0.0;
    for (int i = 0; i < steps; i++) {
        double u = (i + 0.5) / steps;
        vec3 at;
        if (!layer_sample(l, cx + u * dx, cy + u * dy, &at)) continue;
        vec3 w = v3_sub(at, p);
        double distance = v3_length(w);
        if (distance > o->radius || v3_dot(s->normal, w) <= 1e-6 * p.z) continue;
        double elevation = atan2(v3_dot(w, to_eye), v3_dot(w, across));
        if (elevation > 0.5 * M_PI) elevation = M_PI - elevation;
        if (elevation <= horizon) continue;
        double r = distance / o->radius;
        sum += (1.0 - r * r) * (sin(elevation) - sin(horizon));
        horizon = elevation;
    }
    return sum;
}

double reference_hbao(const layer *l, pixel p, const reference_hbao_options *o)
{
    const surfel *s = layer_at(l, p.x, p.y);
    int directions = o->directions > 0 ? o->directions : 128;
    vec3 to_eye = layer_to_eye(l, s->position), a, b;
    frame_about(to_eye, &a, &b);
    double sum = 0.0;
    for (int i = 0; i < directions; i++) {
        double phi = 2.0 * M_PI * (i + 0.5) / directions;
        sum += horizon_rise(l, s, to_eye, v3_add(v3_scale(a, cos(phi)), v3_scale(b, sin(phi))), o);
    }
    return 1.0 - sum / directions;
}
