// Small double-precision vector and matrix maths for the CPU side. Column vectors: p' = M p; m[row][column].
#ifndef SSDO_BASE_VEC_H
#define SSDO_BASE_VEC_H

#include <math.h>
#include <stdbool.h>

typedef struct vec3 {
    double x, y, z;
} vec3;
typedef struct mat3 {
    double m[3][3];
} mat3;

static inline vec3 v3(double x, double y, double z) { return (vec3){x, y, z}; }
static inline vec3 v3_add(vec3 a, vec3 b) { return v3(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline vec3 v3_sub(vec3 a, vec3 b) { return v3(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline vec3 v3_scale(vec3 a, double s) { return v3(a.x * s, a.y * s, a.z * s); }
static inline double v3_dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vec3 v3_cross(vec3 a, vec3 b) { return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x); }
// Of linear Rec. 709.
static inline double luminance(double r, double g, double b) { return 0.2126 * r + 0.7152 * g + 0.0722 * b; }
static inline double v3_length(vec3 a) { return sqrt(v3_dot(a, a)); }
static inline bool v3_finite(vec3 a) { return isfinite(a.x) && isfinite(a.y) && isfinite(a.z); }
// The zero vector (or one that is not finite) gives zero, never NaN.
static inline vec3 v3_normalize(vec3 a)
{
    double l = v3_length(a);
    return l > 0.0 && isfinite(l) ? v3_scale(a, 1.0 / l) : v3(0, 0, 0);
}
static inline mat3 m3_identity(void) { return (mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; }
static inline vec3 m3_apply(mat3 a, vec3 v)
{
    return v3(a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z, a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
              a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z);
}
static inline mat3 m3_transpose(mat3 a)
{
    mat3 t;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) t.m[r][c] = a.m[c][r];
    return t;
}
static inline mat3 m3_mul(mat3 a, mat3 b)
{
    mat3 p;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) p.m[r][c] = a.m[r][0] * b.m[0][c] + a.m[r][1] * b.m[1][c] + a.m[r][2] * b.m[2][c];
    return p;
}
static inline double m3_det(mat3 a)
{
    return a.m[0][0] * (a.m[1][1] * a.m[2][2] - a.m[1][2] * a.m[2][1]) -
           a.m[0][1] * (a.m[1][0] * a.m[2][2] - a.m[1][2] * a.m[2][0]) +
           a.m[0][2] * (a.m[1][0] * a.m[2][1] - a.m[1][1] * a.m[2][0]);
}

#endif
