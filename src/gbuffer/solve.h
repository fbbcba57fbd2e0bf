// Small dense linear algebra in double for the camera solvers. Matrices are row-major, n <= SOLVE_MAX.
#ifndef SSDO_GBUFFER_SOLVE_H
#define SSDO_GBUFFER_SOLVE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SOLVE_MAX = 12 };

// Eigenvalues (rising) and unit eigenvectors (row i of `vectors` belongs to values[i]) of a symmetric matrix, by cyclic Jacobi
// rotations. `a` is destroyed.
void solve_eigen(int n, double *a, double *values, double *vectors);

// The unit eigenvector of the smallest eigenvalue of a symmetric matrix without negative ones, by inverse iteration: some fifty
// times faster than solve_eigen. Where several eigenvalues are about 0 it is some vector of their space. `a` is destroyed.
bool solve_smallest(int n, double *a, double *vector);

// Solves a x = b in place (x replaces b) by Gaussian elimination with row pivoting; false when a is singular. `a` is destroyed.
bool solve_linear(int n, double *a, double *b);

// The k-th smallest (0-based) of n values, which are reordered. n > 0.
double solve_select(double *values, size_t n, size_t k);
// The median of n values, which are reordered; 0 for n = 0.
double solve_median(double *values, size_t n);

// A deterministic random sequence (splitmix64): the next 64 bits.
uint64_t solve_random(uint64_t *state);

#endif
