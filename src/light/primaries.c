#include "light/primaries.h"

const double primaries_rec709[8] = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290};

bool primaries_equal(const double a[8], const double b[8])
{
    for (int i = 0; i < 8; i++)
        if (fabs(a[i] - b[i]) > 1e-4) return false;
    return true;
}

static bool inverse(mat3 a, mat3 *out)
{
    double det = m3_det(a);
    if (!isfinite(det) || fabs(det) < 1e-9) return false;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            int r1 = (c + 1) % 3, r2 = (c + 2) % 3, c1 = (r + 1) % 3, c2 = (r + 2) % 3;
            out->m[r][c] = (a.m[r1][c1] * a.m[r2][c2] - a.m[r1][c2] * a.m[r2][c1]) / det;
        }
    return true;
}

// X, Y and Z of a chromaticity with Y = 1.
static vec3 xyz(double x, double y) { return v3(x / y, 1.0, (1.0 - x - y) / y); }

// RGB to XYZ: the primaries' columns scaled so that (1, 1, 1) is the white.
static bool to_xyz(const double p[8], mat3 *m)
{
    mat3 columns, back;
    for (int c = 0; c < 3; c++) {
        columns.m[0][c] = p[2 * c], columns.m[1][c] = p[2 * c + 1], columns.m[2][c] = 1.0 - p[2 * c] - p[2 * c + 1];
    }
    if (!(fabs(p[7]) > 1e-6) || !inverse(columns, &back)) return false;
    vec3 scale = m3_apply(back, xyz(p[6], p[7]));
    const double s[3] = {scale.x, scale.y, scale.z};
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) m->m[r][c] = columns.m[r][c] * s[c];
    return true;
}

bool primaries_between(const double from[8], const double to[8], mat3 *m)
{
    static const mat3 bradford = {{{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
    mat3 a, b, b_back, bradford_back, adapt = {{{0}}};
    if (!to_xyz(from, &a) || !to_xyz(to, &b) || !inverse(b, &b_back) || !inverse(bradford, &bradford_back)) return false;
    vec3 w0 = m3_apply(bradford, xyz(from[6], from[7])), w1 = m3_apply(bradford, xyz(to[6], to[7]));
    if (!(w0.x > 0.0 && w0.y > 0.0 && w0.z > 0.0)) return false;
    adapt.m[0][0] = w1.x / w0.x, adapt.m[1][1] = w1.y / w0.y, adapt.m[2][2] = w1.z / w0.z;
    *m = m3_mul(b_back, m3_mul(bradford_back, m3_mul(adapt, m3_mul(bradford, a))));
    return true;
}
