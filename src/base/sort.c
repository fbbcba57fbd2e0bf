#include "base/sort.h"

#include <stdlib.h>

#define BY_VALUE(name, type)                                                                                                     \
    static int name(const void *a, const void *b)                                                                                \
    {                                                                                                                            \
        type x = *(const type *)a, y = *(const type *)b;                                                                         \
        return (x > y) - (x < y);                                                                                                \
    }

BY_VALUE(by_float, float)
BY_VALUE(by_double, double)
BY_VALUE(by_int, int)

void sort_floats(float *v, size_t count) { qsort(v, count, sizeof *v, by_float); }
void sort_doubles(double *v, size_t count) { qsort(v, count, sizeof *v, by_double); }
void sort_ints(int *v, size_t count) { qsort(v, count, sizeof *v, by_int); }
