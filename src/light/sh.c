#include "light/sh.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/threads.h"

void sh_basis(vec3 d, int bands, double y[SH_MAX])
{
    double xx = d.x * d.x, yy = d.y * d.y, zz = d.z * d.z;
    y[0] = sqrt(1 / (4 * M_PI));
    if (bands > 1) {
        double k = sqrt(3 / (4 * M_PI));
        y[1] = k * d.y;
        y[2] = k * d.z;
        y[3] = k * d.x;
    }
    if (bands > 2) {
        double k = sqrt(15 / (4 * M_PI));
        y[4] = k * d.x * d.y;
        y[5] = k * d.y * d.z;
        y[6] = sqrt(5 / (16 * M_PI)) * (3 * zz - 1);
        y[7] = k * d.x * d.z;
        y[8] = 0.5 * k * (xx - yy);
    }
    if (bands > 3) {
        double k1 = sqrt(21 / (32 * M_PI)), k2 = sqrt(105 / (4 * M_PI)), k3 = sqrt(35 / (32 * M_PI));
        y[9] = k3 * d.y * (3 * xx - yy);
        y[10] = k2 * d.x * d.y * d.z;
        y[11] = k1 * d.y * (5 * zz - 1);
        y[12] = sqrt(7 / (16 * M_PI)) * d.z * (5 * zz - 3);
        y[13] = k1 * d.x * (5 * zz - 1);
        y[14] = 0.5 * k2 * d.z * (xx - yy);
        y[15] = k3 * d.x * (xx - 3 * yy);
    }
}

// Bands up to l = 3 are polynomials of degree 3, their products of degree 6: five nodes in z and eight longitudes integrate them
// exactly.
void sh_turn(const double in[][3], mat3 turn, int bands, double out[][3])
{
    static const double node[5] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831, 0.9061798459386640};
    static const double weight[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                     0.2369268850561891};
    enum { LONGITUDES = 8 };
    const int n = bands * bands;
    memset(out, 0, (size_t)n * sizeof *out);
    for (int k = 0; k < 5 * LONGITUDES; k++) {
        double z = node[k / LONGITUDES], r = sqrt(1 - z * z), phi = 2 * M_PI * (k % LONGITUDES) / LONGITUDES;
        double from[SH_MAX], to[SH_MAX], solid_angle = weight[k / LONGITUDES] * 2 * M_PI / LONGITUDES;
        vec3 d = v3(r * cos(phi), r * sin(phi), z);
        sh_basis(d, bands, to);
        sh_basis(m3_apply(turn, d), bands, from);
        for (int c = 0; c < 3; c++) {
            double value = 0;
            for (int i = 0; i < n; i++) value += in[i][c] * from[i];
            for (int i = 0; i < n; i++) out[i][c] += solid_angle * value * to[i];
        }
    }
}

vec3 sh_irradiance_over_pi(const double sh[][3], vec3 n)
{
    static const double a[3] = {1.0, 2.0 / 3.0, 0.25}; // A_l / pi
    double y[SH_MAX], sum[3] = {0, 0, 0};
    sh_basis(n, 3, y);
    for (int l = 0; l < 3; l++)
        for (int i = l * l; i < (l + 1) * (l + 1); i++)
            for (int c = 0; c < 3; c++) sum[c] += a[l] * sh[i][c] * y[i];
    return v3(sum[0], sum[1], sum[2]);
}

// The projection separates. Y_lm = q_lm(theta) t_m(phi), with t_m = cos m phi for m >= 0 and sin |m| phi for m < 0, so a texel's
// integral of Y_lm is (integral of q sin theta over its row) * (integral of t over its column).

enum { ORDERS = 7, MAX_M = 3 }; // m = -3 .. 3

typedef struct projection {
    const float *rgba;
    int width, height;
    const double (*columns)[ORDERS]; // [i][m + 3]: integral of t_m over column i
    double (*rows)[SH_MAX][3];       // what each row adds
} projection;

// phi = 2 pi (1/2 - u) falls with u; column i spans u in [i, i + 1] / width.
static void integrate_column(int i, int width, double out[ORDERS])
{
    double high = 2 * M_PI * (0.5 - (double)i / width), low = 2 * M_PI * (0.5 - (double)(i + 1) / width);
    out[MAX_M] = 2 * M_PI / width;
    for (int m = 1; m <= MAX_M; m++) {
        out[MAX_M + m] = (sin(m * high) - sin(m * low)) / m;
        out[MAX_M - m] = (cos(m * low) - cos(m * high)) / m;
    }
}

// q_lm(theta) is Y_lm at the longitude where t_m = 1; where[m + 3] holds its cosine and sine.
static void polar_part(double theta, const double where[ORDERS][2], double q[SH_MAX])
{
    double sine = sin(theta), cosine = cos(theta), y[SH_MAX];
    for (int m = -MAX_M; m <= MAX_M; m++) {
        sh_basis(v3(sine * where[MAX_M + m][0], sine * where[MAX_M + m][1], cosine), 4, y);
        for (int l = abs(m); l <= MAX_M; l++) q[l * l + l + m] = y[l * l + l + m];
    }
}

// Integral of q_lm sin theta over row j: five-point Gauss-Legendre on panels of at most pi / 32, exact to rounding.
static void integrate_row(int j, int height, double out[SH_MAX])
{
    static const double node[5] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831, 0.9061798459386640};
    static const double weight[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                     0.2369268850561891};
    double where[ORDERS][2], q[SH_MAX];
    int panels = (32 + height - 1) / height;
    double size = M_PI / height / panels;
    for (int m = -MAX_M; m <= MAX_M; m++) {
        double phi = m < 0 ? M_PI / (2 * -m) : 0;
        where[MAX_M + m][0] = cos(phi);
        where[MAX_M + m][1] = sin(phi);
    }
    memset(out, 0, SH_MAX * sizeof *out);
    for (int p = 0; p < panels; p++)
        for (int g = 0; g < 5; g++) {
            double theta = M_PI * j / height + size * (p + 0.5 + 0.5 * node[g]);
            polar_part(theta, (const double(*)[2])where, q);
            for (int k = 0; k < SH_MAX; k++) out[k] += 0.5 * size * weight[g] * sin(theta) * q[k];
        }
}

// r, g, b and an idle fourth: the compiler makes SIMD of it.
typedef double rgba_sum __attribute__((vector_size(4 * sizeof(double))));

static bool project_row(void *context, size_t item, int worker)
{
    (void)worker;
    const projection *p = context;
    rgba_sum sums[ORDERS] = {{0}};
    double q[SH_MAX];
    const float *texel = p->rgba + 4 * item * (size_t)p->width;
    for (int i = 0; i < p->width; i++, texel += 4) {
        rgba_sum radiance = {(double)texel[0], (double)texel[1], (double)texel[2], 0};
        for (int m = 0; m < ORDERS; m++) sums[m] += p->columns[i][m] * radiance;
    }
    integrate_row((int)item, p->height, q);
    for (int l = 0; l <= MAX_M; l++)
        for (int m = -l; m <= l; m++)
            for (int c = 0; c < 3; c++) p->rows[item][l * l + l + m][c] = q[l * l + l + m] * sums[MAX_M + m][c];
    return true;
}

bool sh_project(const float *rgba, int width, int height, int threads, double sh[SH_MAX][3], error *e)
{
    bool ok = false;
    double(*columns)[ORDERS] = mem_zero((size_t)width, sizeof *columns, e);
    double(*rows)[SH_MAX][3] = mem_zero((size_t)height, sizeof *rows, e);
    if (!columns || !rows) goto out;
    for (int i = 0; i < width; i++) integrate_column(i, width, columns[i]);
    projection p = {.rgba = rgba, .width = width, .height = height, .rows = rows};
    p.columns = (const double(*)[ORDERS])columns;
    threads_for(threads, (size_t)height, project_row, &p);
    // In the order of rows, whatever the threads did.
    memset(sh, 0, SH_MAX * sizeof *sh);
    for (int j = 0; j < height; j++)
        for (int k = 0; k < SH_MAX; k++)
            for (int c = 0; c < 3; c++) sh[k][c] += rows[j][k][c];
    ok = true;
out:
    free(columns);
    free(rows);
    return ok;
}
