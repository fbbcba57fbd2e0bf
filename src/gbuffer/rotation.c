#include "gbuffer/rotation.h"

#include "gbuffer/solve.h"

static mat3 outer_sum(vec3 u[3], vec3 v[3], double last)
{
    mat3 r = {{{0}}};
    for (int k = 0; k < 3; k++) {
        const double a[3] = {u[k].x, u[k].y, u[k].z}, b[3] = {v[k].x, v[k].y, v[k].z};
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) r.m[i][j] += (k == 2 ? last : 1.0) * a[i] * b[j];
    }
    return r;
}

bool rotation_between(mat3 m, double determinant, mat3 *rotation, double *second)
{
    // m = U S V^T; V and S^2 from m^T m, U's first two columns from m V, the third ones from the cross products.
    double a[9], values[3], rows[9];
    mat3 square = m3_mul(m3_transpose(m), m);
    for (int i = 0; i < 9; i++) a[i] = square.m[i / 3][i % 3];
    solve_eigen(3, a, values, rows);
    *second = 0.0;
    if (!(values[2] > 0.0)) return false;
    vec3 u[3], v[3];
    for (int k = 0; k < 2; k++) { // rising order: the largest is the last
        const double *row = rows + 3 * (2 - k);
        v[k] = v3(row[0], row[1], row[2]);
        u[k] = m3_apply(m, v[k]);
    }
    *second = sqrt(fmax(values[1], 0.0) / values[2]);
    u[0] = v3_normalize(u[0]);
    u[1] = v3_normalize(v3_sub(u[1], v3_scale(u[0], v3_dot(u[0], u[1]))));
    if (!(v3_dot(u[1], u[1]) > 0.5)) return false;
    u[2] = v3_cross(u[0], u[1]), v[2] = v3_cross(v[0], v[1]);
    *rotation = outer_sum(u, v, determinant < 0.0 ? -1.0 : 1.0);
    return true;
}

double rotation_angle(mat3 r)
{
    if (m3_det(r) < 0.0) return 180.0;
    double c = 0.5 * (r.m[0][0] + r.m[1][1] + r.m[2][2] - 1.0);
    return acos(fmax(-1.0, fmin(1.0, c))) * 57.29577951308232;
}

mat3 rotation_nearest_axes(mat3 r, double *degrees)
{
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    int best = 0;
    double most = -1.0;
    for (int o = 0; o < 6; o++) {
        double sum = 0.0;
        for (int i = 0; i < 3; i++) sum += fabs(r.m[i][orders[o][i]]);
        if (sum > most) most = sum, best = o;
    }
    mat3 axes = {{{0}}};
    for (int i = 0; i < 3; i++) axes.m[i][orders[best][i]] = r.m[i][orders[best][i]] < 0.0 ? -1.0 : 1.0;
    *degrees = rotation_angle(m3_mul(r, m3_transpose(axes)));
    return axes;
}
