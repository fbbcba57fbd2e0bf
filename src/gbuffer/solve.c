#include "gbuffer/solve.h"

#include <math.h>
#include <string.h>

static void rotate(int n, double *a, double *v, int p, int q)
{
    double apq = a[p * n + q];
    if (apq == 0.0) return;
    double theta = (a[q * n + q] - a[p * n + p]) / (2.0 * apq);
    double t = (theta >= 0.0 ? 1.0 : -1.0) / (fabs(theta) + sqrt(theta * theta + 1.0));
    double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
    for (int k = 0; k < n; k++) {
        double x = a[k * n + p], y = a[k * n + q];
        a[k * n + p] = c * x - s * y;
        a[k * n + q] = s * x + c * y;
    }
    for (int k = 0; k < n; k++) {
        double x = a[p * n + k], y = a[q * n + k];
        a[p * n + k] = c * x - s * y;
        a[q * n + k] = s * x + c * y;
        x = v[p * n + k], y = v[q * n + k];
        v[p * n + k] = c * x - s * y;
        v[q * n + k] = s * x + c * y;
    }
}

static void sort_rising(int n, double *values, double *vectors)
{
    for (int i = 0; i < n; i++) {
        int least = i;
        for (int j = i + 1; j < n; j++)
            if (values[j] < values[least]) least = j;
        if (least == i) continue;
        double row[SOLVE_MAX], value = values[i];
        values[i] = values[least], values[least] = value;
        memcpy(row, vectors + i * n, (size_t)n * sizeof *row);
        memcpy(vectors + i * n, vectors + least * n, (size_t)n * sizeof *row);
        memcpy(vectors + least * n, row, (size_t)n * sizeof *row);
    }
}

void solve_eigen(int n, double *a, double *values, double *vectors)
{
    for (int i = 0; i < n * n; i++) vectors[i] = i % (n + 1) == 0 ? 1.0 : 0.0;
    for (int sweep = 0; sweep < 40; sweep++) {
        double off = 0.0, all = 0.0;
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) {
                all += a[i * n + j] * a[i * n + j];
                if (i != j) off += a[i * n + j] * a[i * n + j];
            }
        if (!(off > 1e-34 * all)) break;
        for (int p = 0; p < n; p++)
            for (int q = p + 1; q < n; q++) rotate(n, a, vectors, p, q);
    }
    for (int i = 0; i < n; i++) values[i] = a[i * n + i];
    sort_rising(n, values, vectors);
}

// Cholesky's factor in the lower triangle; a pivot lost to rounding is raised to `least`.
static void factor(int n, double *a, double least)
{
    for (int j = 0; j < n; j++) {
        double d = a[j * n + j];
        for (int k = 0; k < j; k++) d -= a[j * n + k] * a[j * n + k];
        double root = sqrt(d > least ? d : least);
        a[j * n + j] = root;
        for (int i = j + 1; i < n; i++) {
            double v = a[i * n + j];
            for (int k = 0; k < j; k++) v -= a[i * n + k] * a[j * n + k];
            a[i * n + j] = v / root;
        }
    }
}

bool solve_smallest(int n, double *a, double *vector)
{
    double trace = 0.0;
    for (int i = 0; i < n; i++) trace += a[i * n + i];
    if (!(trace > 0.0) || !isfinite(trace)) return false;
    factor(n, a, 1e-16 * trace);
    uint64_t random = 1;
    for (int i = 0; i < n; i++) vector[i] = 0.5 + (double)(solve_random(&random) >> 11) * 0x1p-53;
    for (int iteration = 0; iteration < 8; iteration++) {
        double length = 0.0;
        for (int i = 0; i < n; i++) {
            for (int k = 0; k < i; k++) vector[i] -= a[i * n + k] * vector[k];
            vector[i] /= a[i * n + i];
        }
        for (int i = n - 1; i >= 0; i--) {
            for (int k = i + 1; k < n; k++) vector[i] -= a[k * n + i] * vector[k];
            vector[i] /= a[i * n + i];
            length += vector[i] * vector[i];
        }
        if (!(length > 0.0) || !isfinite(length)) return false;
        for (int i = 0; i < n; i++) vector[i] /= sqrt(length);
    }
    return true;
}

bool solve_linear(int n, double *a, double *b)
{
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(a[i * n + k]) > fabs(a[pivot * n + k])) pivot = i;
        if (!(fabs(a[pivot * n + k]) > 0.0) || !isfinite(a[pivot * n + k])) return false;
        for (int j = k; j < n && pivot != k; j++) {
            double swap = a[k * n + j];
            a[k * n + j] = a[pivot * n + j], a[pivot * n + j] = swap;
        }
        double swap = b[k];
        b[k] = b[pivot], b[pivot] = swap;
        for (int i = k + 1; i < n; i++) {
            double factor = a[i * n + k] / a[k * n + k];
            for (int j = k; j < n; j++) a[i * n + j] -= factor * a[k * n + j];
            b[i] -= factor * b[k];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++) b[i] -= a[i * n + j] * b[j];
        b[i] /= a[i * n + i];
        if (!isfinite(b[i])) return false;
    }
    return true;
}

double solve_select(double *values, size_t n, size_t k)
{
    size_t low = 0, high = n - 1;
    while (low < high) {
        double pivot = values[low + (high - low) / 2];
        size_t i = low, j = high;
        for (;;) {
            while (values[i] < pivot) i++;
            while (values[j] > pivot) j--;
            if (i >= j) break;
            double swap = values[i];
            values[i++] = values[j], values[j--] = swap;
        }
        // Now [low, j] <= pivot <= [j + 1, high] (i stops at most one beyond j).
        if (k <= j)
            high = j;
        else
            low = j + 1;
    }
    return values[k];
}

double solve_median(double *values, size_t n) { return n == 0 ? 0.0 : solve_select(values, n, n / 2); }

uint64_t solve_random(uint64_t *state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}
