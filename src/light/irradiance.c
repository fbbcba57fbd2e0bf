// The brute-force irradiance that everything faster is measured against.
#include <math.h>

#include "light/environment.h"

typedef struct cell {
    double theta0, theta1, phi0, phi1; // theta from the top, phi1 > phi0
} cell;

// Integral of w over the cell, dw = sin(theta) dtheta dphi.
static vec3 vector_area(cell c)
{
    double sine2 = 0.5 * (c.theta1 - c.theta0) - 0.25 * (sin(2 * c.theta1) - sin(2 * c.theta0)); // of sin^2 theta
    double sine_cosine = 0.25 * (cos(2 * c.theta0) - cos(2 * c.theta1));                         // of sin theta cos theta
    return v3(sine2 * (sin(c.phi1) - sin(c.phi0)), sine2 * (cos(c.phi0) - cos(c.phi1)), sine_cosine * (c.phi1 - c.phi0));
}

// Integral of max(0, n.w) over the cell: exact where the horizon does not cut it, else from four parts, down to 0.1 degrees.
static double clamped_cosine(vec3 n, cell c)
{
    double theta = 0.5 * (c.theta0 + c.theta1), phi = 0.5 * (c.phi0 + c.phi1);
    double reach = 0.5 * hypot(c.theta1 - c.theta0, c.phi1 - c.phi0); // no point of the cell is farther from its centre
    double cosine = v3_dot(n, v3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)));
    double elevation = asin(fmax(-1, fmin(1, cosine)));
    if (elevation <= -reach) return 0;
    if (elevation >= reach) return v3_dot(n, vector_area(c));
    if (reach < 0.1 * M_PI / 180) return fmax(0, v3_dot(n, vector_area(c)));
    return clamped_cosine(n, (cell){c.theta0, theta, c.phi0, phi}) + clamped_cosine(n, (cell){theta, c.theta1, c.phi0, phi}) +
           clamped_cosine(n, (cell){c.theta0, theta, phi, c.phi1}) + clamped_cosine(n, (cell){theta, c.theta1, phi, c.phi1});
}

vec3 environment_irradiance_over_pi(const environment *env, vec3 n)
{
    const env_level *map = &env->levels[0];
    const float *texel = map->rgba;
    vec3 sum = v3(0, 0, 0);
    for (int j = 0; j < map->height; j++)
        for (int i = 0; i < map->width; i++, texel += 4) {
            cell c = {M_PI * j / map->height, M_PI * (j + 1) / map->height, 2 * M_PI * (0.5 - (double)(i + 1) / map->width),
                      2 * M_PI * (0.5 - (double)i / map->width)};
            sum = v3_add(sum, v3_scale(v3((double)texel[0], (double)texel[1], (double)texel[2]), clamped_cosine(n, c)));
        }
    return v3_scale(sum, 1 / M_PI);
}
