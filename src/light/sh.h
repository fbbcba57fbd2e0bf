// Real spherical harmonics up to l = 3 and the irradiance formula of Ramamoorthi and Hanrahan (2001).
// Order: index l*l + l + m. Conventions of the paper: Y_00 = 0.282095, Y_1-1 = 0.488603 y, Y_10 = 0.488603 z, Y_11 = 0.488603 x,
// ...
#ifndef SSDO_LIGHT_SH_H
#define SSDO_LIGHT_SH_H

#include <stdbool.h>

#include "base/error.h"
#include "base/vec.h"

enum { SH_MAX = 16 };

// Coefficients L_lm = integral of L Y_lm over the sphere, l <= 3, of a lat-long map in map space (environment.h): 4 floats a
// texel, row-major, top row first. Exact for a map of constant texels: the basis itself is integrated over every texel, so maps
// of any size, 1x1 included, come out right.
bool sh_project(const float *rgba, int width, int height, int threads, double sh[SH_MAX][3], error *e);

// Y_lm(d) for l < bands (bands 1..4); d is a unit vector.
void sh_basis(vec3 d, int bands, double y[SH_MAX]);

// The coefficients (l < bands, at most 4) of the function d -> f(turn d), f given by its own: radiance coefficients brought into
// the axes that `turn` (a rotation, or one with a mirror) takes to those of `in`. Exact.
void sh_turn(const double in[][3], mat3 turn, int bands, double out[][3]);

// E(n) / pi, channel-wise, from radiance coefficients (l <= 2): the cosine-convolved sum A_l L_lm Y_lm(n) / pi with A = pi,
// 2pi/3, pi/4.
vec3 sh_irradiance_over_pi(const double sh[][3], vec3 n);

#endif
