#include "light/env_map.h"

#include <math.h>
#include <stdlib.h>

void environment_free(environment *env)
{
    if (!env) return;
    for (int i = 0; i < env->level_count; i++) free(env->levels[i].rgba);
    *env = (environment){0};
}

double env_texel_solid_angle(int width, int height, int j)
{
    // cos a - cos b as a product, which loses nothing at the poles.
    return 2 * M_PI / width * 2 * sin(M_PI * (j + 0.5) / height) * sin(0.5 * M_PI / height);
}

static vec3 texel(const env_level *l, int x, int y)
{
    const float *p = l->rgba + 4 * ((size_t)y * (size_t)l->width + (size_t)x);
    return v3((double)p[0], (double)p[1], (double)p[2]);
}

static vec3 mix(vec3 a, vec3 b, double t) { return v3_add(v3_scale(a, 1 - t), v3_scale(b, t)); }

static int wrap(int x, int width) { return ((x % width) + width) % width; }
static int clamp(int y, int height) { return y < 0 ? 0 : y >= height ? height - 1 : y; }

static vec3 bilinear(const env_level *l, double u, double v)
{
    double x = u * l->width - 0.5, y = v * l->height - 0.5;
    int x0 = (int)floor(x), y0 = (int)floor(y);
    int xa = wrap(x0, l->width), xb = wrap(x0 + 1, l->width), ya = clamp(y0, l->height), yb = clamp(y0 + 1, l->height);
    vec3 above = mix(texel(l, xa, ya), texel(l, xb, ya), x - x0), below = mix(texel(l, xa, yb), texel(l, xb, yb), x - x0);
    return mix(above, below, y - y0);
}

vec3 environment_lookup(const environment *env, vec3 d, double level)
{
    double u = 0.5 - atan2(d.y, d.x) / (2 * M_PI), v = acos(fmax(-1, fmin(1, d.z))) / M_PI;
    double top = fmin(fmax(level, 0), env->level_count - 1);
    int sharp = (int)floor(top), soft = sharp + 1 < env->level_count ? sharp + 1 : sharp;
    return mix(bilinear(&env->levels[sharp], u, v), bilinear(&env->levels[soft], u, v), top - sharp);
}
